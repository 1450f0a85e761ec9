// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The order of a space-filling curve: nested cubes are runs of equal leading bits.
 */
#ifndef ipia_MortonOrder_h
#define ipia_MortonOrder_h

#include "BulkVector.h"
#include "Types.h"

#include <algorithm>
#include <utility>

namespace ipia
{
/// Interleaves the bits of the indices, x lowest: 21 of each in space, 32 in the plane.
template <int Dim>
std::uint64_t mortonKey(const Index<Dim>& i)
{
  std::uint64_t key = 0;
  for (int a = 0; a < Dim; ++a)
  {
    // Spreads the bits of one coordinate with gaps for the others.
    auto v = static_cast<std::uint64_t>(i[a]);
    if (Dim == 3)
    {
      v &= 0x1fffff;
      v = (v | v << 32) & 0x1f00000000ffff;
      v = (v | v << 16) & 0x1f0000ff0000ff;
      v = (v | v << 8) & 0x100f00f00f00f00f;
      v = (v | v << 4) & 0x10c30c30c30c30c3;
      v = (v | v << 2) & 0x1249249249249249;
    }
    else
    {
      v &= 0xffffffff;
      v = (v | v << 16) & 0x0000ffff0000ffff;
      v = (v | v << 8) & 0x00ff00ff00ff00ff;
      v = (v | v << 4) & 0x0f0f0f0f0f0f0f0f;
      v = (v | v << 2) & 0x3333333333333333;
      v = (v | v << 1) & 0x5555555555555555;
    }
    key |= v << a;
  }
  return key;
}

/**
 * Sorts by keyOf(item), an unsigned number of 64 bits; items of equal keys keep their order.
 *
 * Digit by digit, from the lowest. Each task moves a run of the items to where the counts of all
 * runs say that its items of a digit begin, so that any number of threads gives the same order.
 */
template <typename Item, typename KeyOf>
void sortByKey(BulkVector<Item>& items, const KeyOf& keyOf, int threads)
{
  constexpr int digitBits = 11; // counts and the ends of what is written stay in the cache
  constexpr std::size_t digits = std::size_t{ 1 } << digitBits;
  constexpr std::int64_t runLength = 1 << 16;
  const auto n = static_cast<std::int64_t>(items.size());
  const std::int64_t runs = (n + runLength - 1) / runLength;
  const auto forRuns = [&](const auto& body)
  {
#pragma omp parallel for schedule(static) num_threads(runs > 1 ? threads : 1)
    for (std::int64_t r = 0; r < runs; ++r)
    {
      body(static_cast<std::size_t>(r), items.data() + r * runLength,
        items.data() + std::min(n, (r + 1) * runLength));
    }
  };

  std::vector<std::uint64_t> present(static_cast<std::size_t>(runs), 0);
  forRuns(
    [&](std::size_t run, const Item* begin, const Item* end)
    {
      for (const Item* item = begin; item != end; ++item)
      {
        present[run] |= keyOf(*item);
      }
    });
  std::uint64_t bits = 0;
  for (const std::uint64_t p : present)
  {
    bits |= p;
  }

  BulkVector<Item> sorted(items.size());
  std::vector<std::array<std::int64_t, digits>> next(static_cast<std::size_t>(runs));
  for (int shift = 0; shift < 64 && bits >> shift != 0; shift += digitBits)
  {
    const auto digitOf = [&](const Item& item)
    { return static_cast<std::size_t>(keyOf(item) >> shift & (digits - 1)); };
    forRuns(
      [&](std::size_t run, const Item* begin, const Item* end)
      {
        next[run].fill(0);
        for (const Item* item = begin; item != end; ++item)
        {
          ++next[run][digitOf(*item)];
        }
      });
    std::int64_t total = 0;
    for (std::size_t d = 0; d < digits; ++d)
    {
      for (auto& ofRun : next)
      {
        total += std::exchange(ofRun[d], total);
      }
    }
    forRuns(
      [&](std::size_t run, const Item* begin, const Item* end)
      {
        for (const Item* item = begin; item != end; ++item)
        {
          sorted[static_cast<std::size_t>(next[run][digitOf(*item)]++)] = *item;
        }
      });
    items.swap(sorted);
  }
}
}

#endif
