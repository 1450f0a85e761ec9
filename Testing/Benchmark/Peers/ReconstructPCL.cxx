// SPDX-License-Identifier: BSD-3-Clause
// A cloud in, a surface out, by PCL's Poisson reconstruction with its defaults, but for the depth
// of the octree and, where it is given, the weight of the points (0: unscreened, for noisy points).
//
//   ReconstructPCL points.ply surface.ply depth [weight]
#include "Job.h"
#include "StageClock.h"

#include <pcl/PolygonMesh.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>

#include <stdexcept>

namespace
{
void reconstruct(const std::vector<std::string>& arguments)
{
  benchmarks::StageClock clock;
  const pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
  if (pcl::io::loadPLYFile(arguments[0], *cloud) < 0)
  {
    throw std::runtime_error(arguments[0] + " cannot be read");
  }
  clock.Finish("read");
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth(std::stoi(arguments[2]));
  if (arguments.size() > 3)
  {
    poisson.setPointWeight(std::stof(arguments[3]));
  }
  poisson.setInputCloud(cloud);
  pcl::PolygonMesh surface;
  poisson.reconstruct(surface);
  clock.Finish("fit and contour");
  if (pcl::io::savePLYFileBinary(arguments[1], surface) < 0)
  {
    throw std::runtime_error(arguments[1] + " cannot be written");
  }
  clock.Finish("write");
  clock.Print();
}
}

int main(int argc, char* argv[])
{
  return benchmarks::RunJob(argc, argv, 3, "points.ply surface.ply depth [weight]", reconstruct);
}
