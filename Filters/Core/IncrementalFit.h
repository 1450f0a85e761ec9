// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Hierarchical fits of data that grow: points are added to the last fit, without starting again.
 *
 * Level by level, coarse to fine, the last fit's coefficients c and their change so far give the
 * start. With R the knot refinement, c' the coefficients after the addition and d = c' - c of the
 * coarser level,
 *
 *   c' = c + R d,   then c'_i, i in S, by conjugate gradients with the rows that touch S.
 *
 * S are the coefficients around the cells of new points, as the band of a level is made of all
 * points, but for points that the last fit was right about in band and normal, and those of the
 * band that R d moves by more than MovedInSpacings; the other ones of the band keep the value c,
 * and outside it the coefficients follow the coarser level, as ever. Dense levels, which decide the
 * sign of f far from the data, see clusters only and are solved everywhere; what changes there by
 * less than KeptInSpacings is left as it was.
 */
#ifndef ipia_IncrementalFit_h
#define ipia_IncrementalFit_h

#include "HierarchicalFit.h"

#include <memory>
#include <vector>

namespace ipia
{
/// Fits, and remembers what an addition needs: the input, the levels' data and all coefficients.
template <int Dim>
class IncrementalFit
{
public:
  /// A coefficient of a band is solved for if the coarser level moves it by so many knot spacings.
  static constexpr double MovedInSpacings = 0.05;
  /// Changes of a dense level by no more than so many of its knot spacings are not made.
  static constexpr double KeptInSpacings = 0.01;
  /// New points that f misses by no more than so many of the finest knot spacings, and their
  /// normals that its gradient misses by no more than this, are not news.
  static constexpr double KnownInSpacings = 0.02, KnownSlope = 0.1;

  /**
   * As fitHierarchical(), or the last fit with points added: if lattice and options are those of
   * the last fit, the input begins with its points, bit for bit, and has the same extra rows. The
   * smoothing length stays that of the last fit; all is fitted again if clean data are joined by
   * points that are noisy, the points have doubled since a length was found, or there are faults
   * among the added ones.
   */
  HierarchicalResult<Dim> fit(const Lattice<Dim>& lattice, HermiteInput<Dim> input,
    const HierarchicalOptions& options, const ProgressCallback& progress = {});

private:
  bool canAdd(const Lattice<Dim>& lattice, const HermiteInput<Dim>& input,
    const HierarchicalOptions& options) const;
  bool add(
    HermiteInput<Dim> added, const ProgressCallback& progress, HierarchicalResult<Dim>& result);
  Misses missesOfAll(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
    const Samples<Dim>& added, int threads) const;

  Lattice<Dim> Grid;
  HierarchicalOptions Options;
  HermiteInput<Dim> Input;
  std::vector<Level<Dim>> Levels; ///< without their data
  /// Those in Morton order, of each level; and all points: a run of the last fit of all, and one of
  /// each addition since, so that an addition need not touch the others.
  std::vector<std::vector<Samples<Dim>>> Data;
  std::vector<Samples<Dim>> Points;
  Samples<Dim> Outliers;           ///< that the last fit of all left out
  HierarchicalResult<Dim> Last;    ///< its Function is nullptr if there is none
  std::int64_t PointsOfLength = 0; ///< number of points that the smoothing length was found with
};
}

#endif
