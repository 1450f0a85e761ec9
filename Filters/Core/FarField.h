// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What f is where no data say it.
 *
 * With a zero start, coefficients that no row touches stay 0, and around the band of data f decays
 * to 0 with arbitrary sign. Contour filters count 0 as outside, so that the inner rim of the band
 * would become a second sheet, and ripples beside it would become bubbles. The far field gives such
 * knot cells a constant of the right sign.
 */
#ifndef ipia_FarField_h
#define ipia_FarField_h

#include "ConstraintRows.h"

#include <vector>

namespace ipia
{
/// The sign of f per knot cell where it is not the spline: +1, -1, or 0 where the spline counts.
/// Empty: the spline counts everywhere.
struct FarField
{
  std::vector<std::int8_t> Sign;
  double Magnitude = 0; ///< |f| in unsupported cells, > 0

  /// Regions without support whose rims have both signs (an open surface, a wide hole).
  int NumberOfMixedRegions = 0;

  double value(std::int64_t cell) const
  {
    return this->Sign[static_cast<std::size_t>(cell)] * this->Magnitude;
  }
};

struct FarFieldOptions
{
  double Threshold = 0.05; ///< a cell is unsupported where s < Threshold
  double Magnitude = 1;    ///< |f| there
  int Threads = 0;
};

/// The median over the points of the support s(x) = sum_i B_i(x) S_i; 0 without points.
template <int Dim>
double medianSupport(
  const Lattice<Dim>& lattice, const Vector& support, const Points<Dim>& dataPoints, int threads);

/**
 * Finds the cells where the spline does not count, in two steps.
 *
 * 1. Cells without support: s(x) = sum_i B_i(x) S_i with S_i the sum of B_i over the centres of the
 *    knot cells that hold rows (one each, so that thinly sampled parts count as data too), scaled
 * so that its median at the data points is 1, is below the threshold at the centre. Each connected
 *    region of them takes the sign of the larger share of the supported cells around it. Where
 * these have both signs the spline counts first down to 1/25 of the threshold, so that holes of a
 * few knot spacings close.
 * 2. Signs that nothing vouches for: on the grid of half knot spacings, a connected region where f
 * > 0 must hold a position just outside some data point, one where f < 0 a position just inside;
 *    otherwise the cells of that region take the opposite sign, but for those that hold data
 * points.
 *
 * @param support       S, scaled, lattice.numberOfCoefficients() values
 * @param coefficients  of f
 * @param outside       Dim x n, positions just outside the data, where f > 0 is right
 * @param inside        Dim x m, positions just inside, where f < 0 is right
 * @param dataPoints    Dim x l, the cells of which are left alone by step 2
 */
template <int Dim>
FarField computeFarField(const Lattice<Dim>& lattice, const Vector& support,
  const Vector& coefficients, const Points<Dim>& outside, const Points<Dim>& inside,
  const Points<Dim>& dataPoints, const FarFieldOptions& options);
}

#endif
