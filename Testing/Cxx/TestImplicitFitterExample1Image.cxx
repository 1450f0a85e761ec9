// SPDX-License-Identifier: BSD-3-Clause
/**
 * Example 1 of the paper of 2024: its curve on 9 x 9 coefficients, 200 iterations, with the
 * B-spline and the rational basis, and with an oscillation's weight.
 */
#include "IPIATestFields.h"

int TestImplicitFitterExample1Image(int argc, char* argv[])
{
  ipiatest::OrientedPoints points;
  constexpr int n = 120;
  for (int k = 0; k < n; ++k)
  {
    const double t = 2 * 3.14159265358979323846 * k / n, s = std::sin(t), c = std::cos(t);
    const double x = 3 * c - 10 * s * c, y = 4 * s, length = std::hypot(x, y);
    points.Add({ 4 * c, s * (3 - 5 * s), 0 }, { x / length, y / length, 0 });
  }
  ipiatest::FieldPicture picture(3);
  auto spline = ipiatest::NewPaperFitter(points, 9, 1e-2, 200);
  spline->SetBasisTypeToBSpline();
  picture.Add(spline);
  picture.Add(ipiatest::NewPaperFitter(points, 9, 1e-2, 200));
  auto smooth = ipiatest::NewPaperFitter(points, 9, 1e-2, 200);
  smooth->SetOscillationWeight(0.002);
  smooth->SetOscillationStepToAsPrinted();
  picture.Add(smooth);
  return picture.Compare(argc, argv);
}
