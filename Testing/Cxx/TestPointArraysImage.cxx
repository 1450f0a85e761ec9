// SPDX-License-Identifier: BSD-3-Clause
/**
 * Colours of noisy points on the surface that goes through them.
 */
#include "IPIATestRendering.h"
#include "IPIATestShapes.h"

#include "vtkIPIASurfaceReconstruction.h"

#include "vtkUnsignedCharArray.h"

#include <cmath>

int TestPointArraysImage(int argc, char* argv[])
{
  auto cloud = ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Torus(1, 0.4), 8000));
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetName("RGB");
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(cloud->GetNumberOfPoints());
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(1);
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    double x[3];
    cloud->GetPoint(i, x);
    const double around = std::atan2(x[1], x[0]), ring = std::hypot(x[0], x[1]) - 1;
    const double across = std::atan2(x[2], ring);
    for (int c = 0; c < 3; ++c)
    {
      random->Next();
      const double v =
        127.5 + 90 * std::sin(6 * around + 2 * across + 2.1 * c) + random->GetRangeValue(-35, 35);
      colours->SetComponent(i, c, std::round(v));
    }
  }
  cloud->GetPointData()->SetScalars(colours);
  vtkNew<vtkIPIASurfaceReconstruction> surface;
  surface->SetInputData(cloud);

  ipiatest::Picture picture;
  vtkActor* actor = picture.Add(surface->GetOutputPort(), 1, 1, 1);
  actor->GetMapper()->ScalarVisibilityOn();
  picture.LookFrom(0, -1, 1.4, 0, 0, 1);
  return picture.Compare(argc, argv);
}
