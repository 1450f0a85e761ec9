// SPDX-License-Identifier: BSD-3-Clause
// How far a surface is from the true one, and what it is made of, as one line of JSON.
//
//   EvaluateSurface surface.ply truth.ply
//
// Distances are exact, from random points of one surface to the nearest point of the other, in % of
// the diagonal of the true surface's bounding box. chamfer: the mean of both directions' means.
// hausdorff: the larger of both directions' maxima, over these points and as many vertices.
// normals: the mean of |n . n'| over both directions. Coincident points are merged first.
#include "IPIATestTopology.h"
#include "Job.h"
#include "PolyDataFiles.h"
#include "SurfaceSamples.h"

#include "vtkCleanPolyData.h"
#include "vtkGenericCell.h"
#include "vtkSMPThreadLocalObject.h"
#include "vtkSMPTools.h"
#include "vtkStaticCellLocator.h"
#include "vtkTriangleFilter.h"

#include <cstdint>
#include <iostream>
#include <numeric>

namespace
{
using benchmarks::SurfaceSample;
using benchmarks::Vector3;

constexpr std::size_t NumberOfSamples = 100000;

/// The triangles with three different corners.
vtkSmartPointer<vtkPolyData> cleaned(vtkPolyData* surface)
{
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(surface);
  triangles->PassLinesOff();
  triangles->PassVertsOff();
  // Triangles that collapse become lines, which the second round leaves out.
  vtkSmartPointer<vtkPolyData> result;
  triangles->Update();
  result = triangles->GetOutput();
  for (int round = 0; round < 2; ++round)
  {
    vtkNew<vtkPolyData> polygons;
    polygons->SetPoints(result->GetPoints());
    polygons->SetPolys(result->GetPolys());
    vtkNew<vtkCleanPolyData> clean;
    clean->SetInputData(polygons);
    clean->ToleranceIsAbsoluteOn();
    clean->SetAbsoluteTolerance(0);
    clean->Update();
    result = clean->GetOutput();
  }
  return result;
}

struct Distances
{
  double Mean = 0, Maximum = 0, NormalConsistency = 0;
};

/// From samples to the nearest points of a surface.
Distances distances(const std::vector<SurfaceSample>& samples, vtkPolyData* surface)
{
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(surface);
  locator->BuildLocator();
  std::vector<double> distance(samples.size()), consistency(samples.size());
  vtkSMPThreadLocalObject<vtkGenericCell> cells;
  vtkSMPTools::For(0, static_cast<vtkIdType>(samples.size()),
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType i = begin; i < end; ++i)
      {
        const auto k = static_cast<std::size_t>(i);
        double closest[3], squared = 0;
        vtkIdType triangle = -1;
        int part = 0;
        locator->FindClosestPoint(
          samples[k].Position.data(), closest, cells.Local(), triangle, part, squared);
        const Vector3 normal = benchmarks::NormalOf(benchmarks::CornersOf(surface, triangle));
        distance[k] = std::sqrt(std::max(squared, 0.0));
        consistency[k] = std::abs(vtkMath::Dot(samples[k].Normal.data(), normal.data()));
      }
    });
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  return { mean(distance), *std::max_element(distance.begin(), distance.end()), mean(consistency) };
}

/// No more vertices than samples, even in number.
std::vector<SurfaceSample> vertices(vtkPolyData* surface)
{
  const auto count = static_cast<std::size_t>(surface->GetNumberOfPoints());
  std::vector<SurfaceSample> samples(std::min(count, NumberOfSamples));
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    surface->GetPoint(
      static_cast<vtkIdType>(k * count / samples.size()), samples[k].Position.data());
  }
  return samples;
}

void evaluate(const std::vector<std::string>& arguments)
{
  auto surface = cleaned(benchmarks::ReadPolyData(arguments[0]));
  auto truth = cleaned(benchmarks::ReadPolyData(arguments[1]));
  std::mt19937_64 engine(1);
  const auto toTruth =
    distances(benchmarks::SampleSurface(surface, NumberOfSamples, engine), truth);
  const auto fromTruth =
    distances(benchmarks::SampleSurface(truth, NumberOfSamples, engine), surface);
  const auto ofVertices = distances(vertices(surface), truth);
  const auto ofTrueVertices = distances(vertices(truth), surface);
  const double percent = 100 / truth->GetLength();
  const ipiatest::Topology topology = ipiatest::TopologyOf(surface);
  std::cout << "{\"chamfer\": " << percent * (toTruth.Mean + fromTruth.Mean) / 2
            << ", \"hausdorff\": "
            << percent *
      std::max({ toTruth.Maximum, fromTruth.Maximum, ofVertices.Maximum, ofTrueVertices.Maximum })
            << ", \"normals\": " << (toTruth.NormalConsistency + fromTruth.NormalConsistency) / 2
            << ", \"components\": " << topology.Components << ", \"genus\": " << topology.Genus
            << ", \"boundary_edges\": " << topology.BoundaryEdges
            << ", \"nonmanifold_edges\": " << topology.NonManifoldEdges
            << ", \"triangles\": " << surface->GetNumberOfPolys() << "}" << std::endl;
}
}

int main(int argc, char* argv[])
{
  return benchmarks::RunJob(argc, argv, 2, "surface.ply truth.ply", evaluate);
}
