// SPDX-License-Identifier: BSD-3-Clause
#include "MortonOrder.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;

struct Item
{
  std::uint64_t Key;
  std::int64_t Place;
};

/// Random keys of so many bits, many of them equal where the bits are few.
BulkVector<Item> randomItems(std::int64_t n, int bits)
{
  std::mt19937_64 engine(static_cast<std::uint64_t>(n + bits));
  BulkVector<Item> items;
  for (std::int64_t k = 0; k < n; ++k)
  {
    items.push_back({ bits == 0 ? 0 : engine() >> (64 - bits), k });
  }
  return items;
}

TEST(MortonOrder, SortsStablyOnAnyNumberOfThreads)
{
  for (const std::int64_t n : { 0, 1, 2, 1000, 65536, 200001 })
  {
    for (const int bits : { 0, 1, 11, 12, 33, 64 })
    {
      BulkVector<Item> expected = randomItems(n, bits);
      std::stable_sort(expected.begin(), expected.end(),
        [](const Item& a, const Item& b) { return a.Key < b.Key; });
      for (const int threads : { 1, 2, 3 })
      {
        BulkVector<Item> items = randomItems(n, bits);
        sortByKey(
          items, [](const Item& item) { return item.Key; }, threads);
        ASSERT_EQ(items.size(), expected.size());
        for (std::size_t k = 0; k < items.size(); ++k)
        {
          ASSERT_EQ(items[k].Key, expected[k].Key)
            << n << " items, " << bits << " bits, item " << k;
          ASSERT_EQ(items[k].Place, expected[k].Place)
            << n << " items, " << bits << " bits, item " << k;
        }
      }
    }
  }
}

TEST(MortonOrder, InterleavesBits)
{
  EXPECT_EQ(mortonKey<2>({ 1, 0 }), 1u);
  EXPECT_EQ(mortonKey<2>({ 0, 1 }), 2u);
  EXPECT_EQ(mortonKey<2>({ 5, 3 }), 0b011011u);
  EXPECT_EQ(mortonKey<3>({ 1, 0, 0 }), 1u);
  EXPECT_EQ(mortonKey<3>({ 0, 1, 0 }), 2u);
  EXPECT_EQ(mortonKey<3>({ 0, 0, 1 }), 4u);
  EXPECT_EQ(mortonKey<3>({ 5, 3, 6 }), 0b101110011u);
  const std::int64_t most = (1 << 21) - 1;
  EXPECT_EQ(mortonKey<3>({ most, most, most }), (std::uint64_t{ 1 } << 63) - 1);
}

template <typename T>
class MortonOrderIn : public ::testing::Test
{
};
TYPED_TEST_SUITE(MortonOrderIn, ipia::test::Dimensions);

TYPED_TEST(MortonOrderIn, NestsCubesOfTwiceTheSide)
{
  constexpr int Dim = TypeParam::value;
  std::mt19937_64 engine(3);
  for (int k = 0; k < 1000; ++k)
  {
    Index<Dim> i, half;
    for (std::size_t a = 0; a < Dim; ++a)
    {
      i[a] = static_cast<std::int64_t>(engine() >> (64 - 20));
      half[a] = i[a] / 2;
    }
    EXPECT_EQ(mortonKey<Dim>(i) >> Dim, mortonKey<Dim>(half));
  }
}
}
