// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAOrientation.h"

#include "IPIAText.h"

#include <cmath>

namespace ipia
{
namespace
{
/// Thin parts and noise make a few sound normals look flipped, but no more than this share.
constexpr double SignificantShare = 0.01;
/// f is sampled at so many places along each axis of the border; the surface is inside out if it is
/// negative at nearly all of them.
constexpr int PlacesPerAxis = 9;
constexpr double NearlyAll = 0.99;

/// The share of the border of the domain where f is negative.
double negativeBorder(const FitProblem& problem, const PlacedSpline& function)
{
  int places[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    places[axis] = axis == problem.FlatAxis ? 1 : PlacesPerAxis;
  }
  double negative = 0, all = 0;
  for (int k = 0; k < places[2]; ++k)
  {
    for (int j = 0; j < places[1]; ++j)
    {
      for (int i = 0; i < places[0]; ++i)
      {
        const int at[3] = { i, j, k };
        bool border = false;
        double x[3];
        for (int axis = 0; axis < 3; ++axis)
        {
          const bool flat = axis == problem.FlatAxis;
          border = border || (!flat && (at[axis] == 0 || at[axis] == PlacesPerAxis - 1));
          const double share = flat ? 0. : at[axis] / (PlacesPerAxis - 1.);
          x[axis] = problem.Origin[axis] + share * (problem.Upper[axis] - problem.Origin[axis]);
        }
        if (border)
        {
          negative += function.Value(x) < 0;
          ++all;
        }
      }
    }
  }
  return negative / all;
}
}

std::string orientationWarning(
  const FitProblem& problem, const PlacedSpline& function, double flipped)
{
  std::string warning;
  if (flipped >= SignificantShare)
  {
    warning = text(std::round(1000 * flipped) / 10,
      " % of the normals point against those around them and against the surface, which was fitted "
      "without them. NormalAgreement of output 1 is negative there. Orient the normals "
      "consistently, for instance with vtkPCANormalEstimation.");
  }
  // Where points were left out, the domain may lie within what they enclose.
  if (problem.OutsideBounds == 0 && negativeBorder(problem, function) >= NearlyAll)
  {
    warning += text(warning.empty() ? "" : " ",
      "f is negative all along the border of the domain: the normals point into the surface, and "
      "inside and outside are exchanged. This is right for a scan from within, such as of a room; "
      "otherwise turn the normals, for instance with vtkReverseSense.");
  }
  return warning;
}
}
