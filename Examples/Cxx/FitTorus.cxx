// SPDX-License-Identifier: BSD-3-Clause
// Oriented points on a torus -> surface; Examples/Python/FitTorus.py is the same program in Python.
//
//   FitTorus [surface.vtp]
#include "vtkIPIAImplicitFitter.h"
#include "vtkIPIASurfaceReconstruction.h"

#include "vtkFloatArray.h"
#include "vtkMassProperties.h"
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
constexpr double RingRadius = 1.0, TubeRadius = 0.4;

/// Points on a torus around the z axis, with their outward normals.
void makeTorus(vtkPolyData* torus)
{
  constexpr int around = 120, across = 48;
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  for (int i = 0; i < around; ++i)
  {
    for (int j = 0; j < across; ++j)
    {
      const double u = 2 * vtkMath::Pi() * i / around;
      const double v = 2 * vtkMath::Pi() * j / across;
      const double normal[3] = { std::cos(u) * std::cos(v), std::sin(u) * std::cos(v),
        std::sin(v) };
      points->InsertNextPoint(RingRadius * std::cos(u) + TubeRadius * normal[0],
        RingRadius * std::sin(u) + TubeRadius * normal[1], TubeRadius * normal[2]);
      normals->InsertNextTuple(normal);
    }
  }
  torus->SetPoints(points);
  torus->GetPointData()->SetNormals(normals);
}
}

int main(int argc, char* argv[])
{
  vtkNew<vtkPolyData> torus;
  makeTorus(torus);

  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(torus);
  vtkNew<vtkMassProperties> size;
  size->SetInputConnection(reconstruction->GetOutputPort());
  size->Update();

  vtkIPIAImplicitFitter* fitter = reconstruction->GetFitter();
  const int* lattice = fitter->GetGridSizeUsed();
  const double exact = 2 * std::pow(vtkMath::Pi() * TubeRadius, 2) * RingRadius;
  std::cout << torus->GetNumberOfPoints() << " points, " << lattice[0] << " x " << lattice[1]
            << " x " << lattice[2] << " coefficients\n"
            << "max |f| at the points: " << fitter->GetMaximumError() << "\n"
            << "volume: " << size->GetVolume() << " (exact: " << exact << ")\n";

  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(reconstruction->GetOutputPort());
  writer->SetFileName(argc > 1 ? argv[1] : "torus.vtp");
  const bool close = std::abs(size->GetVolume() - exact) < 0.001 * exact;
  return writer->Write() && close ? EXIT_SUCCESS : EXIT_FAILURE;
}
