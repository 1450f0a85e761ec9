// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Hierarchical I-PIA: the fit on lattices of halving spacing, coarse to fine.
 *
 * Each level starts from the exact knot refinement of the one before and solves the least-squares
 * problem of its rows (f = 0 and grad f = n at the points, f = v at extra rows) by conjugate
 * gradients; its limit is the solution nearest to the coarser prediction. Coarse levels are dense
 * and solved to convergence with fairing energies, so that f is defined everywhere and fills holes;
 * fine levels correct a narrow band around the data. Coarser levels see clusters of points.
 */
#ifndef ipia_HierarchicalFit_h
#define ipia_HierarchicalFit_h

#include "BrickSpline.h"
#include "HierarchyLevel.h"

#include <memory>
#include <vector>

namespace ipia
{
template <int Dim>
struct HierarchicalResult
{
  bool Aborted = false;
  std::shared_ptr<const BrickSpline<Dim>> Function; ///< nullptr if aborted
  std::vector<LevelReport> Reports;                 ///< coarse to fine
  /// Root mean square distance of the points from the zero set of the finest level that they alone
  /// determine; 0 if they are too sparse for any, or a smoothing length was given.
  double Noise = 0;
  double SmoothingLength = 0; ///< as used
  /// Share of the normals that point against the fit and their neighbours.
  double FlippedNormals = 0;
  double Outliers =
    0; ///< share of the points that were left out, far from what the others agree on
};

/// @param lattice  the finest lattice
template <int Dim>
HierarchicalResult<Dim> fitHierarchical(const Lattice<Dim>& lattice, HermiteInput<Dim> input,
  const HierarchicalOptions& options, const ProgressCallback& progress = {});
}

#endif
