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
 * the target b_k. Two functions share the bases of a row: a sweep gathers and scatters both.
 */
#ifndef ipia_RationalOperator_h
#define ipia_RationalOperator_h

#include "TouchedCoefficients.h"

namespace ipia
{
template <int Dim>
class RationalOperator
{
public:
  /// All denominators are taken to be 1 at first, as they are for weights of 1.
  /// @param threads  0: OpenMP's own choice. The rows must outlive the operator.
  explicit RationalOperator(const ConstraintRows<Dim>& rows, int threads = 0);

  /**
   * For the step of the coefficients. Computes the denominators of the rows anew and keeps them.
   *
   * @param numerator     a
   * @param weights       w, with d_k > 0 at all rows
   * @param residualSums  sum_k v_k (b_k - g_k) / d_k B_i(x_k); times w_i it is (D^T V (b - Dc))_i
   * @param rowSums       sum_k v_k / d_k B_i(x_k); times w_i it is the row sum of D^T V D
   * @return sum_k v_k (b_k - g_k)^2
   */
  double coefficientSums(
    const Vector& numerator, const Vector& weights, Vector& residualSums, Vector& rowSums);

  /**
   * For the step of the weights, with the denominators that are kept.
   *
   * @param numerator  a
   * @param sums       S_i = sum_k v_k (g_k - b_k) / d_k B_i(x_k)
   * @param valueSums  T_i = sum_k v_k (g_k - b_k) g_k / d_k B_i(x_k); then the gradient of the
   *                   energy by the weight w_i is 2 (c_i S_i - T_i)
   * @return sum_k v_k (b_k - g_k)^2
   */
  double weightSums(const Vector& numerator, Vector& sums, Vector& valueSums);

  const Lattice<Dim>& lattice() const { return this->Rows.lattice(); }
  int threads() const { return this->Threads; }

  /// The sums are made for these coefficients only.
  const TouchedCoefficients& touched() const { return this->Touched; }

  /// sum_k v_k
  double sumOfRowWeights() const;

private:
  template <typename Kernel>
  double sweep(const double* numerator, const double* weights, Vector& first, Vector& second);

  const ConstraintRows<Dim>& Rows;
  const TouchedCoefficients Touched;
  Vector Inverse; ///< 1 / d_k, and room for a whole vector from the last one on
  int Threads;
};
}

#endif
