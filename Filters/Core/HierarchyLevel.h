// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * One level of a hierarchical fit: its data, its band of coefficients, and its solution.
 */
#ifndef ipia_HierarchyLevel_h
#define ipia_HierarchyLevel_h

#include "BrickLattice.h"
#include "BrickOperator.h"
#include "HermiteRows.h"
#include "LeastSquaresSolver.h"
#include "PointSamples.h"

#include <vector>

namespace ipia
{
/// The constants of the method; lengths in knot spacings of the level, weights without unit.
struct HierarchicalOptions
{
  int NumberOfLevels =
    0;                 ///< 0: until the coarsest has no more than 16 cells along its longest side
  int DenseCells = 32; ///< levels with no more cells along their longest side are dense

  /// Share of the gradient rows, g: h grad f = h n has the weight g^2 of f = 0.
  double DenseGradient = 1, BandGradient = 0.3, FinestGradient = 0.3;
  double DenseMembrane = 0.01;  ///< tau_1 of the dense levels
  double DenseThinPlate = 1e-3; ///< tau_2 of the dense levels
  double BandMembrane = 0;      ///< tau_1 of the others
  double BandThinPlate = 5e-5;  ///< tau_2 of the others
  /// The knot spacing that suits the density of the points, in their units: tau_2 of bands grows by
  /// the fourth power of this over their spacing, while it is 1 to 4. 0: it does not.
  double DataSpacing = 0;
  int DenseIterations = 20;
  double DenseTolerance = 1e-5;
  int BandIterations = 12;
  int FinestIterations = 0; ///< of the finest level; 0: those of its kind
  double BandTolerance = 1e-3;
  double FinestTolerance = -1; ///< of the finest level; negative: that of its kind
  StoppingRule Rule = StoppingRule::RelativeResidual; ///< of the finest level
  /// Residuals beyond this many standard deviations of the coarser prediction lose weight.
  double RobustFactor = 4;
  /// Smoothing length, lengths in the units of the points: weights of gradient rows and thin plate
  /// grow where it exceeds the knot spacing. Negative: none on clean data, by cross-validation on
  /// noisy ones.
  double SmoothingLength = -1;
  int Threads = 0;
};

/// What the weights of the rows of a level follow from, a sum or mean over all of them.
struct RowScales
{
  double Weight = 0;     ///< sum of the weights as given
  double Logarithms = 0; ///< sum of weight times logarithm of the density of rows
  double Rows = 0;       ///< number of rows
  double MedianMiss = 0; ///< median of |f - v| by the coarser level
};

/// What one level did.
struct LevelReport
{
  RowScales Scales;
  double Spacing = 0;
  std::int64_t NumberOfRows = 0;
  std::int64_t NumberOfActiveCoefficients = 0;
  int NumberOfIterations = 0;
  /// The preconditioned residual before the first and after each iteration, relative to the first.
  std::vector<double> ResidualHistory;
  /// The square of the last of these, not relative, by the number of rows.
  double ResidualPerRow = 0;
  /// sum_k w_k r_k^2 over all rows, value and gradient, with the weights of the level.
  double Energy = 0;
  double AverageError = 0; ///< E_ave, mean of f^2 over the points; finest level only, as Energy
  double MaximumError = 0; ///< E_max, max |f| over the points
  double Seconds = 0;
  bool Aborted = false;
};

/// A level before it is solved.
template <int Dim>
struct Level
{
  int Coarsening; ///< halvings below the finest
  Lattice<Dim> Grid;
  bool Dense;
  Samples<Dim> Data;
  Samples<Dim> Unclustered; ///< on the finest level: what Data stand for; empty if Data are these

  const Samples<Dim>& points() const
  {
    return this->Unclustered.empty() ? this->Data : this->Unclustered;
  }
  Samples<Dim>& points() { return this->Unclustered.empty() ? this->Data : this->Unclustered; }

  /// A position in cells of this level.
  Point<Dim> positionOf(const Sample<Dim>& sample) const
  {
    // By a power of two: exact.
    return sample.Position * (1 / static_cast<double>(std::int64_t{ 1 } << this->Coarsening));
  }

  Index<Dim> cellOf(const Sample<Dim>& sample) const
  {
    return this->cellAt(this->positionOf(sample));
  }

