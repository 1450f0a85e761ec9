// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What both filters for ParaView have in common: the domain as a tick box and a box, and the warning
 * of a parallel server.
 */
#ifndef IPIAPanel_h
#define IPIAPanel_h

#include "vtkDataSetAttributes.h"
#include "vtkIndent.h"
#include "vtkMath.h"

#include <algorithm>
#include <array>
#include <ostream>
#include <string>

namespace ipia
{
/// ModelBounds of a box; invalid ones, which mean those of the points, if these are to be used. A
/// negative length is as one of 0, an empty domain, which is refused: bounds the wrong way round
/// would be taken for none.
inline std::array<double, 6> boundsOfBox(
  bool usePointBounds, const double origin[3], const double length[3])
{
  std::array<double, 6> bounds;
  vtkMath::UninitializeBounds(bounds.data());
  for (std::size_t axis = 0; axis < 3 && !usePointBounds; ++axis)
  {
    bounds[2 * axis] = origin[axis];
    bounds[2 * axis + 1] = origin[axis] + std::max(length[axis], 0.0);
  }
  return bounds;
}

/// The attribute that an array to process is if ParaView has chosen none, which it tells by the index
/// in place of a name; -1 if a name was chosen, or for an index without such a default.
inline int attributeUnlessNamed(int index, const char* name)
{
  constexpr int normals = 0, extraValues = 2;
  if (!name || std::to_string(index) != name)
  {
    return -1;
  }
  return index == normals  ? vtkDataSetAttributes::NORMALS
    : index == extraValues ? vtkDataSetAttributes::SCALARS
                           : -1;
}

inline void printBox(std::ostream& os, vtkIndent indent, bool usePointBounds,
  const double origin[3], const double length[3])
{
  const auto print = [&](const char* name, const double* x)
  { os << indent << name << ": (" << x[0] << ", " << x[1] << ", " << x[2] << ")\n"; };
  os << indent << "UsePointBounds: " << usePointBounds << "\n";
  print("ModelBoundsOrigin", origin);
  print("ModelBoundsLength", length);
}

inline std::string gatheredWarning(int ranksWithPoints, int ranks)
{
  return "The points of " + std::to_string(ranksWithPoints) + " ranks are fitted on the first of " +
    std::to_string(ranks) +
    ", which has all of the output: the result is that of a single rank and takes its memory and "
    "time.";
}
}

#endif
