// SPDX-License-Identifier: BSD-3-Clause
/**
 * Every closed surface has the right number of components and handles and no border, whatever the
 * offsets, the solver, the lattice and the number of iterations of the classic method.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

namespace
{
using ipiatest::Text;

void TestSurface(
  ipiatest::Checks& checks, const ipiatest::KnownSurface& surface, const std::vector<int>& sizes)
{
  auto fitter = ipiatest::NewClassicFitter(ipiatest::ToPolyData(surface.Cloud));
  for (int constraint :
    { vtkIPIAImplicitFitter::OutwardOffset, vtkIPIAImplicitFitter::TwoSidedOffset })
  {
    for (int solver :
      { vtkIPIAImplicitFitter::ProgressiveIteration, vtkIPIAImplicitFitter::ConjugateGradient })
    {
      for (int size : sizes)
      {
        for (int iterations : { 15, 100 })
        {
          fitter->SetNormalConstraint(constraint);
          fitter->SetSolver(solver);
          fitter->SetGridSize(size, size, size);
          fitter->SetMaximumNumberOfIterations(iterations);
          const ipiatest::Topology expected{ surface.Components, surface.Genus, 0, 0 };
          checks.Equal(ipiatest::TopologyOf(ipiatest::ZeroSurface(fitter)), expected,
            Text(surface.Name, ", ", surface.Cloud.Positions.size(), " points, ", size,
              "^3, constraint ", constraint, ", solver ", solver, ", ", iterations, " iterations"));
        }
      }
    }
  }
}
}

int TestImplicitFitterTopology(int, char*[])
{
  ipiatest::Checks checks;
  for (const auto& surface : ipiatest::KnownSurfaces(10000))
  {
    TestSurface(checks, surface, { 24, 48, 70 });
  }
  // At 70^3 the gaps between random points are several knot spacings wide: real holes.
  for (auto surface : ipiatest::KnownSurfaces(10000, ipiatest::Choice::Random))
  {
    surface.Name = "random " + surface.Name;
    TestSurface(checks, surface, { 24, 48 });
  }
  return checks.Result();
}
