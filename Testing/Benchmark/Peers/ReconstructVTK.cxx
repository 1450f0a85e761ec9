// SPDX-License-Identifier: BSD-3-Clause
// A cloud in, a surface out, by the filters that VTK has.
//
//   ReconstructVTK signed-distance|surface-reconstruction points.ply surface.ply cells
//
// signed-distance: vtkSignedDistance, vtkExtractSurface, set up as in VTK's example ExtractSurface:
// a box a tenth larger on each side, a radius of four voxels, holes filled. surface-reconstruction:
// vtkSurfaceReconstructionFilter, vtkFlyingEdges3D. cells: voxels along the longest side.
#include "Job.h"
#include "PolyDataFiles.h"
#include "StageClock.h"

#include "vtkExtractSurface.h"
#include "vtkFlyingEdges3D.h"
#include "vtkImageData.h"
#include "vtkSignedDistance.h"
#include "vtkSurfaceReconstructionFilter.h"

#include <algorithm>
#include <cmath>

namespace
{
using benchmarks::StageClock;

vtkSmartPointer<vtkPolyData> bySignedDistance(vtkPolyData* cloud, int cells, StageClock& clock)
{
  double bounds[6];
  cloud->GetBounds(bounds);
  const double longest =
    std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] });
  const double margin = 0.1 * longest, voxel = (longest + 2 * margin) / (cells - 1);
  int dimensions[3];
  for (int a = 0; a < 3; ++a)
  {
    const double side = bounds[2 * a + 1] - bounds[2 * a] + 2 * margin;
    dimensions[a] = static_cast<int>(std::ceil(side / voxel)) + 1;
    bounds[2 * a] -= margin;
    bounds[2 * a + 1] = bounds[2 * a] + voxel * (dimensions[a] - 1);
  }
  vtkNew<vtkSignedDistance> distance;
  distance->SetInputData(cloud);
  distance->SetDimensions(dimensions);
  distance->SetBounds(bounds);
  distance->SetRadius(4 * voxel);
  distance->Update();
  clock.Finish("fit");
  vtkNew<vtkExtractSurface> surface;
  surface->SetInputConnection(distance->GetOutputPort());
  surface->SetRadius(0.99 * distance->GetRadius());
  surface->HoleFillingOn();
  surface->ComputeNormalsOff();
  surface->Update();
  clock.Finish("contour");
  return surface->GetOutput();
}

vtkSmartPointer<vtkPolyData> bySurfaceReconstruction(
  vtkPolyData* cloud, int cells, StageClock& clock)
{
  double bounds[6];
  cloud->GetBounds(bounds);
  vtkNew<vtkSurfaceReconstructionFilter> reconstruction;
  reconstruction->SetInputData(cloud);
  reconstruction->SetSampleSpacing(
    std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] }) / cells);
  reconstruction->Update();
  clock.Finish("fit");
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputConnection(reconstruction->GetOutputPort());
  surface->SetValue(0, 0.0);
  surface->ComputeNormalsOff();
  surface->ComputeScalarsOff();
  surface->Update();
  clock.Finish("contour");
  return surface->GetOutput();
}

void reconstruct(const std::vector<std::string>& arguments)
{
  StageClock clock;
  auto cloud = benchmarks::ReadPolyData(arguments[1]);
  clock.Finish("read");
  const int cells = std::stoi(arguments[3]);
  auto surface = arguments[0] == "signed-distance" ? bySignedDistance(cloud, cells, clock)
                                                   : bySurfaceReconstruction(cloud, cells, clock);
  benchmarks::WriteSurface(surface, arguments[2]);
  clock.Finish("write");
  clock.Print();
}
}

int main(int argc, char* argv[])
{
  return benchmarks::RunJob(argc, argv, 4,
    "signed-distance|surface-reconstruction points.ply surface.ply cells", reconstruct);
}
