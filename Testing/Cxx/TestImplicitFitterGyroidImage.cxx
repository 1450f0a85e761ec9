// SPDX-License-Identifier: BSD-3-Clause
/**
 * Two periods of a gyroid in a box: a surface that is open where the box cuts it. The back faces,
 * where f < 0, are gold.
 */
#include "IPIATestRendering.h"
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkFlyingEdges3D.h"
#include "vtkMath.h"

namespace
{
ipiatest::ImplicitShape Gyroid()
{
  const double end = 2 * vtkMath::Pi();
  return { [](const ipiatest::Vector3& x)
    {
      return std::sin(x[0]) * std::cos(x[1]) + std::sin(x[1]) * std::cos(x[2]) +
        std::sin(x[2]) * std::cos(x[0]);
    },
    [](const ipiatest::Vector3& x)
    {
      return ipiatest::Vector3{ std::cos(x[0]) * std::cos(x[1]) - std::sin(x[2]) * std::sin(x[0]),
        std::cos(x[1]) * std::cos(x[2]) - std::sin(x[0]) * std::sin(x[1]),
        std::cos(x[2]) * std::cos(x[0]) - std::sin(x[1]) * std::sin(x[2]) };
    },
    { -end, -end, -end }, { end, end, end } };
}
}

int TestImplicitFitterGyroidImage(int argc, char* argv[])
{
  const auto gyroid = Gyroid();
  auto fitter =
    ipiatest::NewClassicFitter(ipiatest::ToPolyData(ipiatest::PointsOn(gyroid, 30000)), 48);
  fitter->SetModelBounds(gyroid.Lower[0], gyroid.Upper[0], gyroid.Lower[1], gyroid.Upper[1],
    gyroid.Lower[2], gyroid.Upper[2]);
  fitter->SetMaximumNumberOfIterations(100);
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputConnection(fitter->GetOutputPort());
  surface->SetValue(0, 0.0);

  ipiatest::Picture picture;
  vtkActor* actor = picture.Add(surface->GetOutputPort(), 0.4, 0.6, 0.9);
  vtkNew<vtkProperty> inside;
  inside->SetColor(0.9, 0.7, 0.2);
  actor->SetBackfaceProperty(inside);
  picture.LookFrom(2, -3, 1.5, 0, 0, 1);
  picture.Renderer->GetActiveCamera()->Zoom(1.4);
  return picture.Compare(argc, argv);
}
