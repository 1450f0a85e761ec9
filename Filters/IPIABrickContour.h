// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The zero set of a hierarchy, extracted block by block; no image of f is ever held.
 */
#ifndef IPIABrickContour_h
#define IPIABrickContour_h

#include "Core/BrickSpline.h"
#include "IPIAControlLattice.h"

#include <vector>

class vtkPolyData;

namespace ipia
{
/// One step of Newton's method towards f = 0 along the gradient, no longer than a third of the
/// shortest sample spacing; not taken where f is flat.
struct NewtonStep
{
  double Longest;

  explicit NewtonStep(const double sampleSpacing[3]);

  /// The displacement along the unit gradient; 0 where the slope is too small.
  double along(double f, double slope) const;
};

/**
 * Triangles of f = 0 that face towards f > 0, from samples at half knot spacings, with vertices
 * after one Newton step and normals along the gradient. Blocks are shared among threads; the result
 * does not depend on their number.
 *
 * @param pointType   VTK_FLOAT or VTK_DOUBLE
 * @param component  of each vertex is returned here
 * @return false if the callback aborted; the surface is then empty
 */
bool contourBricks(const BrickSpline<3>& function, const Placement<3>& place, int pointType,
  const ProgressCallback& progress, vtkPolyData* surface, std::vector<vtkIdType>& component);
}

#endif
