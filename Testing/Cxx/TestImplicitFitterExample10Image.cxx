// SPDX-License-Identifier: BSD-3-Clause
/**
 * Example 10 of the paper of 2024: 500 noisy points of an ellipse on 20 x 20 coefficients, without
 * and with the oscillation's weight, which is beyond the limit of the printed step.
 */
#include "IPIATestFields.h"

int TestImplicitFitterExample10Image(int argc, char* argv[])
{
  ipiatest::OrientedPoints points;
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(5);
  const auto noise = [&]
  {
    random->Next();
    return random->GetRangeValue(-0.08, 0.08);
  };
  constexpr int n = 500;
  for (int k = 0; k < n; ++k)
  {
    const double t = 2 * 3.14159265358979323846 * k / n, s = std::sin(t), c = std::cos(t);
    const double length = std::hypot(5 * c, 4 * s), dx = noise(), dy = noise();
    points.Add({ 4 * c + dx, 5 * s + dy, 0 }, { 5 * c / length, 4 * s / length, 0 });
  }
  ipiatest::FieldPicture picture(2);
  for (const double weight : { 0.0, 0.314 })
  {
    auto fitter = ipiatest::NewPaperFitter(points, 20, 1e-2, 1000);
    fitter->SetOscillationWeight(weight);
    picture.Add(fitter);
  }
  return picture.Compare(argc, argv);
}
