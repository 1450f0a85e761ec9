// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What an iteration of the uniform rational spline needs of its rows, without forming a matrix.
 *
 * With numerator coefficients a_i = w_i c_i and denominator coefficients w_i,
 *
 *     g(x) = sum_i a_i B_i(x) / d(x),   d(x) = sum_i w_i B_i(x),
 *
 * the collocation matrix has the entries D_ki = w_i B_i(x_k) / d_k. Row k has the weight v_k and
 * the target b_k. Two functions share the bases of a row: a sweep gathers and scatters both, as
 * pairs that lie side by side. An iteration takes two sweeps; the denominators of the first serve
 * the second, whose weights w are the same.
 */
#ifndef ipia_RationalOperator_h
#define ipia_RationalOperator_h

#include "RowBatches.h"
#include "TouchedCoefficients.h"

#include <limits>

namespace ipia
{
/// Two numbers of each coefficient.
using CoefficientPairs = Eigen::Matrix<double, 2, Eigen::Dynamic>;

template <int Dim>
class RationalOperator
{
public:
  /**
   * @param rows     must outlive the operator; fastest with bars along y
   * @param threads  0: OpenMP's own choice
   */
  explicit RationalOperator(const ConstraintRows<Dim>& rows, int threads = 0);

  /**
   * For the step of the coefficients. Keeps the denominators.
   *
   * @param pairs  a_i and w_i, with d_k > 0 at all rows
   * @param sums   what is added to: sum_k v_k (b_k - g_k) / d_k B_i(x_k), which times w_i is
   *               (D^T V (b - Dc))_i, and sum_k v_k / d_k B_i(x_k), which times w_i is the row sum
   * of D^T V D
   * @param bound  the sweep ends where the energy is sure to be larger; the result is infinite
   *               then, sums and denominators are of no use
   * @return sum_k v_k (b_k - g_k)^2
   */
  double coefficientSums(const CoefficientPairs& pairs, CoefficientPairs& sums,
    double bound = std::numeric_limits<double>::infinity());

  /**
   * For the step of the weights, with the denominators of the last coefficientSums().
   *
   * @param pairs  a_i and w_i, with the w_i that coefficientSums() had
   * @param sums   what is added to: S_i = sum_k v_k (g_k - b_k) / d_k B_i(x_k) and
   *               T_i = sum_k v_k (g_k - b_k) g_k / d_k B_i(x_k); then the gradient of the energy
   * by the weight w_i is 2 (c_i S_i - T_i)
   * @return sum_k v_k (b_k - g_k)^2
   */
  double weightSums(const CoefficientPairs& pairs, CoefficientPairs& sums);

  /// Returns sum_k v_k (b_k - g_k)^2; infinite where it is larger than a bound, as above.
  double energy(
    const CoefficientPairs& pairs, double bound = std::numeric_limits<double>::infinity());

  const Lattice<Dim>& lattice() const { return this->Rows.lattice(); }
  int threads() const { return this->Threads; }
  const TouchedCoefficients& touched() const { return this->Touched; }

  /// sum_k v_k
  double sumOfRowWeights() const;

private:
  template <typename Kernel>
  double sweep(const CoefficientPairs& pairs, double* sums, double bound);

  const ConstraintRows<Dim>& Rows;
  const RowBatches<Dim> Batches;
  const TouchedCoefficients Touched;
  int Threads;
  Vector InverseDenominators; // of the rows in the order of Batches
};
}

#endif
