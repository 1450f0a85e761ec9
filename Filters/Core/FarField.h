// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What f is where no data says it.
 *
 * With a zero start, coefficients that no row touches stay 0, and where the band of data ends f decays
 * to 0. Contour filters count 0 as outside, so that the inner rim of the band would become a second
 * sheet. Knot cells without support therefore get a constant of the sign that their region's rim has.
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

  /// Whether a region without support had rims of both signs (an open surface, a wide hole).
  int NumberOfMixedRegions = 0;

  double value(std::int64_t cell) const
  {
    return this->Sign[static_cast<std::size_t>(cell)] * this->Magnitude;
  }
};

struct FarFieldOptions
{
  double Threshold = 0.05; ///< a cell is unsupported where s < Threshold; 0: none is
  double Magnitude = 1;    ///< |f| there
  int Threads = 0;
};

/// The median over the points of the support s(x) = sum_i B_i(x) S_i; 0 without points.
template <int Dim>
double medianSupport(const Lattice<Dim>& lattice, const Vector& support,
  const Points<Dim>& dataPoints, int threads);

/**
 * Finds the cells without support and the sign of each connected region of them.
 *
 * Support s(x) = sum_i B_i(x) S_i, with S_i = sum_k B_i(x_k) over all rows, scaled so that its median
 * at the data points is 1, is taken at cell centres. A region's sign is that of the larger share of the supported cells that share a face with it.
 *
 * @param support       S, scaled, lattice.numberOfCoefficients() values
 * @param coefficients  of f
 */
template <int Dim>
FarField computeFarField(const Lattice<Dim>& lattice, const Vector& support,
  const Vector& coefficients, const FarFieldOptions& options);
}

#endif
