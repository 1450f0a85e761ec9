// SPDX-License-Identifier: BSD-3-Clause
/**
 * The far field is what makes the topology right: without it the same coefficients give false
 * sheets.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkFieldData.h"
#include "vtkIPIAImplicitFunction.h"
#include "vtkSampleFunction.h"

namespace
{
using ipiatest::Text;

/// The number of components of the zero surface of a control lattice on the samples of an image.
int CountComponents(vtkImageData* lattice, vtkImageData* samples)
{
  vtkNew<vtkIPIAImplicitFunction> function;
  function->SetControlLattice(lattice);
  vtkNew<vtkSampleFunction> sampler;
  sampler->SetImplicitFunction(function);
  sampler->SetModelBounds(samples->GetBounds());
  sampler->SetSampleDimensions(samples->GetDimensions());
  sampler->SetOutputScalarTypeToDouble();
  sampler->ComputeNormalsOff();
  return ipiatest::CountComponents(ipiatest::ZeroSurface(sampler));
}

vtkSmartPointer<vtkImageData> WithoutFarField(vtkImageData* lattice)
{
  auto bare = vtkSmartPointer<vtkImageData>::New();
  bare->ShallowCopy(lattice);
  bare->GetFieldData()->RemoveArray("FarField");
  return bare;
}

void TestSurface(ipiatest::Checks& checks, const ipiatest::KnownSurface& surface, int constraint)
{
  // So fine that the band of data does not fill the shape.
  const int size = surface.Genus == 2 ? 70 : 48;
  auto fitter = ipiatest::NewClassicFitter(ipiatest::ToPolyData(surface.Cloud), size);
  fitter->SetNormalConstraint(constraint);
  fitter->SetMaximumNumberOfIterations(100);
  fitter->Update();
  vtkImageData* lattice = ipiatest::ControlLattice(fitter);
  const std::string name = Text(surface.Name, ", constraint ", constraint);
  checks.That(lattice->GetFieldData()->GetArray("FarField") != nullptr, name + " has a far field");
  checks.Equal(CountComponents(lattice, fitter->GetOutput()), surface.Components,
    name + ": components with the far field");
  const int bare = CountComponents(WithoutFarField(lattice), fitter->GetOutput());
  checks.That(bare > surface.Components,
    Text(
      name, ": more than ", surface.Components, " components without the far field (", bare, ")"));
}
}

int TestImplicitFitterFarField(int, char*[])
{
  ipiatest::Checks checks;
  for (const auto& surface : ipiatest::KnownSurfaces(10000))
  {
    for (int constraint :
      { vtkIPIAImplicitFitter::OutwardOffset, vtkIPIAImplicitFitter::TwoSidedOffset })
    {
      TestSurface(checks, surface, constraint);
    }
  }
  return checks.Result();
}
