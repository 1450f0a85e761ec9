// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Small rigid motions of scans that bring their surfaces together.
 *
 * Points p of several scans have distances d(p) from one common surface and normals n(p) of it. In
 * cubes c of space, apart by the direction that the surface faces, the mean distances d_ac of the
 * scans a tell how their surfaces lie apart. With the twist x_a (a rotation vector about a centre,
 * and a shift) of each scan, to first order, the motions are the least-squares solution of
 *
 *   sum_c sum_a w_ac ((d_ac + J_c x_a) - mean_c)^2 + sum_a |x_a|^2,   J_c = mean (p x n, n),
 *   mean_c = sum_b w_bc (d_bc + J_c x_b) / sum_b w_bc.
 *
 * Motions that change nothing, such as one of all scans, of a plane along itself or of scans that
 * overlap with none, are 0 in it: the mean of all twists is 0 in every group of scans that overlap,
 * the datum of free networks in surveying. Rotations count by the way they move a point at half the
 * diagonal. Weights are the numbers of points up to a limit, less for what is far from the others
 * (Geman and McClure).
 */
#ifndef ipia_ScanMotions_h
#define ipia_ScanMotions_h

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace ipia
{
/// A point of a scan, near the common surface.
struct ScanPoint
{
  Eigen::Vector3d Position;
  Eigen::Vector3d Normal; ///< of the surface, unit length
  double Distance;        ///< signed, along the normal
  int Scan;
};

struct ScanMotions
{
  /// Of each scan: the rotation vector about the centre, and the shift of the centre.
  std::vector<Eigen::Matrix<double, 6, 1>> Twists;
  double Misfit = 0;    ///< how far scans lie apart in the cubes, root of the mean square
  double Predicted = 0; ///< the same after the motions, to first order
  /// Pairs of cube and scan where there is more than one scan.
  std::int64_t Overlaps = 0;
};

/**
 * @param centre    of the rotations
 * @param radius    the way of a point for a unit of rotation, > 0
 * @param cubeSide  > 0
 */
ScanMotions findScanMotions(const std::vector<ScanPoint>& points, int numberOfScans,
  const Eigen::Vector3d& centre, double radius, double cubeSide);
}

#endif
