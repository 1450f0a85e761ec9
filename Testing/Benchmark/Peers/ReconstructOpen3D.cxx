// SPDX-License-Identifier: BSD-3-Clause
// A cloud in, a surface out, by Open3D's screened Poisson reconstruction with its defaults.
//
//   ReconstructOpen3D points.ply surface.ply depth
#include "Job.h"
#include "StageClock.h"

#include <open3d/Open3D.h>

#include <stdexcept>
#include <tuple>

namespace
{
void reconstruct(const std::vector<std::string>& arguments)
{
  benchmarks::StageClock clock;
  open3d::geometry::PointCloud cloud;
  if (!open3d::io::ReadPointCloud(arguments[0], cloud))
  {
    throw std::runtime_error(arguments[0] + " cannot be read");
  }
  clock.Finish("read");
  const auto surface = std::get<0>(
    open3d::geometry::TriangleMesh::CreateFromPointCloudPoisson(cloud, std::stoul(arguments[2])));
  clock.Finish("fit and contour");
  if (!open3d::io::WriteTriangleMesh(arguments[1], *surface))
  {
    throw std::runtime_error(arguments[1] + " cannot be written");
  }
  clock.Finish("write");
  clock.Print();
}
}

int main(int argc, char* argv[])
{
  return benchmarks::RunJob(argc, argv, 3, "points.ply surface.ply depth", reconstruct);
}
