// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Fairing-PIA and two other ways to the same control points.
 */
#ifndef ipia_FairingIteration_h
#define ipia_FairingIteration_h

#include "FairingSystem.h"

#include <vector>

namespace ipia
{
enum class FairingSolver
{
  /**
   * P <- P + M [(I - Omega) N^T (Q - N P) - Omega D P], M = diag(mu_j), fairing-PIA, eq. 4 and 23
   * of Jiang and Lin. Convergence is proven for equal weights and for strictly diagonally dominant
   * A.
   */
  ProgressiveIteration,
  /// Stabilised biconjugate gradients, preconditioned by M; two products with A per iteration.
  BiconjugateGradient,
  /**
   * Sparse factorisation of A with one step of iterative refinement; with equal weights the
   * classical minimiser of the energy. Singular where the solution is not one: it is not finite,
   * the refinement moves the control points by more than 1e-3 of their size (so that fewer than
   * three digits are determined: the size of the step is the rounding unit times the condition), or
   * the error left is above both 1e-6 of that at the beginning and the rounding of A P.
   */
  SparseDirect
};

struct FairingOptions
{
  FairingSolver Solver = FairingSolver::ProgressiveIteration;
  int MaximumNumberOfIterations = 1000;
  /// Ends when the iteration error is below it; 0: all iterations are done.
  double Tolerance = 1e-6;
  /// One mu for all control points; 0: mu_j = 1 / sum_l |A_jl| each, at which equal weights always
  /// converge.
  double StepSize = 0;
  /// One per control point, other than 0 if it may move; empty: all. The others keep their place,
  /// and the equations of those that move are solved: a change stays in their supports.
  std::vector<unsigned char> Movable;
};

enum class FairingStatus
{
  Converged,    ///< the iteration error is below Tolerance, or nothing but rounding is left
  AllDone,      ///< Tolerance is 0 and the number of iterations is reached
  NotConverged, ///< the number of iterations is reached, the tolerance not
  Diverged,     ///< the iteration error grew without bound
  Singular,     ///< SparseDirect: A has no inverse, or none that rounding leaves anything of
  NotFinite,    ///< the equations or the state at the beginning have values that are not finite
  Aborted       ///< the callback returned false; the control points are those of the last iteration
};

/// Of the state before the first and after each iteration; of SparseDirect the first and the last.
struct FairingHistory
{
  /// |(I - Omega) N^T (Q - N P) - Omega D P| over its value at the beginning.
  std::vector<double> IterationError;
  std::vector<double> FittingError; ///< E_fit = sqrt(sum |Q - P(t)|^2 / m)
  std::vector<double> Energy;       ///< P^T D P
};

struct FairingResult
{
  FairingStatus Status = FairingStatus::Converged;
  int NumberOfIterations = 0;
  FairingHistory History;
};

/**
 * Improves the control points of @a spline in place.
 * @param residuals  Q - N P of the control points as they are, m by 3, for the history
 * @param progress   asked once per iteration, with the share done
 */
FairingResult iterateFairing(const FairingSystem& system, const Eigen::MatrixXd& residuals,
  const FairingOptions& options, TensorSpline& spline, const ProgressCallback& progress = {});
}

#endif
