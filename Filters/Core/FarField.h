// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What f is where no data say it.
 *
 * With a zero start, coefficients that no row touches stay 0, and around the band of data f decays
 * to 0 with arbitrary sign. Contour filters count 0 as outside, so that the inner rim of the band
 * would become a second sheet, and ripples beside it would become bubbles. The far field gives a
 * constant of the right sign to such boxes of half a knot spacing (Lattice::locateBox).
 */
#ifndef ipia_FarField_h
#define ipia_FarField_h

#include "ConstraintRows.h"

#include <vector>

namespace ipia
{
/// The sign of f per box where it is not the spline: +1, -1, or 0 where the spline counts.
/// Empty: the spline counts everywhere.
struct FarField
{
  std::vector<std::int8_t> Sign;
  double Magnitude = 0; ///< |f| in the boxes of the far field, > 0

  /// Regions that nothing vouches for whose rims have both signs (an open surface, a wide hole).
  int NumberOfMixedRegions = 0;

  double value(std::int64_t box) const
  {
    return this->Sign[static_cast<std::size_t>(box)] * this->Magnitude;
  }
};

struct FarFieldOptions
{
  double Threshold = 0.02; ///< a box is unsupported where s < Threshold
  double Magnitude = 1;    ///< |f| there
  int Threads = 0;
};

/// The median over the points of the support s(x) = sum_i B_i(x) S_i; 0 without points.
template <int Dim>
double medianSupport(
  const Lattice<Dim>& lattice, const Vector& support, const Points<Dim>& dataPoints, int threads);

/**
 * Finds the boxes where the spline does not count: the sign of f holds where data vouch for it, and
 * every connected region of the other boxes takes the sign that surrounds it.
 *
 * Data vouch for the box of a position just outside some data point if f > 0 in its centre, of one
 * just inside if f < 0, and for all boxes that it reaches through support without a change of sign.
 * A box has support where s(x) = sum_i B_i(x) S_i at its centre is at least the threshold; S_i is
 * the sum of B_i over the centres of the knot cells that hold rows (one each, so that thinly
 * sampled parts count as data too), scaled so that the median of s at the data points is 1.
 *
 * The sign of a region is that of the larger share of the vouched boxes around it. Where these have
 * both signs, data vouch down to 1/25 of the threshold, so that holes of a few knot spacings close.
 * Within a region the spline counts on where it has support and the sign of the region, and in the
 * boxes of data points always. Boxes beside a constant that have its sign and no other around them
 * take it too: what shows at one centre reaches into the next box.
 *
 * @param support       S, scaled, lattice.numberOfCoefficients() values
 * @param coefficients  of f
 * @param outside       Dim x n, positions just outside the data, where f > 0 is right
 * @param inside        Dim x m, positions just inside, where f < 0 is right
 * @param dataPoints    Dim x l, the boxes of which are left to the spline
 */
template <int Dim>
FarField computeFarField(const Lattice<Dim>& lattice, const Vector& support,
  const Vector& coefficients, const Points<Dim>& outside, const Points<Dim>& inside,
  const Points<Dim>& dataPoints, const FarFieldOptions& options);
}

#endif
