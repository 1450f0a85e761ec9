// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * B-splines and fairing-PIA straight from their definitions, with dense matrices.
 */
#ifndef ipia_FairingReference_h
#define ipia_FairingReference_h

#include "FairingIteration.h"
#include "Parametrization.h"
#include "TestSupport.h"

#include <functional>

namespace ipia::test
{
/// The r-th derivative of the i-th B-spline of the recursion of Cox and de Boor; t lies in [from,
/// to), one span of the knots.
inline double recursiveBSpline(
  const std::vector<double>& knots, std::size_t i, int degree, int r, double t, double from)
{
  if (degree == 0)
  {
    return r == 0 && knots[i] <= from && from < knots[i + 1] && t >= knots[i] ? 1.0 : 0.0;
  }
  const auto p = static_cast<std::size_t>(degree);
  const double below = knots[i + p] - knots[i], above = knots[i + p + 1] - knots[i + 1];
  double sum = 0;
  if (below > 0)
  {
    sum += (r > 0 ? degree : t - knots[i]) / below *
      recursiveBSpline(knots, i, degree - 1, std::max(r - 1, 0), t, from);
  }
  if (above > 0)
  {
    sum += (r > 0 ? -degree : knots[i + p + 1] - t) / above *
      recursiveBSpline(knots, i + 1, degree - 1, std::max(r - 1, 0), t, from);
  }
  return sum;
}

/// The first knot of the span that holds t, the last span closed.
inline double spanStart(const BSplineBasis& basis, double t)
{
  double start = 0;
  for (const double knot : basis.knots())
  {
    if (knot >= 0 && knot < 1 && knot <= t)
    {
      start = std::max(start, knot);
    }
  }
  return start;
}

/// Row of all N_j^(r)(t), functions of a closed basis folded.
inline Vector basisRow(const BSplineBasis& basis, double t, int r)
{
  Vector row = Vector::Zero(basis.size());
  const auto functions = basis.knots().size() - static_cast<std::size_t>(basis.degree()) - 1;
  for (std::size_t i = 0; i < functions; ++i)
  {
    row[static_cast<Eigen::Index>(i) % basis.size()] +=
      recursiveBSpline(basis.knots(), i, basis.degree(), r, t, spanStart(basis, t));
  }
  return row;
}

inline Eigen::MatrixXd collocation(const BSplineBasis& basis, const Vector& parameters)
{
  Eigen::MatrixXd matrix(parameters.size(), basis.size());
  for (Eigen::Index k = 0; k < parameters.size(); ++k)
  {
    matrix.row(k) = basisRow(basis, parameters[k], 0).transpose();
  }
  return matrix;
}

/// D_r by Gauss quadrature of twelve nodes on each span, exact to degree 23.
inline Eigen::MatrixXd gramMatrix(const BSplineBasis& basis, int r)
{
  std::vector<double> nodes, weights;
  gaussLegendre(12, nodes, weights);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(basis.size(), basis.size());
  for (const std::int64_t k : basis.spans())
  {
    const double begin = basis.knots()[static_cast<std::size_t>(k)];
    const double half = (basis.knots()[static_cast<std::size_t>(k + 1)] - begin) / 2;
    for (std::size_t q = 0; q < nodes.size(); ++q)
    {
      const Vector row = basisRow(basis, begin + half * (1 + nodes[q]), r);
      matrix += half * weights[q] * row * row.transpose();
    }
  }
  return matrix;
}

inline Eigen::MatrixXd kronecker(const Eigen::MatrixXd& outer, const Eigen::MatrixXd& inner)
{
  Eigen::MatrixXd product(outer.rows() * inner.rows(), outer.cols() * inner.cols());
  for (Eigen::Index i = 0; i < outer.rows(); ++i)
  {
    for (Eigen::Index j = 0; j < outer.cols(); ++j)
    {
      product.block(i * inner.rows(), j * inner.cols(), inner.rows(), inner.cols()) =
        outer(i, j) * inner;
    }
  }
  return product;
}

/// What fairing-PIA is made of.
struct FairingProblem
{
  TensorSpline Start;
  FairingData Data;
  Vector Weights;
  int Order = 2;

  FairingSystem system(int threads = 1) const
  {
    return { this->Start.Axes, this->Data, this->Weights, this->Order, threads };
  }

  FairingResult solve(const FairingOptions& options, TensorSpline& spline, int threads = 1) const
  {
    spline = this->Start;
    return iterateFairing(
      this->system(threads), fittingResiduals(spline, this->Data, threads), options, spline);
  }
};

/// The same as dense matrices.
struct DenseFairing
{
  Eigen::MatrixXd N, D, A, B; ///< collocation, energy, A and (I - Omega) N^T Q

