// SPDX-License-Identifier: BSD-3-Clause
/**
 * A noisy height field, faired on one half only, in the colours of its mean curvature, with the
 * control net.
 */
#include "IPIATestFairing.h"
#include "IPIATestRendering.h"

int TestFairingPIASurfaceImage(int argc, char* argv[])
{
  auto grid = ipiatest::WavyGrid(60, 60, 0.004);
  ipiatest::AddArray(grid, "w", [](vtkIdType k) { return k % 60 < 30 ? 1e-9 : 1e-4; });
  vtkNew<vtkFairingPIASurfaceFilter> fair;
  fair->SetInputData(grid);
  ipiatest::Choose(fair, 0, 0, "w");
  fair->SetSolverToBiconjugateGradient();
  fair->SetSampleDimensions(150, 150);
  fair->Update();

  ipiatest::Picture picture;
  auto* surface = picture.Add(fair->GetOutputPort(), 1, 1, 1);
  surface->GetMapper()->ScalarVisibilityOn();
  surface->GetMapper()->SetScalarModeToUsePointFieldData();
  surface->GetMapper()->SelectColorArray("MeanCurvature");
  surface->GetMapper()->SetScalarRange(-4, 4);
  vtkProperty* net = picture.Add(fair->GetOutputPort(1), 0.2, 0.2, 0.2)->GetProperty();
  net->SetLineWidth(1);
  net->LightingOff();
  picture.LookFrom(0.3, -1, 1.2, 0, 0, 1);
  return picture.Compare(argc, argv);
}
