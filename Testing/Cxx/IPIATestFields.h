// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Pictures of f as colours, several side by side, for the examples of the paper of 2024.
 */
#ifndef IPIATestFields_h
#define IPIATestFields_h

#include "IPIATestRendering.h"
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkColorTransferFunction.h"
#include "vtkFlyingEdges2D.h"
#include "vtkIPIAImplicitFunction.h"
#include "vtkImageDataGeometryFilter.h"
#include "vtkMinimalStandardRandomSequence.h"
#include "vtkSampleFunction.h"

namespace ipiatest
{
/// The settings of the paper: offsets of 0.1 on both sides with values of 0.01, on the box of the
/// points and a tenth of its longest side.
inline vtkSmartPointer<vtkIPIAImplicitFitter> NewPaperFitter(
  const OrientedPoints& points, int gridSize, double tau, int iterations)
{
  auto cloud = ToPolyData(points);
  auto fitter = NewClassicFitter(cloud, gridSize);
  double b[6];
  cloud->GetBounds(b);
  const double margin = 0.1 * std::max(b[1] - b[0], b[3] - b[2]);
  fitter->SetModelBounds(b[0] - margin, b[1] + margin, b[2] - margin, b[3] + margin, 0, 0);
  fitter->SetOffsetDistance(0.1);
  fitter->SetOffsetValue(0.01);
  fitter->SetBasisTypeToUniformRational();
  fitter->SetWeightStepSize(tau);
  fitter->SetMaximumNumberOfIterations(iterations);
  return fitter;
}

/// Tiles of 200 x 200 pixels side by side, in rows of @a columns.
class FieldPicture
{
public:
  explicit FieldPicture(int columns, int rows = 1)
    : Columns(columns)
    , Rows(rows)
  {
    this->Window->SetSize(200 * columns, 200 * rows);
    this->Window->SetMultiSamples(0);
  }

  /// f of a fit without its far field, blue inside over white to red outside, with f = 0 and the
  /// points.
  void Add(vtkIPIAImplicitFitter* fitter)
  {
    fitter->Update();
    vtkNew<vtkImageData> lattice;
    lattice->ShallowCopy(ControlLattice(fitter));
    lattice->GetFieldData()->Initialize();
    vtkNew<vtkIPIAImplicitFunction> function;
    function->SetControlLattice(lattice);
    vtkNew<vtkSampleFunction> samples;
    samples->SetImplicitFunction(function);
    samples->SetModelBounds(fitter->GetOutput()->GetBounds());
    samples->SetSampleDimensions(151, 151, 1);
    samples->ComputeNormalsOff();

    vtkNew<vtkRenderer> renderer;
    const int column = this->Added % this->Columns, row = this->Added / this->Columns;
    ++this->Added;
    renderer->SetViewport(double(column) / this->Columns, 1 - double(row + 1) / this->Rows,
      double(column + 1) / this->Columns, 1 - double(row) / this->Rows);
    renderer->SetBackground(1, 1, 1);
    this->Window->AddRenderer(renderer);
    const auto add =
      [&](vtkAlgorithmOutput* geometry, double height, double red, double green, double blue)
    {
      vtkNew<vtkPolyDataMapper> mapper;
      mapper->SetInputConnection(geometry);
      mapper->ScalarVisibilityOff();
      vtkNew<vtkActor> actor;
      actor->SetMapper(mapper);
      actor->SetPosition(0, 0, height);
      actor->GetProperty()->SetColor(red, green, blue);
      actor->GetProperty()->LightingOff();
      renderer->AddActor(actor);
      return actor;
    };
    vtkNew<vtkImageDataGeometryFilter> field;
    field->SetInputConnection(samples->GetOutputPort());
    vtkNew<vtkColorTransferFunction> colours;
    colours->SetColorSpaceToDiverging();
    colours->AddRGBPoint(-0.05, 0.23, 0.3, 0.75);
    colours->AddRGBPoint(0.05, 0.7, 0.02, 0.15);
    auto map = add(field->GetOutputPort(), 0, 1, 1, 1);
    map->GetMapper()->SetLookupTable(colours);
    map->GetMapper()->ScalarVisibilityOn();
    vtkNew<vtkFlyingEdges2D> curve;
    curve->SetInputConnection(samples->GetOutputPort());
    curve->SetValue(0, 0.0);
    add(curve->GetOutputPort(), 0.01, 0, 0, 0)->GetProperty()->SetLineWidth(2);
    add(fitter->GetOutputPort(1), 0.02, 0.1, 0.5, 0.1)->GetProperty()->SetPointSize(2);
    renderer->GetActiveCamera()->ParallelProjectionOn();
    renderer->ResetCamera();
    renderer->GetActiveCamera()->Zoom(1.35);
  }

  int Compare(int argc, char* argv[]) { return CompareWindow(this->Window, argc, argv); }

private:
  const int Columns, Rows;
  int Added = 0;
  vtkNew<vtkRenderWindow> Window;
};
}

#endif
