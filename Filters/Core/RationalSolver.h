// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The iteration of the uniform rational spline g(x) = sum_i c_i w_i B_i(x) / sum_i w_i B_i(x)
 * (Huang, 2024, eq. 14 to 25 and 33), with weights v_k of the rows.
 *
 * All w_i are 1 at first. Each iteration takes
 *
 *     w <- max(w - tau grad_w E, 0),   dE/dw_i = 2 sum_k v_k (g_k - b_k) B_i(x_k) (c_i - g_k) / d_k
 *
 * with the denominators d_k, and then, with D, residual and mu of the new weights,
 *
 *     c <- c + mu D^T V (b - D c),   D_ki = w_i B_i(x_k) / d_k,   mu = 2 / ||D^T V D||_inf,
 *
 * with the oscillation as OscillationStep says. tau is halved, for that step alone, until no
 * denominator becomes 0 anywhere in the domain and E does not grow. Neither step lets E grow, then.
 */
#ifndef ipia_RationalSolver_h
#define ipia_RationalSolver_h

#include "LeastSquaresSolver.h"

namespace ipia
{
struct RationalOptions
{
  double WeightStepSize = 0.01; ///< tau >= 0, in 1 / (units of f)^2; 0: the weights stay 1
};

struct RationalResult
{
  SolverResult Solver;
  double WeightStepSize = 0; ///< the smallest tau that a step was taken with
  Vector Weights;            ///< w, a number per coefficient, >= 0
};

/**
 * Whether sum_i w_i B_i(x) counts as positive everywhere in the domain: in no knot it is less than
 * 1e-9, so that it is larger than 0 between them, too.
 *
 * @param weights  lattice.numberOfCoefficients() finite values, >= 0
 */
template <int Dim>
bool hasPositiveDenominators(const Lattice<Dim>& lattice, const Vector& weights);

/// Improves @a coefficients in place by SolverType::ProgressiveIteration, whatever
/// SolverOptions::Type is; the callback is asked once per iteration.
template <int Dim>
RationalResult solveRational(const ConstraintRows<Dim>& rows, const SolverOptions& options,
  const RationalOptions& rationalOptions, int threads, Vector& coefficients,
  const ProgressCallback& progress = {});
}

#endif
