// SPDX-License-Identifier: BSD-3-Clause
/**
 * A mask from behind: its border (red) follows the points (black), its eyes are filled, and nothing
 * closes it at the back.
 */
#include "IPIATestRendering.h"
#include "IPIATestShapes.h"

#include "vtkFeatureEdges.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkVertexGlyphFilter.h"

int TestSurfaceReconstructionOpenImage(int argc, char* argv[])
{
  auto cloud = ipiatest::ToPolyData(ipiatest::MaskPoints(2500, true));
  vtkNew<vtkIPIASurfaceReconstruction> surface;
  surface->SetInputData(cloud);
  vtkNew<vtkFeatureEdges> border;
  border->SetInputConnection(surface->GetOutputPort());
  border->FeatureEdgesOff();
  border->NonManifoldEdgesOff();
  border->ManifoldEdgesOff();
  border->ColoringOff();
  vtkNew<vtkVertexGlyphFilter> points;
  points->SetInputData(cloud);

  ipiatest::Picture picture;
  vtkActor* mask = picture.Add(surface->GetOutputPort(), 0.4, 0.6, 0.9);
  vtkNew<vtkProperty> inside;
  inside->SetColor(0.9, 0.7, 0.2);
  mask->SetBackfaceProperty(inside);
  vtkProperty* line = picture.Add(border->GetOutputPort(), 0.9, 0, 0)->GetProperty();
  line->SetLineWidth(3);
  line->LightingOff();
  picture.Add(points->GetOutputPort(), 0, 0, 0)->GetProperty()->SetPointSize(2);
  picture.LookFrom(0.3, -0.7, -1.2, 0, 1, 0);
  picture.Renderer->GetActiveCamera()->Zoom(1.3);
  return picture.Compare(argc, argv);
}