  explicit DenseFairing(const FairingProblem& problem)
  {
    const BSplineBasis &u = problem.Start.Axes[0], &v = problem.Start.Axes[1];
    const FairingData& data = problem.Data;
    const auto& t = data.Parameters;
    if (data.Gridded)
    {
      this->N = kronecker(collocation(v, t[1]), collocation(u, t[0]));
    }
    else
    {
      this->N.resize(t[0].size(), u.size() * v.size());
      for (Eigen::Index k = 0; k < t[0].size(); ++k)
      {
        this->N.row(k) =
          kronecker(basisRow(v, t[1][k], 0).transpose(), basisRow(u, t[0][k], 0).transpose());
      }
    }
    const int r = problem.Order;
    this->D = Eigen::MatrixXd::Zero(this->N.cols(), this->N.cols());
    const double binomials[4][4] = { { 1 }, { 1, 1 }, { 1, 2, 1 }, { 1, 3, 3, 1 } };
    for (int k = 0; k <= (v.degree() == 0 ? 0 : r); ++k)
    {
      this->D += binomials[r][k] * kronecker(gramMatrix(v, k), gramMatrix(u, r - k));
    }
    const Vector fit = Vector::Ones(problem.Weights.size()) - problem.Weights;
    this->A = fit.asDiagonal() * (this->N.transpose() * this->N);
    this->A += problem.Weights.asDiagonal() * this->D;
    this->B = fit.asDiagonal() * (this->N.transpose() * data.Points);
  }

  Vector stepSizes() const { return this->A.cwiseAbs().rowwise().sum().cwiseInverse(); }

  /// P <- P + M (B - A P)
  Eigen::MatrixXd iterate(Eigen::MatrixXd p, const Vector& mu, int iterations) const
  {
    for (int k = 0; k < iterations; ++k)
    {
      p += mu.asDiagonal() * (this->B - this->A * p);
    }
    return p;
  }

  double error(const Eigen::MatrixXd& p) const { return (this->B - this->A * p).norm(); }
};

/// Points on a wavy line in space, with noise.
inline Eigen::MatrixXd wavyPoints(std::int64_t m, bool closed, std::uint64_t seed)
{
  Random random(seed);
  Eigen::MatrixXd points(m, 3);
  for (std::int64_t k = 0; k < m; ++k)
  {
    const double t = static_cast<double>(k) / static_cast<double>(closed ? m : m - 1);
    const double a = 2 * Pi * t;
    points.row(k) << (closed ? std::cos(a) : 3 * t), std::sin(a) + 0.3 * std::cos(3 * a),
      0.5 * std::sin(2 * a + 1);
    for (int c = 0; c < 3; ++c)
    {
      points(k, c) += random.uniform(-0.02, 0.02);
    }
  }
  return points;
}

/// One weight per control point, evenly spread between its bounds on a logarithmic scale.
inline Vector randomWeights(std::int64_t n, double low, double high, std::uint64_t seed)
{
  return Random(seed).vector(n, std::log(low), std::log(high)).array().exp().matrix();
}

inline FairingProblem curveProblem(
  int degree, int order, bool closed, std::int64_t m = 60, std::int64_t n = 20)
{
  FairingProblem problem;
  problem.Order = order;
  problem.Data.Points = wavyPoints(m, closed, 5);
  problem.Data.Parameters = { parametrize(problem.Data.Points, ParametrizationType::Chord, closed),
    Vector::Zero(1) };
  problem.Start.Axes[0] = averagedKnots(problem.Data.Parameters[0], degree, n, closed);
  problem.Weights = Vector::Constant(n, 1e-5);
  problem.Start.ControlPoints.resize(n, 3);
  const auto start = initialPoints(problem.Start.Axes[0], m);
  for (std::int64_t j = 0; j < n; ++j)
  {
    problem.Start.ControlPoints.row(j) =
      problem.Data.Points.row(start[static_cast<std::size_t>(j)]);
  }
  return problem;
}

/// A height field with noise on 25 x 21 points of unequal steps, or scattered; 9 x 8 control
/// points.
inline FairingProblem surfaceProblem(int degree, int order, bool gridded)
{
  FairingProblem problem;
  problem.Order = order;
  problem.Data.Gridded = gridded;
  Random random(17);
  const std::int64_t m0 = 25, m1 = 21, m = m0 * m1;
  auto& t = problem.Data.Parameters;
  if (gridded)
  {
    for (const std::size_t a : { 0u, 1u })
    {
      t[a] = random.vector(a == 0 ? m0 : m1, 0, 1);
      std::sort(t[a].begin(), t[a].end());
      t[a][0] = 0;
      t[a][t[a].size() - 1] = 1;
    }
  }
  else
  {
    t = { random.vector(m, 0, 1), random.vector(m, 0, 1) };
    t[0][3] = t[1][5] = 1;
  }
  problem.Data.Points.resize(m, 3);
  for (std::int64_t k = 0; k < m; ++k)
  {
    const double u = t[0][gridded ? k % m0 : k], v = t[1][gridded ? k / m0 : k];
    problem.Data.Points.row(k) << u, 1.3 * v,
      0.3 * std::sin(4 * u) * std::cos(3 * v) + random.uniform(-0.02, 0.02);
  }
  problem.Start.Axes = { uniformKnots(degree, 9, false), uniformKnots(degree, 8, false) };
  problem.Weights = Vector::Constant(72, 1e-3);
  problem.Start.ControlPoints.resize(72, 3);
  for (std::int64_t j = 0; j < 72; ++j)
  {
    problem.Start.ControlPoints.row(j) << problem.Start.Axes[0].greville(j % 9),
      1.3 * problem.Start.Axes[1].greville(j / 9), random.uniform(-0.1, 0.1);
  }
  return problem;
}
}

#endif
