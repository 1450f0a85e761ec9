// SPDX-License-Identifier: BSD-3-Clause
#include "BulkVector.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <numeric>

namespace
{
using ipia::BulkAllocator;
using ipia::BulkVector;

TEST(BulkVector, IsAVector)
{
  for (const std::size_t n : { 1, 1000, 1000000 })
  {
    BulkVector<double> values(n);
    std::iota(values.begin(), values.end(), 0.0);
    BulkVector<double> copy = values;
    values.resize(2 * n);
    for (std::size_t k = 0; k < n; ++k)
    {
      ASSERT_EQ(values[k], static_cast<double>(k));
    }
    EXPECT_EQ(copy.size(), n);
    EXPECT_EQ(copy.back(), static_cast<double>(n - 1));
    copy.swap(values);
    EXPECT_EQ(copy.size(), 2 * n);
    copy.assign(n, 3.0);
    EXPECT_EQ(std::accumulate(copy.begin(), copy.end(), 0.0), 3.0 * static_cast<double>(n));
  }
}

TEST(BulkVector, LeavesNumbersAsTheyAre)
{
  alignas(double) unsigned char memory[sizeof(double)];
  const double before = 42;
  std::memcpy(memory, &before, sizeof(before));
  BulkAllocator<double> allocator;
  auto* const number = reinterpret_cast<double*>(memory);
  std::allocator_traits<BulkAllocator<double>>::construct(allocator, number);
  double after = 0;
  std::memcpy(&after, memory, sizeof(after));
  EXPECT_EQ(after, before);
  std::allocator_traits<BulkAllocator<double>>::construct(allocator, number, 7.0);
  EXPECT_EQ(*number, 7);
}

TEST(BulkVector, ConstructsWhatHasAConstructor)
{
  struct Seven
  {
    int Value = 7;
  };
  BulkVector<Seven> values(3);
  values.resize(5);
  for (const Seven& value : values)
  {
    EXPECT_EQ(value.Value, 7);
  }
  values.push_back({ 8 });
  EXPECT_EQ(values.back().Value, 8);
}
}
