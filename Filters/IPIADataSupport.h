// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How far positions are from the data, in units of how far the data are from each other there.
 */
#ifndef IPIADataSupport_h
#define IPIADataSupport_h

#include "IPIAPointTree.h"

namespace ipia
{
/**
 * Each data point p has a local spacing s(p): around it, as the normal sees it, its neighbours are
 * sorted into six sectors, and of the distances to the nearest in each the third smallest counts.
 * On a square or random pattern that is about the spacing, at a border as well as inside; where
 * points lie densely along lines, as from scanners, it is the distance of the lines. Then s is the
 * median over the nearest neighbours. In the plane there are two sides instead of sectors, and the
 * larger distance counts.
 */
class DataSupport
{
public:
  using Position = PointTree::Position;

  /**
   * @param positions  of the data, at least one
   * @param normals    of unit length, or 0
   * @param flatAxis   the axis across the plane in 2-D, or -1
   * @param least      no spacing is taken smaller than this, > 0
   */
  DataSupport(const SpacePoints& positions, const SpacePoints& normals, int flatAxis, double least);

  /// The surface goes on beyond the outermost data by this many of their spacings.
  static constexpr double Margin = 0.5;

  struct Reach
  {
    double Distance; ///< to the data in local spacings: min |x - p| / s(p) over points near x
    double Room;     ///< how far it is at least to the margin of data: min |x - p| - Margin s(p)
  };

  /// Of many positions at once, on OpenMP's threads.
  std::vector<Reach> reach(const std::vector<Position>& x);

  /// The normal of the nearest point.
  const Position& normalNear(const Position& x) const;

private:
  void provideSpacings(const std::vector<vtkIdType>& points);
  double ownSpacing(vtkIdType point, std::vector<PointTree::Neighbour>& scratch) const;

  const SpacePoints& Positions;
  const SpacePoints& Normals;
  int FlatAxis;
  double Least;
  PointTree Tree;
  // Per point, where they were needed; negative elsewhere.
  std::vector<double> Own;
  std::vector<double> Spacing;
};
}

#endif
