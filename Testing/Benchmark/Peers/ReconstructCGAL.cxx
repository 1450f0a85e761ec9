// SPDX-License-Identifier: BSD-3-Clause
// A cloud in, a surface out, by CGAL's poisson_surface_reconstruction_delaunay.
//
//   ReconstructCGAL points.ply surface.ply [cells]
//
// The criteria of the surface mesher are the function's defaults, or, where a number of cells along
// the longest side is given, triangles of the size of a cell, a tenth of it away from the function.
#include "Job.h"
#include "StageClock.h"

#include <CGAL/Bbox_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/read_points.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/poisson_surface_reconstruction.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using OrientedPoint = std::pair<Kernel::Point_3, Kernel::Vector_3>;
using PositionMap = CGAL::First_of_pair_property_map<OrientedPoint>;
using NormalMap = CGAL::Second_of_pair_property_map<OrientedPoint>;

double longestSide(const std::vector<OrientedPoint>& cloud)
{
  CGAL::Bbox_3 box;
  for (const OrientedPoint& point : cloud)
  {
    box += point.first.bbox();
  }
  return std::max({ box.x_span(), box.y_span(), box.z_span() });
}

void reconstruct(const std::vector<std::string>& arguments)
{
  benchmarks::StageClock clock;
  std::vector<OrientedPoint> cloud;
  if (!CGAL::IO::read_points(arguments[0], std::back_inserter(cloud),
        CGAL::parameters::point_map(PositionMap()).normal_map(NormalMap())))
  {
    throw std::runtime_error(arguments[0] + " cannot be read");
  }
  clock.Finish("read");

  // The number of neighbours and the criteria, in spacings, that CGAL's manual gives.
  const double spacing = CGAL::compute_average_spacing<CGAL::Sequential_tag>(
    cloud, 6, CGAL::parameters::point_map(PositionMap()));
  const double angle = 20;
  double radius = 30, distance = 0.375;
  if (arguments.size() > 2)
  {
    radius = longestSide(cloud) / std::stod(arguments[2]) / spacing;
    distance = 0.1 * radius;
  }
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  if (!CGAL::poisson_surface_reconstruction_delaunay(cloud.begin(), cloud.end(), PositionMap(),
        NormalMap(), surface, spacing, angle, radius, distance))
  {
    throw std::runtime_error("no surface was found");
  }
  clock.Finish("fit and contour");

  std::ofstream file(arguments[1], std::ios::binary);
  CGAL::IO::set_binary_mode(file);
  if (!CGAL::IO::write_PLY(file, surface))
  {
    throw std::runtime_error(arguments[1] + " cannot be written");
  }
  clock.Finish("write");
  clock.Print();
}
}

int main(int argc, char* argv[])
{
  return benchmarks::RunJob(argc, argv, 2, "points.ply surface.ply [cells]", reconstruct);
}
