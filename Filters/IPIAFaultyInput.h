// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a fit says about outliers and the orientation of normals, for warnings.
 */
#ifndef IPIAFaultyInput_h
#define IPIAFaultyInput_h

#include "IPIAFitProblem.h"
#include "IPIAPlacedSpline.h"

#include <string>

namespace ipia
{
/**
 * A warning about outliers and about normals that are flipped, one by one or all of them; empty if
 * there is no reason.
 *
 * @param outliers  share of the points that were left out
 * @param flipped   share of the normals that contradict their neighbours and f
 */
std::string faultyInputWarning(
  const FitProblem& problem, const PlacedSpline& function, double outliers, double flipped);
}

#endif
