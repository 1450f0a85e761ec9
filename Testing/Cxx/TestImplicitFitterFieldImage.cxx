// SPDX-License-Identifier: BSD-3-Clause
/**
 * f of a flower as colours, blue inside over white to red outside, with its zero contour, black.
 */
#include "IPIATestRendering.h"
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkColorTransferFunction.h"
#include "vtkFlyingEdges2D.h"
#include "vtkImageDataGeometryFilter.h"

int TestImplicitFitterFieldImage(int argc, char* argv[])
{
  auto cloud = ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Flower(), 300));
  auto fitter = ipiatest::NewClassicFitter(cloud, 48);
  fitter->SetMaximumNumberOfIterations(100);
  fitter->SetSampleDimensions(300, 300, 0);
  vtkNew<vtkImageDataGeometryFilter> field;
  field->SetInputConnection(fitter->GetOutputPort());
  vtkNew<vtkFlyingEdges2D> curve;
  curve->SetInputConnection(fitter->GetOutputPort());
  curve->SetValue(0, 0.0);

  ipiatest::Picture picture;
  vtkActor* map = picture.Add(field->GetOutputPort(), 1, 1, 1);
  fitter->Update();
  const double end = fitter->GetOffsetDistanceUsed();
  vtkNew<vtkColorTransferFunction> colours;
  colours->SetColorSpaceToDiverging();
  colours->AddRGBPoint(-end, 0.23, 0.3, 0.75);
  colours->AddRGBPoint(end, 0.7, 0.02, 0.15);
  map->GetMapper()->SetLookupTable(colours);
  map->GetMapper()->ScalarVisibilityOn();
  map->GetProperty()->LightingOff();
  vtkActor* line = picture.Add(curve->GetOutputPort(), 0, 0, 0);
  line->GetProperty()->SetLineWidth(2);
  line->SetPosition(0, 0, 0.01); // in front of the colours
  picture.LookFrom(0, 0, 1, 0, 1, 0);
  picture.Renderer->GetActiveCamera()->Zoom(1.35);
  return picture.Compare(argc, argv);
}
