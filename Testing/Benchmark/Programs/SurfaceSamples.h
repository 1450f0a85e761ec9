// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Random points of a triangulated surface, even in area.
 */
#ifndef SurfaceSamples_h
#define SurfaceSamples_h

#include "vtkCellArray.h"
#include "vtkMath.h"
#include "vtkPolyData.h"
#include "vtkTriangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace benchmarks
{
using Vector3 = std::array<double, 3>;

struct SurfaceSample
{
  Vector3 Position;
  Vector3 Normal; ///< of the triangle
};

/// The corners of a triangle of a surface.
inline std::array<Vector3, 3> CornersOf(vtkPolyData* surface, vtkIdType triangle)
{
  std::array<Vector3, 3> corners{};
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  surface->GetPolys()->GetCellAtId(triangle, size, ids);
  for (std::size_t k = 0; k < 3; ++k)
  {
    surface->GetPoint(ids[k], corners[k].data());
  }
  return corners;
}

inline Vector3 NormalOf(const std::array<Vector3, 3>& corners)
{
  Vector3 normal{};
  vtkTriangle::ComputeNormal(
    corners[0].data(), corners[1].data(), corners[2].data(), normal.data());
  return normal;
}

/// @a surface consists of triangles.
inline std::vector<SurfaceSample> SampleSurface(
  vtkPolyData* surface, std::size_t count, std::mt19937_64& engine)
{
  std::vector<double> areas;
  double total = 0;
  for (vtkIdType i = 0; i < surface->GetNumberOfPolys(); ++i)
  {
    const auto p = CornersOf(surface, i);
    total += vtkTriangle::TriangleArea(p[0].data(), p[1].data(), p[2].data());
    areas.push_back(total);
  }
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<SurfaceSample> samples(count);
  for (SurfaceSample& sample : samples)
  {
    const auto at = std::upper_bound(areas.begin(), areas.end() - 1, uniform(engine) * total);
    const auto p = CornersOf(surface, at - areas.begin());
    const double root = std::sqrt(uniform(engine)), share = uniform(engine);
    for (std::size_t a = 0; a < 3; ++a)
    {
      sample.Position[a] =
        (1 - root) * p[0][a] + root * (1 - share) * p[1][a] + root * share * p[2][a];
    }
    sample.Normal = NormalOf(p);
  }
  return samples;
}
}

#endif
