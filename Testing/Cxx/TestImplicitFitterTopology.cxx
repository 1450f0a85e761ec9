// SPDX-License-Identifier: BSD-3-Clause
/**
 * Every closed surface has the right number of components and handles and no border, whatever the
 * choice of points, the offsets, the solver, the lattice and the number of iterations of the
 * classic method.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

namespace
{
using ipiatest::Text;

void TestSurface(
  ipiatest::Checks& checks, const ipiatest::KnownSurface& surface, ipiatest::Choice choice)
{
  auto fitter = ipiatest::NewClassicFitter(ipiatest::ToPolyData(surface.Cloud));
  for (int constraint :
    { vtkIPIAImplicitFitter::OutwardOffset, vtkIPIAImplicitFitter::TwoSidedOffset })
  {
    for (int solver :
      { vtkIPIAImplicitFitter::ProgressiveIteration, vtkIPIAImplicitFitter::ConjugateGradient })
    {
      for (int size : { 24, 48, 70 })
      {
        for (int iterations : { 15, 100 })
        {
          fitter->SetNormalConstraint(constraint);
          fitter->SetSolver(solver);
          fitter->SetGridSize(size, size, size);
          fitter->SetMaximumNumberOfIterations(iterations);
          const ipiatest::Topology expected{ surface.Components, surface.Genus, 0, 0 };
          checks.Equal(ipiatest::TopologyOf(ipiatest::ZeroSurface(fitter)), expected,
            Text(surface.Name, ", ", surface.Cloud.Positions.size(),
              choice == ipiatest::Choice::Even ? " even points, " : " random points, ", size,
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
  for (auto choice : { ipiatest::Choice::Even, ipiatest::Choice::Random })
  {
    for (const auto& surface : ipiatest::KnownSurfaces(10000, choice))
    {
      TestSurface(checks, surface, choice);
    }
  }
  return checks.Result();
}
