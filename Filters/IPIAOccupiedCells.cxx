// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAOccupiedCells.h"

#include "IPIAComponents.h"

namespace ipia
{
namespace
{
/// Occupied cells hold at least this many points on average, so that few cells among them are
/// empty.
constexpr double PointsPerCell = 1.5;
/// Knot cells are taken together until there are no more than this: a bound on memory.
constexpr std::int64_t MostCells = std::int64_t{ 1 } << 27;
}

OccupiedCells::OccupiedCells(
  const std::array<double, 6>& domain, const std::array<int, 3>& knotCells, const SpacePoints& data)
{
  const auto enough = static_cast<double>(data.size()) / PointsPerCell;
  std::int64_t together = 1, total = this->choose(domain, knotCells, together);
  std::vector<Cell> occupied;
  for (;; total = this->choose(domain, knotCells, together *= 2))
  {
    if (total <= MostCells)
    {
      occupied = this->cellsOf(data, total);
      if (static_cast<double>(occupied.size()) <= enough || total == 1)
      {
        break;
      }
    }
  }
  this->Near.assign(static_cast<std::size_t>(total), false);
  for (const Cell& cell : occupied)
  {
    const auto first = [&](std::size_t a) { return std::max<std::int64_t>(cell[a] - 1, 0); };
    const auto last = [&](std::size_t a) { return std::min(cell[a] + 1, this->Count[a] - 1); };
    for (std::int64_t k = first(2); k <= last(2); ++k)
    {
      for (std::int64_t j = first(1); j <= last(1); ++j)
      {
        for (std::int64_t i = first(0); i <= last(0); ++i)
        {
          this->Near[this->flat(i, j, k)] = true;
        }
      }
    }
  }
}

double OccupiedCells::largestCluster(std::vector<std::size_t> cells) const
{
  std::sort(cells.begin(), cells.end());
  std::vector<std::size_t> distinct;
  std::vector<double> times;
  for (const std::size_t cell : cells)
  {
    if (distinct.empty() || distinct.back() != cell)
    {
      distinct.push_back(cell);
      times.push_back(0);
    }
    ++times.back();
  }
  // Rows of cells, and what is beside them; a cell at the end of a row may be joined with one at
  // the beginning of the next, which makes clusters no smaller than they are.
  DisjointSets sets(static_cast<vtkIdType>(distinct.size()));
  const auto row = static_cast<std::size_t>(this->Count[0]);
  const std::size_t slice = row * static_cast<std::size_t>(this->Count[1]);
  for (const std::size_t step : { std::size_t{ 0 }, row, slice - row, slice, slice + row })
  {
    // Both move upwards together.
    std::size_t other = 0;
    for (std::size_t k = 0; k < distinct.size(); ++k)
    {
      const std::size_t middle = distinct[k] + step;
      while (other < distinct.size() && distinct[other] + 1 < middle)
      {
        ++other;
      }
      for (std::size_t i = other; i < distinct.size() && distinct[i] <= middle + 1; ++i)
      {
        sets.unite(static_cast<vtkIdType>(k), static_cast<vtkIdType>(i));
      }
    }
  }
  const std::vector<vtkIdType> label = sets.labels();
  std::vector<double> size(distinct.size(), 0);
  for (std::size_t k = 0; k < label.size(); ++k)
  {
    size[static_cast<std::size_t>(label[k])] += times[k];
  }
  return size.empty() ? 0 : *std::max_element(size.begin(), size.end());
}

std::int64_t OccupiedCells::choose(
  const std::array<double, 6>& domain, const std::array<int, 3>& knotCells, std::int64_t together)
{
  std::int64_t total = 1;
  for (std::size_t a = 0; a < 3; ++a)
  {
    const std::int64_t cells = knotCells[a];
    this->Count[a] = std::max<std::int64_t>(1, (cells + together - 1) / together);
    this->Lower[a] = domain[2 * a];
    this->PerLength[a] = cells > 0 ? static_cast<double>(cells) /
        (domain[2 * a + 1] - domain[2 * a]) / static_cast<double>(together)
                                   : 0;
    total *= this->Count[a];
  }
  return total;
}

std::vector<OccupiedCells::Cell> OccupiedCells::cellsOf(
  const SpacePoints& data, std::int64_t total) const
{
  std::vector<bool> seen(static_cast<std::size_t>(total));
  std::vector<Cell> cells;
  for (const Position& x : data)
  {
    const Cell cell = this->cellOf(x);
    const std::size_t index = this->flat(cell[0], cell[1], cell[2]);
    if (!seen[index])
    {
      seen[index] = true;
      cells.push_back(cell);
    }
  }
  return cells;
}
}
