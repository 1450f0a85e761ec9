// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Products with the collocation matrix B of a set of rows, without forming it.
 *
 * A row touches 4^Dim coefficients. Rows are taken cell by cell: a cell's coefficients are read
 * once, its contributions written once, and the basis of a row is rebuilt from its local
 * coordinates, which costs less than reading it. W is the diagonal matrix of the row weights.
 */
#ifndef ipia_CollocationOperator_h
#define ipia_CollocationOperator_h

#include "ConstraintRows.h"

namespace ipia
{
template <int Dim>
class CollocationOperator
{
public:
  /// @param threads  0: OpenMP's own choice. The rows must outlive the operator.
  explicit CollocationOperator(const ConstraintRows<Dim>& rows, int threads = 0);

  /// @a gradient = B^T W (b - B c); returns the energy sum_k w_k (b_k - f(x_k))^2.
  double residual(const Vector& coefficients, Vector& gradient) const;

  /// @a product = B^T W B c.
  void normalProduct(const Vector& coefficients, Vector& product) const;

  /// @a sums_i = sum_k w_k B_i(x_k), the row sums of B^T W B.
  void columnSums(Vector& sums) const;

  /// @a support_i = sum_k B_i(x_k): the same without weights.
  void support(Vector& support) const;

  const Lattice<Dim>& lattice() const { return this->Rows.lattice(); }
  int threads() const { return this->Threads; }

private:
  template <typename Kernel>
  double sweep(const double* coefficients, Vector& result) const;

  const ConstraintRows<Dim>& Rows;
  int Threads;
};
}

#endif
