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
 * Outliers and flipped normals are judged by the finest level that the points alone determine.
 */
#ifndef ipia_HierarchicalFit_h
#define ipia_HierarchicalFit_h

#include "BrickSpline.h"
#include "HierarchyLevel.h"
#include "SampleJudge.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

namespace ipia
{
/// How far the points miss the zero set.
struct Misses
{
  double Distances = 0; ///< squares, of those with normals
  double Oriented = 0;  ///< number of these
  double Values = 0;    ///< squares of f, but for extra rows
  double Points = 0;    ///< number of these
  double Largest = 0;   ///< |f| of these

  Misses& operator+=(const Misses& other)
  {
    this->Distances += other.Distances;
    this->Oriented += other.Oriented;
    this->Values += other.Values;
    this->Points += other.Points;
    this->Largest = std::max(this->Largest, other.Largest);
    return *this;
  }

  /// The root mean square distance.
  double noise() const
  {
    return this->Oriented > 0 ? std::sqrt(this->Distances / this->Oriented) : 0;
  }
};

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
  /// Levels, from the coarsest, that the points alone determine.
  std::size_t DeterminedLevels = 0;
  SampleFaultCounts Faults;           ///< that the fit is without
  std::vector<std::int64_t> Outliers; ///< points that were left out, ascending
  /// Points that were added to an earlier fit; 0 if this is a fit of its own.
  std::int64_t NumberOfPointsAdded = 0;

  /// Coefficients that were solved for, on all levels.
  std::int64_t numberOfCoefficientsSolved() const
  {
    std::int64_t n = 0;
    for (const LevelReport& report : this->Reports)
    {
      n += report.NumberOfActiveCoefficients;
    }
    return n;
  }

  void reportErrors(const Misses& misses)
  {
    this->Reports.back().AverageError = misses.Points > 0 ? misses.Values / misses.Points : 0;
    this->Reports.back().MaximumError = misses.Largest;
  }
};

/// What an addition to a fit needs of it.
template <int Dim>
struct FittedData
{
  std::vector<Level<Dim>> Levels;
  Samples<Dim> Outliers; ///< that were left out
};

/// By a level that covers the points.
///
/// @param checks  if given, becomes what the level says of each point
template <int Dim>
Misses missesOf(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Samples<Dim>& points, int threads, std::vector<SampleCheck>* checks = nullptr);

/// By a function, anywhere, of f alone.
template <int Dim>
Misses missesOf(const BrickSpline<Dim>& function, const Samples<Dim>& samples);

/// Whether it is noise that points miss the surface of a level by, and no detail that its lattice
/// cannot follow.
///
/// @param noiseBefore  by how much they miss that of the coarser level, 0 without; asked if it
/// counts
bool isNoise(double noise, double spacing, const std::function<double()>& noiseBefore);

/// @param lattice  the finest lattice
/// @param fitted   if given, what an addition needs, unless the fit is aborted
template <int Dim>
HierarchicalResult<Dim> fitHierarchical(const Lattice<Dim>& lattice, HermiteInput<Dim> input,
  const HierarchicalOptions& options, const ProgressCallback& progress = {},
  FittedData<Dim>* fitted = nullptr);
}

#endif
