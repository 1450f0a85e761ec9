// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Knot refinement: the same spline on a lattice of half the spacing.
 */
#ifndef ipia_KnotRefinement_h
#define ipia_KnotRefinement_h

#include "Lattice.h"

namespace ipia
{
/**
 * Coefficients of a spline after each knot cell was halved on every axis.
 *
 * The subdivision masks of the cubic B-spline are (1, 6, 1) / 8 at old knots and (1, 1) / 2 between
 * them. The function is unchanged on the part of the domain that the finer lattice covers.
 *
 * @param coarse        lattice of @a coefficients
 * @param coefficients  coarse.numberOfCoefficients() values
 * @param fine          lattice with the same lower corner, half the spacing and at most
 *                      2 (N - 3) + 3 coefficients per axis; fewer crop the domain at its upper end
 * @return fine.numberOfCoefficients() values
 */
template <int Dim>
Vector refineKnots(
  const Lattice<Dim>& coarse, const Vector& coefficients, const Lattice<Dim>& fine);
}

#endif
