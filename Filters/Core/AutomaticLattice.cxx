// SPDX-License-Identifier: BSD-3-Clause
#include "AutomaticLattice.h"

#include <limits>
#include <vector>

namespace ipia
{
namespace
{
/// Bits per axis of the finest cubes that points are told apart by.
constexpr int SpacingBits = 20;

/// Points that an occupied cube must hold on average for their count to measure area (length).
constexpr double PointsPerCube = 4;

/// Interleaves the bits of one axis with gaps for the others.
std::uint64_t spreadBits(std::uint64_t v, int dimension)
{
  std::uint64_t spread = 0;
  for (int bit = 0; bit < SpacingBits; ++bit)
  {
    spread |= ((v >> bit) & 1u) << (bit * dimension);
  }
  return spread;
}
}

template <int Dim>
double pointSpacing(const Points<Dim>& positions, const Box<Dim>& box)
{
  const double longest = box.sides().maxCoeff();
  if (positions.cols() == 0 || !(longest > 0))
  {
    return 0;
  }
  // Morton order: cubes of every size are runs of equal leading bits.
  const double scale = std::ldexp(1.0, SpacingBits) * (1 - 1e-12) / longest;
  std::vector<std::uint64_t> keys(static_cast<std::size_t>(positions.cols()), 0);
  for (std::int64_t k = 0; k < positions.cols(); ++k)
  {
    for (int a = 0; a < Dim; ++a)
    {
      const double q = (positions(a, k) - box.Lower[a]) * scale;
      keys[static_cast<std::size_t>(k)] |= spreadBits(static_cast<std::uint64_t>(q), Dim) << a;
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const double distinct = static_cast<double>(keys.size());

  for (int bits = SpacingBits - 1; bits >= 0; --bits)
  {
    const int shift = (SpacingBits - bits) * Dim;
    std::int64_t occupied = 1;
    for (std::size_t k = 1; k < keys.size(); ++k)
    {
      occupied += (keys[k] >> shift) != (keys[k - 1] >> shift);
    }
    const double perCube = distinct / static_cast<double>(occupied);
    if (perCube >= PointsPerCube || bits == 0)
    {
      return longest * std::ldexp(1.0, -bits) * std::pow(perCube, -1.0 / (Dim - 1));
    }
  }
  return 0;
}

template <int Dim>
PlacedLattice<Dim> latticeAround(
  const Box<Dim>& box, double padding, const Index<Dim>& size, double spacing)
{
  const Point<Dim> sides = box.sides();
  const double margin = padding * sides.maxCoeff();
  // The spacing that lets the given sizes span the box and its margins, whichever margin counts.
  double h = 0;
  for (int a = 0; a < Dim; ++a)
  {
    if (size[a] > 0)
    {
      const double cells = static_cast<double>(size[a] - (Order - 1));
      const double byPadding = (sides[a] + 2 * margin) / cells;
      const double free = cells - 2 * MarginInKnotSpacings;
      const double byMargin = free > 0 ? sides[a] / free : std::numeric_limits<double>::infinity();
      h =
        std::max(h, byMargin * MarginInKnotSpacings <= margin || free <= 0 ? byPadding : byMargin);
    }
  }
  if (!(h > 0))
  {
    h = spacing;
  }
  const double wide = std::max(margin, MarginInKnotSpacings * h);
  PlacedLattice<Dim> placed;
  for (int a = 0; a < Dim; ++a)
  {
    const auto cells =
      static_cast<std::int64_t>(std::ceil((sides[a] + 2 * wide) / h * (1 - 1e-12)));
    placed.Grid.Size[a] = size[a] > 0 ? size[a] : std::max<std::int64_t>(cells, 1) + Order - 1;
    placed.Grid.Spacing[a] = h;
    // Where the lattice is too coarse for the margins, the box stays in the middle.
    placed.Lower[a] =
      box.Lower[a] - std::max(0.0, std::min(wide, (placed.Grid.extent(a) - sides[a]) / 2));
  }
  return placed;
}

template <int Dim>
PlacedLattice<Dim> latticeOn(const Box<Dim>& box, const Index<Dim>& size, double spacing)
{
  PlacedLattice<Dim> placed;
  placed.Lower = box.Lower;
  const Point<Dim> sides = box.sides();
  for (int a = 0; a < Dim; ++a)
  {
    const auto cells = static_cast<std::int64_t>(std::ceil(sides[a] / spacing * (1 - 1e-12)));
    placed.Grid.Size[a] = size[a] > 0 ? size[a] : std::max<std::int64_t>(cells, 1) + Order - 1;
    placed.Grid.Spacing[a] = sides[a] / static_cast<double>(placed.Grid.cells(a));
  }
  return placed;
}

template double pointSpacing<2>(const Points<2>&, const Box<2>&);
template double pointSpacing<3>(const Points<3>&, const Box<3>&);
template PlacedLattice<2> latticeAround<2>(const Box<2>&, double, const Index<2>&, double);
template PlacedLattice<3> latticeAround<3>(const Box<3>&, double, const Index<3>&, double);
template PlacedLattice<2> latticeOn<2>(const Box<2>&, const Index<2>&, double);
template PlacedLattice<3> latticeOn<3>(const Box<3>&, const Index<3>&, double);
}
