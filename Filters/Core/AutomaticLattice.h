// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The domain and the lattice that the points themselves suggest.
 */
#ifndef ipia_AutomaticLattice_h
#define ipia_AutomaticLattice_h

#include "Lattice.h"

namespace ipia
{
/// A box in the coordinates of the points.
template <int Dim>
struct Box
{
  Point<Dim> Lower, Upper;

  Point<Dim> sides() const { return this->Upper - this->Lower; }
};

/// The lattice and where its domain lies.
template <int Dim>
struct PlacedLattice
{
  Lattice<Dim> Grid;
  Point<Dim> Lower; ///< lower corner of the domain, in the coordinates of the points
};

/**
 * The side of cubes (squares) of which the points occupy as many as there are distinct points:
 * about the spacing of points that cover a surface (curve) evenly. 0 if all points are equal.
 *
 * @param positions  Dim x n, inside the box
 * @param threads    0: OpenMP's choice; the result does not depend on it
 */
template <int Dim>
double pointSpacing(const Points<Dim>& positions, const Box<Dim>& box, int threads = 0);

/// Width of the margin that an automatic domain has at least, in knot spacings: room for the offset
/// rows at 1.5 h and for the fall of f beyond them.
constexpr double MarginInKnotSpacings = 2;

/**
 * A lattice with one knot spacing for all axes, on a box enlarged by a margin.
 *
 * The margin is @a padding times the longest side, at least MarginInKnotSpacings spacings. The
 * upper end grows to a whole number of spacings.
 *
 * @param size     coefficients per axis, each >= 4, or 0 where it follows from the spacing
 * @param spacing  the spacing to use where all sizes are 0, > 0; otherwise it follows from the
 * sizes
 */
template <int Dim>
PlacedLattice<Dim> latticeAround(
  const Box<Dim>& box, double padding, const Index<Dim>& size, double spacing);

/// A lattice on exactly the given box; sizes that are 0 follow from the wanted spacing.
template <int Dim>
PlacedLattice<Dim> latticeOn(const Box<Dim>& box, const Index<Dim>& size, double spacing);
}

#endif
