// SPDX-License-Identifier: BSD-3-Clause
#include "AutomaticLattice.h"

#include "MortonOrder.h"
#include "Parallel.h"

#include <limits>

namespace ipia
{
namespace
{
/// Bits per axis of the finest cubes that points are told apart by.
constexpr int SpacingBits = 20;

/// Points that an occupied cube must hold on average for their count to measure area (length).
constexpr double PointsPerCube = 4;

}

template <int Dim>
double pointSpacing(const Points<Dim>& positions, const Box<Dim>& box, int threads)
{
  const double longest = box.sides().maxCoeff();
  if (positions.cols() == 0 || !(longest > 0))
  {
    return 0;
  }
  threads = resolveThreads(threads);
  const double scale = std::ldexp(1.0, SpacingBits) * (1 - 1e-12) / longest;
  BulkVector<std::uint64_t> keys(static_cast<std::size_t>(positions.cols()));
  parallelChunks(positions.cols(), threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t k = begin; k < end; ++k)
      {
        Index<Dim> cube;
        for (int a = 0; a < Dim; ++a)
        {
          cube[static_cast<std::size_t>(a)] =
            static_cast<std::int64_t>((positions(a, k) - box.Lower[a]) * scale);
        }
        keys[static_cast<std::size_t>(k)] = mortonKey<Dim>(cube);
      }
    });
  sortByKey(
    keys, [](std::uint64_t key) { return key; }, threads);

  // Neighbours in the order that are told apart by each bit, the highest that they differ in.
  using Counts = Eigen::Matrix<std::int64_t, SpacingBits * Dim, 1>;
  const auto apart = parallelSum<Counts>(
    positions.cols() - 1, threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      Counts counts = Counts::Zero();
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      {
        const std::uint64_t differing = keys[k] ^ keys[k + 1];
        if (differing != 0)
        {
          ++counts[63 - __builtin_clzll(differing)];
        }
      }
      return counts;
    },
    Counts::Zero());
  const auto distinct = static_cast<double>(1 + apart.sum());
  for (int bits = SpacingBits - 1; bits >= 0; --bits)
  {
    const auto occupied = static_cast<double>(1 + apart.tail(bits * Dim).sum());
    const double perCube = distinct / occupied;
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

template double pointSpacing<2>(const Points<2>&, const Box<2>&, int);
template double pointSpacing<3>(const Points<3>&, const Box<3>&, int);
template PlacedLattice<2> latticeAround<2>(const Box<2>&, double, const Index<2>&, double);
template PlacedLattice<3> latticeAround<3>(const Box<3>&, double, const Index<3>&, double);
template PlacedLattice<2> latticeOn<2>(const Box<2>&, const Index<2>&, double);
template PlacedLattice<3> latticeOn<3>(const Box<3>&, const Index<3>&, double);
}
