// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Cutting a surface or curve along the zero line of a function on its vertices.
 */
#ifndef IPIAClip_h
#define IPIAClip_h

#include "vtkType.h"

#include <vector>

class vtkPolyData;

namespace ipia
{
/**
 * Keeps what is not below 0 of a surface of triangles or a curve of polylines. A cut that would
 * almost pass through a vertex goes through it, so that no sliver is left.
 *
 * @param level  of each vertex; linear in between
 * @return the points on the cut that are new; their attributes are interpolated
 */
std::vector<vtkIdType> clipBelowZero(vtkPolyData* surface, std::vector<double> level);
}

#endif
