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
#include "LeastSquaresSolver.h"

#include <memory>
#include <vector>

namespace ipia
{
/// What is to be fitted; positions are relative to the lower corner of the domain and inside it.
template <int Dim>
struct HermiteInput
{
  Points<Dim> Positions; ///< Dim x n
  Points<Dim> Normals;   ///< Dim x n, unit length, towards f > 0; a zero column has no gradient row
  Vector Weights;        ///< n, >= 0; empty: 1

  Points<Dim> ExtraPositions; ///< Dim x m: points ...
  Vector ExtraValues;         ///< ... where f shall take these values ...
  Vector ExtraWeights;        ///< ... with these weights; empty: 1
};

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
  double BandThinPlate = 1e-4;  ///< tau_2 of the others
  int DenseIterations = 20;
  double DenseTolerance = 1e-5;
  int BandIterations = 12;
  int FinestIterations = 12;
  double BandTolerance = 1e-3;
  double FinestTolerance = 1e-3;
  StoppingRule Rule = StoppingRule::RelativeResidual; ///< of the finest level
  /// Residuals beyond this many standard deviations of the coarser prediction lose weight.
  double RobustFactor = 4;
  /// Smoothing length, lengths in the units of the points: weights of gradient rows and thin plate
  /// grow where it exceeds the knot spacing. Negative: none on clean data, by cross-validation on
  /// noisy ones.
  double SmoothingLength = -1;
  int Threads = 0;
};

/// What one level did.
struct LevelReport
{
  double Spacing = 0;
  std::int64_t NumberOfRows = 0;
  std::int64_t NumberOfActiveCoefficients = 0;
  int NumberOfIterations = 0;
  /// The preconditioned residual before the first and after each iteration, relative to the first.
  std::vector<double> ResidualHistory;
  /// sum_k w_k r_k^2 over all rows, value and gradient, with the weights of the level.
  double Energy = 0;
  double AverageError = 0; ///< E_ave, mean of f^2 over the points; finest level only, as Energy
  double MaximumError = 0; ///< E_max, max |f| over the points
  double Seconds = 0;
};

template <int Dim>
struct HierarchicalResult
{
  bool Aborted = false;
  std::shared_ptr<const BrickSpline<Dim>> Function; ///< nullptr if aborted
  std::vector<LevelReport> Reports;                 ///< coarse to fine
  /// Root mean square distance of the points from the zero set of a level that they determine well,
  /// in its knot spacings; 0 if the points are too sparse for any.
  double Noise = 0;
  double SmoothingLength = 0; ///< as used
};

/// @param lattice  the finest lattice
template <int Dim>
HierarchicalResult<Dim> fitHierarchical(const Lattice<Dim>& lattice, const HermiteInput<Dim>& input,
  const HierarchicalOptions& options, const ProgressCallback& progress = {});
}

#endif
