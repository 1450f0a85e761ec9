// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAPointTree.h"

#include "Core/Parallel.h"

#include <algorithm>

namespace ipia
{
namespace
{
/// Points of a leaf at most.
constexpr std::size_t LeafSize = 12;
}

struct PointTree::Search
{
  const Position& X;
  std::size_t Count;
  std::vector<Neighbour>& Found; ///< sorted
  double Reach2;

  bool wants(double distance2) const
  {
    return distance2 <=
      (this->Found.size() < this->Count ? this->Reach2 : this->Found.back().Distance2);
  }

  void offer(const Neighbour& next)
  {
    if (!this->wants(next.Distance2))
    {
      return;
    }
    if (this->Found.size() == this->Count)
    {
      if (!(next < this->Found.back()))
      {
        return;
      }
      this->Found.pop_back();
    }
    this->Found.insert(std::upper_bound(this->Found.begin(), this->Found.end(), next), next);
  }
};

PointTree::PointTree(const SpacePoints& points)
{
  this->Entries.reserve(points.size());
  for (const Position& x : points)
  {
    this->Entries.push_back({ x, static_cast<vtkIdType>(this->Entries.size()) });
  }
  int levels = 0;
  while (points.size() >> levels > LeafSize)
  {
    ++levels;
  }
  this->Nodes.resize((std::size_t{ 1 } << levels) - 1);
  const int threads = resolveThreads(0);
  for (int level = 0; level < levels; ++level)
  {
    const std::int64_t count = std::int64_t{ 1 } << level;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (std::int64_t k = 0; k < count; ++k)
    {
      // The way from the root to the k-th node of the level.
      std::size_t begin = 0, end = this->Entries.size();
      for (int bit = level - 1; bit >= 0; --bit)
      {
        const std::size_t middle = (begin + end) / 2;
        (k >> bit & 1 ? begin : end) = middle;
      }
      this->part(static_cast<std::size_t>(count - 1 + k), begin, end);
    }
  }
}

void PointTree::part(std::size_t node, std::size_t begin, std::size_t end)
{
  const auto first = this->Entries.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = this->Entries.begin() + static_cast<std::ptrdiff_t>(end);
  Position lower = first->X, upper = lower;
  for (auto entry = first; entry != last; ++entry)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      lower[a] = std::min(lower[a], entry->X[a]);
      upper[a] = std::max(upper[a], entry->X[a]);
    }
  }
  std::size_t axis = 0;
  for (std::size_t a = 1; a < 3; ++a)
  {
    axis = upper[a] - lower[a] > upper[axis] - lower[axis] ? a : axis;
  }
  const auto middle = this->Entries.begin() + static_cast<std::ptrdiff_t>((begin + end) / 2);
  std::nth_element(
    first, middle, last, [axis](const Entry& a, const Entry& b) { return a.X[axis] < b.X[axis]; });
  this->Nodes[node] = { static_cast<int>(axis), middle->X[axis] };
}

void PointTree::descend(Search& search, std::size_t node, std::size_t begin, std::size_t end,
  Position offset, double distance2) const
{
  if (node >= this->Nodes.size())
  {
    for (std::size_t k = begin; k < end; ++k)
    {
      const Entry& entry = this->Entries[k];
      double sum = 0;
      for (std::size_t a = 0; a < 3; ++a)
      {
        const double difference = entry.X[a] - search.X[a];
        sum += difference * difference;
      }
      search.offer({ sum, entry.Id });
    }
    return;
  }
  const auto axis = static_cast<std::size_t>(this->Nodes[node].Axis);
  const double beyond = search.X[axis] - this->Nodes[node].Split;
  const std::size_t middle = (begin + end) / 2;
  const auto visit = [&](bool upper, const Position& from, double least)
  {
    this->descend(search, 2 * node + (upper ? 2 : 1), upper ? middle : begin, upper ? end : middle,
      from, least);
  };
  const bool nearUpper = beyond >= 0;
  visit(nearUpper, offset, distance2);
  // The other side begins at the split: its squared distance gains that along this axis.
  const double least = distance2 - offset[axis] * offset[axis] + beyond * beyond;
  offset[axis] = beyond;
  // A little less for rounding; what ties with the last one found may come before it.
  if (search.wants(least * (1 - 1e-12)))
  {
    visit(!nearUpper, offset, least);
  }
}

void PointTree::nearest(
  const Position& x, std::size_t count, std::vector<Neighbour>& found, double reach) const
{
  found.clear();
  Search search{ x, std::min(count, this->Entries.size()), found, reach * reach };
  if (search.Count > 0)
  {
    this->descend(search, 0, 0, this->Entries.size(), { 0, 0, 0 }, 0);
  }
}
}
