// SPDX-License-Identifier: BSD-3-Clause
/**
 * The outline of a butterfly, red, through its points, grey.
 */
#include "IPIATestRendering.h"
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkFlyingEdges2D.h"

int TestImplicitFitterCurveImage(int argc, char* argv[])
{
  auto cloud = ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Butterfly(), 120));
  auto fitter = ipiatest::NewClassicFitter(cloud, 60);
  fitter->SetMaximumNumberOfIterations(100);
  vtkNew<vtkFlyingEdges2D> curve;
  curve->SetInputConnection(fitter->GetOutputPort());
  curve->SetValue(0, 0.0);

  ipiatest::Picture picture;
  vtkProperty* points = picture.Add(fitter->GetOutputPort(1), 0.6, 0.6, 0.6)->GetProperty();
  points->SetPointSize(6);
  points->LightingOff();
  vtkProperty* line = picture.Add(curve->GetOutputPort(), 0.8, 0, 0)->GetProperty();
  line->SetLineWidth(2);
  line->LightingOff();
  picture.LookFrom(0, 0, 1, 0, 1, 0);
  picture.Renderer->GetActiveCamera()->Zoom(1.1);
  return picture.Compare(argc, argv);
}
