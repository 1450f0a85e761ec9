// SPDX-License-Identifier: BSD-3-Clause
/**
 * A torus from points.
 */
#include "IPIATestRendering.h"
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkFlyingEdges3D.h"

int TestImplicitFitterTorusImage(int argc, char* argv[])
{
  auto cloud = ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Torus(1, 0.4), 5000));
  auto fitter = ipiatest::NewClassicFitter(cloud, 48);
  fitter->SetMaximumNumberOfIterations(100);
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputConnection(fitter->GetOutputPort());
  surface->SetValue(0, 0.0);

  ipiatest::Picture picture;
  picture.Add(surface->GetOutputPort(), 0.4, 0.6, 0.9);
  picture.LookFrom(1, -2, 2, 0, 0, 1);
  picture.Renderer->GetActiveCamera()->Zoom(1.4);
  return picture.Compare(argc, argv);
}
