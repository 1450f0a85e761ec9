// SPDX-License-Identifier: BSD-3-Clause
/**
 * Example 6 of the paper of 2024 and its Fig. 15: an outline in its place on 25 x 25 coefficients
 * after 1, 10, 100 and 1000 iterations with the oscillation's weight (above) and without (below).
 */
#include "IPIATestFields.h"

int TestImplicitFitterExample6Image(int argc, char* argv[])
{
  const ipiatest::PolarCurve flower = { [](double t) { return 2.8 + 1.26 * std::cos(9 * t); },
    [](double t) { return -11.34 * std::sin(9 * t); } };
  const auto points = ipiatest::PointsOn(flower, 400);
  ipiatest::FieldPicture picture(4, 2);
  for (const double weight : { 0.00425, 0.0 })
  {
    for (const int iterations : { 1, 10, 100, 1000 })
    {
      auto fitter = ipiatest::NewPaperFitter(points, 25, 1e-3, iterations);
      fitter->SetOscillationWeight(weight);
      fitter->SetOscillationStepToAsPrinted();
      picture.Add(fitter);
    }
  }
  return picture.Compare(argc, argv);
}
