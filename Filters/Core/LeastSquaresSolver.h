// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The two solvers of min_c sum_k w_k (b_k - (Bc)_k)^2.
 *
 * Both start from the given coefficients c0 and stay in c0 + range(B^T), hence share their limit:
 * the least-squares solution nearest to c0, which for c0 = 0 is the one of least norm, (B^T W B)^+
 * B^T W b. With a weight lambda of the oscillation both tend to the minimiser of E + lambda R(c),
 * which is unique (OscillationStep::AsPrinted: to another one, and by ProgressiveIteration only).
 */
#ifndef ipia_LeastSquaresSolver_h
#define ipia_LeastSquaresSolver_h

#include "CollocationOperator.h"
#include "Oscillation.h"

#include <vector>

namespace ipia
{
enum class SolverType
{
  /// C <- C + mu B^T W (b - B C), eq. 11 and 16 of Hamza, Lin, Li (2019).
  ProgressiveIteration,
  /// Conjugate gradient on the normal equations; about the same cost per iteration.
  ConjugateGradient
};

enum class StoppingRule
{
  RelativeResidual, ///< ||B^T W r|| / ||B^T W r0|| < Tolerance
  EnergyChange      ///< |E_new - E_old| < Tolerance, of SolverResult::Energy
};

struct SolverOptions
{
  SolverType Type = SolverType::ProgressiveIteration;
  int MaximumNumberOfIterations = 100;
  /// 0: all iterations are done; conjugate gradients still end where only rounding is left.
  double Tolerance = 0;
  StoppingRule Rule = StoppingRule::RelativeResidual;
  /// mu; 0: 2 / max_i sum_k w_k B_i(x_k), with OscillationStep::Energy 2 / (that maximum + 8 Dim
  /// lambda), which always converges
  double StepSize = 0;
  OscillationOptions Oscillation;
};

enum class SolverStatus
{
  Done,
  Aborted, ///< the callback returned false; the coefficients are those of the last iteration
  Diverged ///< the energy that steps descend rose: a step size or OscillationStep::AsPrinted
};

struct SolverResult
{
  SolverStatus Status = SolverStatus::Done;
  int NumberOfIterations = 0;
  double StepSize = 0; ///< mu; 0 with ConjugateGradient
  double Energy = 0;   ///< sum_k w_k r_k^2 + lambda R(c) of the returned coefficients
  /// ||B^T W r|| / ||B^T W r0|| before the first and after each iteration; with an oscillation's
  /// weight that of B^T W r - kappa L c, the direction of the steps (see OscillationTerm).
  std::vector<double> ResidualHistory;
};

/// Improves @a coefficients in place; the callback is asked once per iteration.
template <int Dim>
SolverResult solveLeastSquares(const CollocationOperator<Dim>& collocation,
  const SolverOptions& options, Vector& coefficients, const ProgressCallback& progress = {});
}

#endif
