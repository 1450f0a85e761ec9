// SPDX-License-Identifier: BSD-3-Clause
/**
 * The Stanford bunny at 70^3.
 */
#include "IPIATestRendering.h"
#include "IPIATestScans.h"
#include "IPIATestUtilities.h"

#include "vtkFlyingEdges3D.h"

int TestImplicitFitterBunnyImage(int argc, char* argv[])
{
  auto fitter =
    ipiatest::NewClassicFitter(ipiatest::ReadScan(ipiatest::ScanFolder(argc, argv), "bunny00"), 70);
  fitter->SetMaximumNumberOfIterations(100);
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputConnection(fitter->GetOutputPort());
  surface->SetValue(0, 0.0);

  ipiatest::Picture picture;
  picture.Add(surface->GetOutputPort(), 0.8, 0.75, 0.65);
  picture.LookFrom(0, 0, 1, 0, 1, 0);
  picture.Renderer->GetActiveCamera()->Zoom(1.4);
  return picture.Compare(argc, argv);
}
