// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The choice of the control points to fair, where the user makes none.
 */
#ifndef ipia_AutomaticFairing_h
#define ipia_AutomaticFairing_h

#include "FairingSystem.h"

namespace ipia
{
/**
 * Second differences of gridded data, |Q_{i-1} - 2 Q_i + Q_{i+1}| along the first axis plus the
 * same along the second, one per data point (section 5.2 of Jiang and Lin). At the ends of an open
 * axis its difference is that of the neighbour.
 */
Vector secondDifferences(const Eigen::MatrixXd& points, const std::array<std::int64_t, 2>& size,
  const std::array<bool, 2>& closed);

/**
 * How fast the curvature of a spline changes along it, one value per control point: |d kappa / ds|
 * of curves, |grad H| of surfaces (along their parameter lines), each the root of its mean square
 * over the samples in the support, weighted by the control point's basis function.
 */
Vector curvatureVariation(const TensorSpline& spline);

/**
 * The weights that follow: @a raised for the round(share n) control points with the largest
 * measure, of equals the first ones, @a base for the others.
 * @param share  0 to 1
 */
Vector raiseLargest(const Vector& measure, double share, double base, double raised);
}

#endif
