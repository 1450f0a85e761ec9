// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Rows that prescribe value and gradient of f, sorted by brick and knot cell.
 */
#ifndef ipia_HermiteRows_h
#define ipia_HermiteRows_h

#include "BrickLattice.h"

namespace ipia
{
/// f(x) = Value and, where GradientWeight > 0, h grad f(x) = Slope, x given in its knot cell.
/// Slope is the derivative with respect to the local coordinates: h_a n_a on axis a.
template <int Dim>
struct HermiteRow
{
  std::array<float, Dim> T;
  float Weight;
  float Value; ///< the kernels load Value and Slope as one vector
  std::array<float, Dim> Slope;
  float GradientWeight;
  std::int32_t Cell;   ///< local index of the knot cell in its brick, x fastest
  std::int32_t Source; ///< index of the point or cluster it stands for
};

/**
 * The rows of one level. Bricks of one colour (the parity of their position on each axis) touch
 * disjoint coefficients.
 */
template <int Dim>
struct HermiteRows
{
  static constexpr int NumberOfColours = 1 << Dim;

  struct Brick
  {
    std::int32_t Id; ///< in the BrickLattice
    std::int64_t Begin, End;
  };

  BulkVector<HermiteRow<Dim>> Rows;
  std::vector<Brick> Bricks; ///< by colour
  std::array<std::size_t, NumberOfColours + 1> ColourBegin{};
};
}

#endif
