// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * B-splines of one variable on arbitrary knots, open (clamped) or closed (periodic).
 */
#ifndef ipia_BSplineBasis_h
#define ipia_BSplineBasis_h

#include "BandMatrix.h"

#include <vector>

namespace ipia
{
/**
 * The B-splines N_0, ..., N_{n-1} of a degree from 1 to 5 on the domain [0, 1].
 *
 * Clamped: n + degree + 1 knots, nondecreasing, the first and the last degree + 1 of them 0 and 1,
 * none inside more than degree times. Periodic: the knots U_0 <= ... <= U_{n + 2 degree} go on
 * beyond the domain [U_degree, U_{n + degree}] = [0, 1] with period 1, and function j + n is
 * function j.
 *
 * A basis made by default is the constant 1, degree 0 with one function: the second axis of a
 * curve.
 */
class BSplineBasis
{
public:
  static constexpr int MaximumDegree = 5;
  /// Different knots nearer to each other than that leave derivatives no digits.
  static constexpr double SmallestSpan = 1e-12;

  BSplineBasis();

  /// From the interior knots, each in (0, 1), nondecreasing, at most @a degree of them equal.
  static BSplineBasis clamped(int degree, const std::vector<double>& interior);

  /// From the n - 1 >= degree knots inside (0, 1); 0 is a knot, too.
  static BSplineBasis periodic(int degree, const std::vector<double>& interior);

  int degree() const { return this->Degree; }
  bool isPeriodic() const { return this->Periodic; }
  /// Number of functions n.
  std::int64_t size() const { return this->Size; }
  /// All knots, see above.
  const std::vector<double>& knots() const { return this->Knots; }
  /// The knots inside the domain, as clamped() and periodic() take them.
  std::vector<double> interiorKnots() const;
  /// First knot of every span [U_k, U_{k+1}] of the domain that is not empty, k.
  std::vector<std::int64_t> spans() const;

  /// k such that U_k <= t < U_{k+1}, the last span closed; t in [0, 1].
  std::int64_t span(double t) const;

  /**
   * The degree + 1 functions that are not 0 on span k, and their derivatives:
   * values[r (degree + 1) + i] = N_{k - degree + i}^(r)(t), r = 0, ..., @a derivatives.
   */
  void evaluate(std::int64_t k, double t, int derivatives, double* values) const;

  /// Index of the control point of function k - degree + i of span k.
  std::int64_t index(std::int64_t k, int i) const
  {
    const std::int64_t j = k - this->Degree + i;
    return j < this->Size ? j : j - this->Size;
  }

  /// Mean of the knots inside the support of N_j, the parameter where it counts most, in [0, 1].
  double greville(std::int64_t j) const;

  /**
   * The Gram matrix D_r, (D_r)_jl = int N_j^(r) N_l^(r) dt over [0, 1], by Gauss quadrature of
   * degree + 1 nodes on each span, which is exact. 0 for r > degree. Jumps of the (r - 1)-th
   * derivative at knots of high multiplicity do not count.
   */
  BandMatrix gram(int r) const;

  /// N^T N of the collocation at @a parameters, each in [0, 1].
  BandMatrix collocationGram(const Vector& parameters) const;

  /**
   * The same splines on more knots: each of @a inserted lies in (0, 1), and no knot becomes more
   * than degree-fold.
   * @param transfer  the matrix T, new size by old size: control points T P give the same curve.
   *                  Its rows sum to 1; columns of row i are those of first[i] and on, modulo size.
   */
  BSplineBasis insertKnots(const std::vector<double>& inserted, Eigen::MatrixXd& transfer,
    std::vector<std::int64_t>& first) const;

private:
  int Degree;
  bool Periodic;
  std::int64_t Size;
  std::vector<double> Knots;
};

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1], n >= 1.
void gaussLegendre(int n, std::vector<double>& nodes, std::vector<double>& weights);
}

#endif
