// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The points nearest to a position, also to one that is far from all of them.
 */
#ifndef IPIAPointTree_h
#define IPIAPointTree_h

#include "IPIAPointCloud.h"

#include "vtkType.h"

#include <array>
#include <vector>

namespace ipia
{
/**
 * A balanced k-d tree. vtkStaticPointLocator's buckets take the cube of the distance to find what
 * lies far away; here that takes the logarithm of the number of points.
 */
class PointTree
{
public:
  using Position = std::array<double, 3>;

  struct Neighbour
  {
    double Distance2;
    vtkIdType Id;

    /// Equally far points in the order of their ids, so that results depend on nothing else.
    bool operator<(const Neighbour& other) const
    {
      return this->Distance2 != other.Distance2 ? this->Distance2 < other.Distance2
                                                : this->Id < other.Id;
    }
  };

  explicit PointTree(const SpacePoints& points);

  /// The @a count nearest points, or all if there are fewer, nearest first; none farther than
  /// @a reach.
  void nearest(const Position& x, std::size_t count, std::vector<Neighbour>& found,
    double reach = VTK_DOUBLE_MAX) const;

private:
  struct Entry
  {
    Position X;
    vtkIdType Id;
  };
  /// Where the range of a node is parted; the children of node i are 2 i + 1 and 2 i + 2.
  struct Node
  {
    int Axis;
    double Split;
  };
  struct Search;

  void part(std::size_t node, std::size_t begin, std::size_t end);
  void descend(Search& search, std::size_t node, std::size_t begin, std::size_t end,
    Position offset, double distance2) const;

  std::vector<Entry> Entries;
  std::vector<Node> Nodes;
};
}

#endif
