// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The four uniform cubic B-splines that are not zero on a knot cell, as functions of the local
 * coordinate t in [0, 1] of the cell, and their derivatives with respect to t.
 */
#ifndef ipia_CubicBasis_h
#define ipia_CubicBasis_h

#include <array>

namespace ipia
{
using BasisValues = std::array<double, 4>;

inline BasisValues cubicBasis(double t)
{
  const double s = 1 - t;
  return { s * s * s / 6, 2. / 3 - t * t * (1 - t / 2), 2. / 3 - s * s * (1 - s / 2),
    t * t * t / 6 };
}

inline BasisValues cubicBasisFirstDerivative(double t)
{
  const double s = 1 - t;
  return { -s * s / 2, t * (1.5 * t - 2), s * (2 - 1.5 * s), t * t / 2 };
}

inline BasisValues cubicBasisSecondDerivative(double t)
{
  const double s = 1 - t;
  return { s, 1 - 3 * s, 1 - 3 * t, t };
}

/// The derivative of the given order, 0 to 2.
inline BasisValues cubicBasisDerivative(double t, int order)
{
  return order == 0 ? cubicBasis(t)
    : order == 1    ? cubicBasisFirstDerivative(t)
                    : cubicBasisSecondDerivative(t);
}
}

#endif