  /// The cell of a position in cells of this level.
  Index<Dim> cellAt(const Point<Dim>& position) const
  {
    Index<Dim> cell;
    for (int a = 0; a < Dim; ++a)
    {
      // Towards 0 where it is negative, which makes no difference to the first cell.
      const auto at = static_cast<std::int64_t>(position[a]);
      cell[a] = std::min(std::max<std::int64_t>(at, 0), this->Grid.cells(a) - 1);
    }
    return cell;
  }
};

/**
 * The levels of a fit, coarse to fine: spans halve upwards as ceil(n / 2) from the same corner.
 *
 * All see clusters, the finest in sub-cells of SubCellBits halvings of its cells, of which a
 * surface crosses about a hundred: the cost of an iteration does not grow with the points beyond
 * that.
 *
 * @param points  sorted
 */
template <int Dim>
std::vector<Level<Dim>> makeLevels(const Lattice<Dim>& lattice, Samples<Dim> points,
  const HierarchicalOptions& options, int threads);

/// Coarser levels see clusters in sub-cells, so many halvings of their knot cells.
constexpr int ClusterBits = 2;

/// What a level sees of the data of a finer one.
template <int Dim>
Samples<Dim> coarserData(const Samples<Dim>& finer, int coarsening, int threads);

/// The bands of the levels, zero.
template <int Dim>
std::vector<BrickLattice<Dim>> makeBricks(const std::vector<Level<Dim>>& levels, int threads);

/// Adds to bands, of which the active coefficients are marked, what these read; zero.
template <int Dim>
void finishBricks(
  const std::vector<Level<Dim>>& levels, std::vector<BrickLattice<Dim>>& bricks, int threads);

/// Cells along the longest side.
template <int Dim>
std::int64_t longestAxis(const Lattice<Dim>& lattice)
{
  std::int64_t cells = 0;
  for (int a = 0; a < Dim; ++a)
  {
    cells = std::max(cells, lattice.cells(a));
  }
  return cells;
}

/**
 * How far a prediction can follow the normal of a row, the factor of the weight of the row: 1 where
 * it rises along the normal by at least 0.7 of what the row asks for, else the root of its share of
 * that, at least sqrt(0.03). Low on parts too thin for the lattice, where the rows of both sides
 * contradict each other.
 *
 * @param predictedGradient  h grad f
 */
template <int Dim>
double trustInSlope(const HermiteRow<Dim>& row, const float* predictedGradient);

/**
 * The rows of samples on a level, sorted by brick.
 *
 * @param samples   sorted; @a count of them
 * @param gradient  g, see HierarchicalOptions
 */
template <int Dim>
HermiteRows<Dim> makeRows(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Sample<Dim>* samples, std::int64_t count, double gradient, int threads);

/// By what the weights are divided so that the rows of an occupied cell weigh about 1 in all.
template <int Dim>
double typicalDensity(const BrickLattice<Dim>& bricks, const HermiteRows<Dim>& rows, int threads);

/// Conjugate gradients with the diagonal as preconditioner, on the active coefficients, until the
/// square of the residual is at most @a enough or the other limits are met; adds what they did to
/// @a report.
template <int Dim>
void solveSystem(const BrickOperator<Dim>& system, BrickLattice<Dim>& bricks, int iterations,
  double tolerance, StoppingRule rule, double enough, int threads, const ProgressCallback& progress,
  LevelReport& report);

/// Number of knot cells with data.
template <int Dim>
double occupiedCells(const Level<Dim>& level, int threads);

/// How a level is solved, or a part of it.
template <int Dim>
struct LevelTask
{
  bool Predicted;         ///< the coefficients at first are the prediction of a coarser level
  bool Finest;            ///< of the hierarchy
  double SmoothingLength; ///< see HierarchicalOptions; 0: none
  const BrickValues* Start = nullptr; ///< where the solution starts if not from the prediction
  RowScales Elsewhere;                ///< of the rows that do not take part
  double ResidualPerRow = 0;          ///< the iteration ends when it is no larger
};

/// Solves for the active coefficients with the rows of the level's data.
template <int Dim>
LevelReport solveRows(const Level<Dim>& level, BrickLattice<Dim>& bricks,
  const LevelTask<Dim>& task, const HierarchicalOptions& options, int threads,
  const ProgressCallback& progress = {});

/// The scales of the rows of the level's data alone, but for their misses.
template <int Dim>
RowScales scalesOf(const Level<Dim>& level, const BrickLattice<Dim>& bricks, int threads);

/// Solves level @a l from its predecessor.
///
/// @param smoothing  length, see HierarchicalOptions; 0: none
/// @param progress   called before every iteration with the share of the level that is done
template <int Dim>
LevelReport solveLevel(const std::vector<Level<Dim>>& levels,
  std::vector<BrickLattice<Dim>>& bricks, std::size_t l, double smoothing,
  const HierarchicalOptions& options, int threads, const ProgressCallback& progress = {});

/**
 * f and its gradient at sorted samples, (1 + Dim) values each, by a level that covers them.
 *
 * On the calling thread, with scratch memory for all of them: a task of few samples, which stays in
 * the cache.
 */
template <int Dim>
void evaluateLevel(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Sample<Dim>* begin, const Sample<Dim>* end, BrickValues& values);
}

#endif
