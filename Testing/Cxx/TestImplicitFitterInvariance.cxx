// SPDX-License-Identifier: BSD-3-Clause
/**
 * Far from the origin, tiny or huge: the same points give the same function.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

namespace
{
using ipiatest::Checks;
using ipiatest::Method;
using ipiatest::OrientedPoints;
using ipiatest::Text;

OrientedPoints Moved(const OrientedPoints& cloud, double scale, double shift)
{
  OrientedPoints moved = cloud;
  for (auto& x : moved.Positions)
  {
    for (double& c : x)
    {
      c = scale * c + shift;
    }
  }
  return moved;
}

/// The fit of a moved cloud.
vtkSmartPointer<vtkIPIAImplicitFitter> Fit(
  const OrientedPoints& cloud, Method method, int solver, double scale, double shift)
{
  auto fitter = NewFitter(method, ipiatest::ToPolyData(Moved(cloud, scale, shift)), 24);
  fitter->SetSolver(solver);
  fitter->SetOutputScalarTypeToDouble();
  fitter->Update();
  return fitter;
}

/// f scales with the points; relative to its largest value.
void CheckSame(Checks& checks, const OrientedPoints& cloud, Method method, int solver, double scale,
  double shift)
{
  auto plain = Fit(cloud, method, solver, 1, 0);
  auto moved = Fit(cloud, method, solver, scale, shift);
  vtkDataArray* expected = plain->GetOutput()->GetPointData()->GetScalars();
  vtkDataArray* values = moved->GetOutput()->GetPointData()->GetScalars();
  const std::string what = Text(cloud.Positions.size(), " points, ", NameOf(method), ", solver ",
    solver, ", times ", scale, " plus ", shift);
  if (!checks.Equal(values->GetNumberOfTuples(), expected->GetNumberOfTuples(), what + ": samples"))
  {
    return;
  }
  double largest = 0, difference = 0;
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    const double f = expected->GetComponent(i, 0);
    const double d = std::abs(values->GetComponent(i, 0) / scale - f);
    largest = std::max(largest, std::abs(f));
    difference = d <= difference ? difference : d;
  }
  checks.That(largest > 0, what + ": f is not 0");
  // The hierarchy computes in single precision.
  checks.AtMost(
    difference / largest, method == Method::Classic ? 1e-6 : 5e-6, what + ": relative difference");
}
}

int TestImplicitFitterInvariance(int, char*[])
{
  Checks checks;
  const OrientedPoints clouds[] = { ipiatest::PointsOn(ipiatest::Torus(1, 0.4), 3000),
    ipiatest::PointsOn(ipiatest::Flower(), 300) };
  for (const OrientedPoints& cloud : clouds)
  {
    for (double scale : { 1., 1e-6, 1e6 })
    {
      const double shift = scale == 1 ? 5e6 : 0;
      CheckSame(
        checks, cloud, Method::Classic, vtkIPIAImplicitFitter::ProgressiveIteration, scale, shift);
      for (Method method : ipiatest::Methods)
      {
        CheckSame(checks, cloud, method, vtkIPIAImplicitFitter::ConjugateGradient, scale, shift);
      }
    }
  }
  return checks.Result();
}
