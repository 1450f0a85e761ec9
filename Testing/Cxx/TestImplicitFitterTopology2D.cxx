// SPDX-License-Identifier: BSD-3-Clause
/**
 * Outlines in each axis plane give the right number of closed loops with both contour filters.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkContourFilter.h"
#include "vtkFlyingEdges2D.h"

namespace
{
using ipiatest::OrientedPoints;
using ipiatest::Text;

struct Outline
{
  std::string Name;
  OrientedPoints Cloud;
  int Loops;
  std::vector<int> Sizes; ///< GridSize whose knot spacing shows the outline
};

std::vector<Outline> Outlines()
{
  using ipiatest::PointsOn;
  OrientedPoints pair = PointsOn(ipiatest::Circle(1), 200);
  pair.Append(PointsOn(ipiatest::Circle(1), 200, 3, 0.4));
  OrientedPoints ring = PointsOn(ipiatest::Circle(1), 200);
  OrientedPoints hole = PointsOn(ipiatest::Circle(0.5), 100);
  for (auto& normal : hole.Normals)
  {
    normal = { -normal[0], -normal[1], 0 };
  }
  ring.Append(hole);
  return {
    { "circle", PointsOn(ipiatest::Circle(1), 200), 1, { 24, 48, 70 } },
    { "two circles", pair, 2, { 24, 48, 70 } }, { "ring", ring, 2, { 24, 48, 70 } },
    { "flower", PointsOn(ipiatest::Flower(), 400), 1, { 24, 48, 70 } },
    { "butterfly", PointsOn(ipiatest::Butterfly(), 400), 1,
      { 48, 70 } }, // the antennae are narrower than a spacing of 24^2
  };
}

template <typename Contour>
void TestLoops(
  ipiatest::Checks& checks, vtkIPIAImplicitFitter* fitter, int expected, const std::string& what)
{
  vtkNew<Contour> contour;
  contour->SetInputConnection(fitter->GetOutputPort());
  contour->SetValue(0, 0.0);
  contour->Update();
  vtkPolyData* curve = contour->GetOutput();
  const std::string name = what + " by " + contour->GetClassName();
  checks.Equal(ipiatest::CountComponents(curve), expected, name + ": loops");
  checks.That(ipiatest::IsClosedCurve(curve), name + ": every loop is closed");
}

void TestOutline(ipiatest::Checks& checks, const Outline& outline, int first, int second)
{
  constexpr double height = 7;
  const int across = 3 - first - second;
  auto fitter = ipiatest::NewClassicFitter(
    ipiatest::ToPolyData(ipiatest::InPlane(outline.Cloud, first, second, height)));
  for (int constraint :
    { vtkIPIAImplicitFitter::OutwardOffset, vtkIPIAImplicitFitter::TwoSidedOffset })
  {
    for (int solver :
      { vtkIPIAImplicitFitter::ProgressiveIteration, vtkIPIAImplicitFitter::ConjugateGradient })
    {
      for (int size : outline.Sizes)
      {
        fitter->SetNormalConstraint(constraint);
        fitter->SetSolver(solver);
        fitter->SetGridSize(size, size, size);
        fitter->SetMaximumNumberOfIterations(
          solver == vtkIPIAImplicitFitter::ConjugateGradient ? 15 : 100);
        const std::string what = Text(outline.Name, " in the plane of axes ", first, " and ",
          second, ", ", size, "^2, constraint ", constraint, ", solver ", solver);
        TestLoops<vtkFlyingEdges2D>(checks, fitter, outline.Loops, what);
        TestLoops<vtkContourFilter>(checks, fitter, outline.Loops, what);
        checks.Equal(fitter->GetOutput()->GetDimensions()[across], 1, what + ": slices");
        checks.Equal(fitter->GetOutput()->GetOrigin()[across], height, what + ": height");
      }
    }
  }
}
}

int TestImplicitFitterTopology2D(int, char*[])
{
  ipiatest::Checks checks;
  for (const Outline& outline : Outlines())
  {
    TestOutline(checks, outline, 0, 1);
    TestOutline(checks, outline, 1, 2);
    TestOutline(checks, outline, 0, 2);
  }
  return checks.Result();
}
