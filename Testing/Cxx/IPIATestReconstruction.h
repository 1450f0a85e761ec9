// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the tests of the surface reconstruction share.
 */
#ifndef IPIATestReconstruction_h
#define IPIATestReconstruction_h

#include "IPIATestUtilities.h"

#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkMath.h"

namespace ipiatest
{
/**
 * Every vertex lies on f = 0, and its normal is the direction of the gradient there.
 *
 * @param largestValue        of |f|, in knot spacings
 * @param largestNormalError  length of the difference of unit vectors
 */
inline void CheckVertices(Checks& checks, vtkIPIASurfaceReconstruction* reconstruction,
  double largestValue, double largestNormalError, const std::string& what)
{
  vtkPolyData* surface = reconstruction->GetOutput();
  vtkDataArray* normals = surface->GetPointData()->GetNormals();
  if (!checks.That(normals && normals->GetNumberOfTuples() == surface->GetNumberOfPoints(),
        what + ": a normal for every vertex"))
  {
    return;
  }
  double value = 0, difference = 0;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double x[3], g[3];
    surface->GetPoint(i, x);
    const double f =
      reconstruction->GetFitter()->GetImplicitFunction()->EvaluateFunctionAndGradient(x, g);
    vtkMath::Normalize(g);
    value = std::max(value, std::abs(f));
    difference =
      std::max(difference, std::sqrt(vtkMath::Distance2BetweenPoints(g, normals->GetTuple3(i))));
  }
  checks.AtMost(value / KnotSpacing(reconstruction->GetFitter()), largestValue,
    what + ": |f| at the vertices, in knot spacings");
  checks.AtMost(difference, largestNormalError, what + ": normals from the gradient");
}
}

#endif
