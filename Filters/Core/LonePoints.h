// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points that hardly have neighbours, which say nothing about the spacing of the others.
 */
#ifndef ipia_LonePoints_h
#define ipia_LonePoints_h

#include "AutomaticLattice.h"

namespace ipia
{
/**
 * The points that have neighbours: around which 3^Dim cubes of two spacings (squares of six) hold
 * more than a ninth of what they do where points are spaced as they are on average. All points if
 * hardly any would go, or so many that they are not the exception.
 *
 * @param positions  Dim x n, inside the box
 * @param spacing    see pointSpacing()
 */
template <int Dim>
Points<Dim> withoutLonePoints(const Points<Dim>& positions, const Box<Dim>& box, double spacing);

/// pointSpacing() of the points that have neighbours. Outliers, each in a cube of its own, would
/// otherwise make it larger.
template <int Dim>
double robustPointSpacing(const Points<Dim>& positions, const Box<Dim>& box, int threads);
}

#endif
