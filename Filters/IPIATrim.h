// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Where a surface or curve goes on beyond its data, and cutting it there.
 *
 * A vertex is unsupported if it is farther from the data than some local spacings (DataSupport). An
 * unsupported part is a hole and stays, or it is cut off: if it reaches a side of the domain, or is
 * large. The cut does not run where support ends but back towards the data, as far as it can
 * without coming nearer to any than half a spacing: a closing of the data on the surface, whose
 * line follows their outer border and no gap among them.
 */
#ifndef IPIATrim_h
#define IPIATrim_h

#include "vtkType.h"

#include <array>
#include <vector>

class vtkPolyData;

namespace ipia
{
class PointCloud;

struct TrimOptions
{
  double Distance; ///< what is farther from the data is unsupported, in their local spacings, >= 1
  /// The same on the sides of the domain: less where the domain is known to be wider than the data,
  /// so that a narrow seam is cut off, too.
  double DistanceOnSide;
  double HoleSize; ///< unsupported parts up to this share of the supported area (length) are holes
  std::array<double, 6> Domain;
  std::array<int, 3> Cells;            ///< knot cells per axis, 0 across the plane in 2-D
  std::array<double, 3> SampleSpacing; ///< of the vertices, 0 across the plane
};

struct TrimResult
{
  int Parts = 0;                    ///< that were cut off
  std::vector<vtkIdType> NewPoints; ///< on the cut; their attributes are interpolated
};

/// The surface is changed only if a part is cut off; then points that no cell uses are left out.
/// Polylines are cut alike.
TrimResult trimUnsupported(
  vtkPolyData* surface, const PointCloud& data, const TrimOptions& options);
}

#endif
