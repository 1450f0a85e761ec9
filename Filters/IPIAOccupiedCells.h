// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The cells of a domain that have data in or beside them, and how far those without hang together.
 */
#ifndef IPIAOccupiedCells_h
#define IPIAOccupiedCells_h

#include "IPIAPointCloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace ipia
{
/// Which cells have data in them or in a cell beside them: knot cells, or more of them together
/// where data are sparse.
class OccupiedCells
{
public:
  using Position = std::array<double, 3>;

  /// @param knotCells  per axis, 0 across the plane in 2-D
  OccupiedCells(const std::array<double, 6>& domain, const std::array<int, 3>& knotCells,
    const SpacePoints& data);

  /// The flat index of the cell of a position.
  std::size_t indexOf(const Position& x) const
  {
    const Cell cell = this->cellOf(x);
    return this->flat(cell[0], cell[1], cell[2]);
  }

  bool isNear(std::size_t index) const { return this->Near[index]; }

  /// How many of the given cells, which may be repeated, touch each other at most.
  double largestCluster(std::vector<std::size_t> cells) const;

private:
  using Cell = std::array<std::int64_t, 3>;

  /// Sets cells of so many knot cells per axis. Returns their number.
  std::int64_t choose(const std::array<double, 6>& domain, const std::array<int, 3>& knotCells,
    std::int64_t together);

  /// Those that hold data, each once.
  std::vector<Cell> cellsOf(const SpacePoints& data, std::int64_t total) const;

  Cell cellOf(const Position& x) const
  {
    Cell cell;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double at = std::floor((x[a] - this->Lower[a]) * this->PerLength[a]);
      cell[a] = static_cast<std::int64_t>(
        std::min(std::max(at, 0.0), static_cast<double>(this->Count[a] - 1)));
    }
    return cell;
  }

  std::size_t flat(std::int64_t i, std::int64_t j, std::int64_t k) const
  {
    return static_cast<std::size_t>((k * this->Count[1] + j) * this->Count[0] + i);
  }

  Cell Count{};
  Position Lower{}, PerLength{};
  std::vector<bool> Near;
};
}

#endif
