// SPDX-License-Identifier: BSD-3-Clause
// Noisy points -> fair curve, then fairer on one segment; Examples/Python/FairCurve.py is the same
// program in Python.
//
//   FairCurve [curve.vtp]
#include "vtkFairingPIACurveFilter.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkXMLPolyDataWriter.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

namespace
{
constexpr int First = 20, Last = 32; // control points of the segment

/// A closed polyline with something like noise.
void makeStarfish(vtkPolyData* starfish)
{
  constexpr int count = 200;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(count + 1);
  for (int k = 0; k < count; ++k)
  {
    const double angle = 2 * vtkMath::Pi() * k / count;
    const double radius = 1 + 0.3 * std::cos(5 * angle) + 0.01 * std::sin(1e4 * (k + 1) * (k + 1));
    lines->InsertCellPoint(
      points->InsertNextPoint(radius * std::cos(angle), radius * std::sin(angle), 0));
  }
  lines->InsertCellPoint(0);
  starfish->SetPoints(points);
  starfish->SetLines(lines);
}

void report(const char* round, vtkFairingPIACurveFilter* fair)
{
  std::cout << round << " round: fitting error " << fair->GetFittingError() << ", strain energy "
            << fair->GetFairingEnergy() << "\n";
}
}

int main(int argc, char* argv[])
{
  vtkNew<vtkPolyData> starfish;
  makeStarfish(starfish);

  // A first round: one weight for all control points.
  vtkNew<vtkFairingPIACurveFilter> fair;
  fair->SetInputData(starfish);
  fair->SetNumberOfControlPoints(80);
  fair->SetFairingWeight(1e-8);
  fair->Update();
  report("first", fair);
  const double energy = fair->GetFairingEnergy();

  // A second one from its control points: larger weights on a segment, whose control points alone
  // move.
  vtkNew<vtkPolyData> controls;
  controls->DeepCopy(fair->GetOutputDataObject(1));
  vtkDataArray* weights = controls->GetPointData()->GetArray("FairingWeight");
  vtkNew<vtkDoubleArray> movable;
  movable->SetName("Movable");
  for (vtkIdType j = 0; j < controls->GetNumberOfPoints(); ++j)
  {
    const bool inside = j >= First && j <= Last;
    movable->InsertNextValue(inside);
    if (inside)
    {
      weights->SetComponent(j, 0, 1e-5);
    }
  }
  controls->GetPointData()->AddArray(movable);
  fair->SetControlPointsData(controls);
  fair->SetInputArrayToProcess(2, 1, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Movable");
  fair->Update();
  report("second", fair);

  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(fair->GetOutputPort());
  writer->SetFileName(argc > 1 ? argv[1] : "curve.vtp");
  const bool fairer = fair->GetFairingEnergy() < 0.95 * energy && fair->GetFittingError() < 0.015;
  return writer->Write() && fairer ? EXIT_SUCCESS : EXIT_FAILURE;
}
