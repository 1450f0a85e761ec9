// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Pictures for people to look at, and their comparison with the reference image.
 */
#ifndef IPIATestRendering_h
#define IPIATestRendering_h

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRegressionTestImage.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"

#include <cstdlib>

namespace ipiatest
{
/// Draws the window and compares it with the reference image. Returns what main returns.
inline int CompareWindow(vtkRenderWindow* window, int argc, char* argv[])
{
  window->Render();
  const int result = vtkRegressionTestImage(window);
  if (result == vtkRegressionTester::DO_INTERACTOR)
  {
    vtkNew<vtkRenderWindowInteractor> interactor;
    interactor->SetRenderWindow(window);
    interactor->Start();
  }
  return result == vtkRegressionTester::FAILED ? EXIT_FAILURE : EXIT_SUCCESS;
}

/// A window of 300 x 300 pixels on a white ground.
class Picture
{
public:
  Picture()
  {
    this->Window->SetSize(300, 300);
    this->Window->SetMultiSamples(0);
    this->Window->AddRenderer(this->Renderer);
    this->Renderer->SetBackground(1, 1, 1);
  }

  /// Geometry in one colour.
  vtkActor* Add(vtkAlgorithmOutput* geometry, double red, double green, double blue)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(geometry);
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(red, green, blue);
    this->Renderer->AddActor(actor);
    return actor;
  }

  void LookFrom(double x, double y, double z, double upX, double upY, double upZ)
  {
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetFocalPoint(0, 0, 0);
    camera->SetPosition(x, y, z);
    camera->SetViewUp(upX, upY, upZ);
    this->Renderer->ResetCamera();
  }

  int Compare(int argc, char* argv[]) { return CompareWindow(this->Window, argc, argv); }

  vtkNew<vtkRenderer> Renderer;

private:
  vtkNew<vtkRenderWindow> Window;
};
}

#endif
