// SPDX-License-Identifier: BSD-3-Clause
/**
 * The same bits on one, two and four threads, and from run to run.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkSphereSource.h"

#include <omp.h>

namespace
{
using ipiatest::Checks;
using ipiatest::Text;

vtkSmartPointer<vtkIPIAImplicitFitter> Fit(
  vtkPolyData* cloud, int threads, int constraint, int solver, int size)
{
  omp_set_num_threads(threads);
  auto fitter = ipiatest::NewClassicFitter(cloud, size);
  fitter->SetNormalConstraint(constraint);
  fitter->SetSolver(solver);
  fitter->SetMaximumNumberOfIterations(15);
  fitter->SetOutputScalarTypeToDouble();
  fitter->GenerateGradientOn();
  fitter->Update();
  return fitter;
}

void CheckCloud(
  Checks& checks, const std::string& name, vtkPolyData* cloud, int constraint, int size)
{
  for (int solver :
    { vtkIPIAImplicitFitter::ProgressiveIteration, vtkIPIAImplicitFitter::ConjugateGradient })
  {
    auto first = Fit(cloud, 1, constraint, solver, size);
    for (int threads : { 1, 2, 4 })
    {
      auto other = Fit(cloud, threads, constraint, solver, size);
      const std::string what = Text(name, ", ", size, "^3, constraint ", constraint, ", solver ",
        solver, ", ", threads, " thread(s)");
      checks.That(ipiatest::SameOutputs(first, other), what + ": same bits");
      checks.That(ipiatest::SameArray(first->GetOutput()->GetPointData()->GetArray("Gradient"),
                    other->GetOutput()->GetPointData()->GetArray("Gradient")),
        what + ": same gradient");
      checks.Equal(other->GetEnergy(), first->GetEnergy(), what + ": energy");
    }
  }
}

/// A sphere of meridians and parallels has many points at exactly equal distances.
vtkSmartPointer<vtkPolyData> SymmetricSphere()
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(64);
  sphere->SetPhiResolution(33);
  sphere->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  sphere->Update();
  return sphere->GetOutput();
}
}

int TestImplicitFitterThreads(int, char*[])
{
  Checks checks;
  for (const auto& surface : ipiatest::KnownSurfaces(10000))
  {
    auto cloud = ipiatest::ToPolyData(surface.Cloud);
    CheckCloud(checks, surface.Name, cloud, vtkIPIAImplicitFitter::OutwardOffset, 24);
    CheckCloud(checks, surface.Name, cloud, vtkIPIAImplicitFitter::TwoSidedOffset, 48);
  }
  CheckCloud(
    checks, "symmetric sphere", SymmetricSphere(), vtkIPIAImplicitFitter::TwoSidedOffset, 24);
  return checks.Result();
}
