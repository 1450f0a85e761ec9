// SPDX-License-Identifier: BSD-3-Clause
/**
 * A noisy starfish, grey points, its fair curve, red, with the curvature comb, blue.
 */
#include "IPIATestFairing.h"
#include "IPIATestRendering.h"

#include "vtkHedgeHog.h"
#include "vtkVertexGlyphFilter.h"

int TestFairingPIACurveImage(int argc, char* argv[])
{
  vtkNew<vtkFairingPIACurveFilter> fair;
  fair->SetInputData(ipiatest::ToLine(ipiatest::StarfishPoints(200, 0.02), true));
  fair->SetNumberOfControlPoints(80);
  fair->SetFairingWeight(3e-6);
  fair->SetMaximumNumberOfIterations(10000);
  fair->SetSampleDimensions(600);
  fair->Update();
  vtkNew<vtkPolyData> vectors;
  vectors->ShallowCopy(fair->GetOutput());
  vectors->GetPointData()->SetActiveVectors("CurvatureNormal");
  vtkNew<vtkHedgeHog> comb;
  comb->SetInputData(vectors);
  comb->SetScaleFactor(-0.03);
  vtkNew<vtkVertexGlyphFilter> points;
  points->SetInputConnection(fair->GetOutputPort(2));

  ipiatest::Picture picture;
  picture.Add(comb->GetOutputPort(), 0.5, 0.7, 1)->GetProperty()->LightingOff();
  vtkProperty* dots = picture.Add(points->GetOutputPort(), 0.5, 0.5, 0.5)->GetProperty();
  dots->SetPointSize(4);
  dots->LightingOff();
  vtkProperty* line = picture.Add(fair->GetOutputPort(), 0.8, 0, 0)->GetProperty();
  line->SetLineWidth(2);
  line->LightingOff();
  picture.LookFrom(0, 0, 1, 0, 1, 0);
  picture.Renderer->GetActiveCamera()->Zoom(1.3);
  return picture.Compare(argc, argv);
}
