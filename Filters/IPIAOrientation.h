// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a fit says about the orientation of the normals, for warnings.
 */
#ifndef IPIAOrientation_h
#define IPIAOrientation_h

#include "IPIAFitProblem.h"
#include "IPIAPlacedSpline.h"

#include <string>

namespace ipia
{
/**
 * A warning about normals that are flipped, one by one or all of them; empty if there is no reason.
 *
 * @param flipped  share of the normals that contradict their neighbours and f
 */
std::string orientationWarning(
  const FitProblem& problem, const PlacedSpline& function, double flipped);
}

#endif
