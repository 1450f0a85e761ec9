// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Connected components of a surface or curve, and which of them data speak for.
 */
#ifndef IPIAComponents_h
#define IPIAComponents_h

#include "IPIAPointCloud.h"

#include "vtkType.h"

#include <vector>

class vtkPolyData;

namespace ipia
{
/// Sets of points that are united one pair after the other.
class DisjointSets
{
public:
  explicit DisjointSets(vtkIdType size = 0);

  /// A new point, a set by itself.
  void add() { this->Parent.push_back(static_cast<vtkIdType>(this->Parent.size())); }
  void unite(vtkIdType a, vtkIdType b);

  /// The set of each point, numbered from 0 in the order of their first points.
  std::vector<vtkIdType> labels();

private:
  vtkIdType root(vtkIdType a);

  std::vector<vtkIdType> Parent;
};

/// The component of each point, by the cells.
std::vector<vtkIdType> componentsOf(vtkPolyData* surface);

/**
 * Leaves out components that hardly any data point is nearest to: fewer than 24 (than a hundredth
 * of all, if that is less), or fewer than a fiftieth of what their share of the vertices would make
 * one expect. The largest stays. Points that no cell uses are left out with them.
 *
 * @param component  of each point of the surface
 * @param reach      data farther than this from a component are not its data
 * @return the number of components that were left out
 */
int leaveOutComponents(vtkPolyData* surface, const std::vector<vtkIdType>& component,
  const SpacePoints& data, double reach);
}

#endif
