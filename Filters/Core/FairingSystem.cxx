// SPDX-License-Identifier: BSD-3-Clause
#include "FairingSystem.h"

#include "Parallel.h"

#include <cmath>

namespace ipia
{
namespace
{
constexpr int MaximumOrder = BSplineBasis::MaximumDegree + 1;

/// Control points below which threads cost more than they save.
constexpr std::int64_t SmallProblem = 4096;

double binomial(int n, int k)
{
  double value = 1;
  for (int i = 1; i <= k; ++i)
  {
    value *= static_cast<double>(n - k + i) / i;
  }
  return value;
}

/// N^T y of one axis, y of the length of the parameters.
void addTransposed(const BSplineBasis& basis, const Vector& parameters, const double* y,
  std::int64_t stride, double* result)
{
  double values[MaximumOrder];
  for (Eigen::Index k = 0; k < parameters.size(); ++k)
  {
    const std::int64_t span = basis.span(parameters[k]);
    basis.evaluate(span, parameters[k], 0, values);
    for (int i = 0; i <= basis.degree(); ++i)
    {
      result[basis.index(span, i)] += values[i] * y[k * stride];
    }
  }
}

/// Data points in order of their span on an axis, stable.
struct DataBySpan
{
  std::vector<std::int64_t> Order;
  std::vector<std::int64_t> Begin; ///< of each span in Order, by the number of its first knot

  DataBySpan(const BSplineBasis& basis, const Vector& parameters)
    : Order(static_cast<std::size_t>(parameters.size()))
    , Begin(basis.knots().size() + 1, 0)
  {
    std::vector<std::int64_t> span(this->Order.size());
    for (std::size_t k = 0; k < span.size(); ++k)
    {
      span[k] = basis.span(parameters[static_cast<Eigen::Index>(k)]);
      ++this->Begin[static_cast<std::size_t>(span[k] + 1)];
    }
    for (std::size_t s = 1; s < this->Begin.size(); ++s)
    {
      this->Begin[s] += this->Begin[s - 1];
    }
    std::vector<std::int64_t> next = this->Begin;
    for (std::size_t k = 0; k < span.size(); ++k)
    {
      this->Order[static_cast<std::size_t>(next[static_cast<std::size_t>(span[k])]++)] =
        static_cast<std::int64_t>(k);
    }
  }
};

/// N^T y of gridded data, one axis after the other.
Eigen::MatrixXd transposedOnGrid(const std::array<BSplineBasis, 2>& axes,
  const std::array<Vector, 2>& parameters, const Eigen::MatrixXd& y, int threads)
{
  const std::int64_t m0 = parameters[0].size(), m1 = parameters[1].size();
  const std::int64_t n0 = axes[0].size(), n1 = axes[1].size();
  const std::int64_t coordinates = y.cols();
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(m1 * n0, coordinates); // data rows fastest
#pragma omp parallel for schedule(static) num_threads(threads)
  for (std::int64_t task = 0; task < m1 * coordinates; ++task)
  {
    const std::int64_t row = task % m1, c = task / m1;
    Vector sums = Vector::Zero(n0);
    addTransposed(axes[0], parameters[0], y.data() + c * y.rows() + row * m0, 1, sums.data());
    for (std::int64_t i = 0; i < n0; ++i)
    {
      along(row + m1 * i, c) = sums[i];
    }
  }
  Eigen::MatrixXd result(n0 * n1, coordinates);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (std::int64_t task = 0; task < n0 * coordinates; ++task)
  {
    const std::int64_t i = task % n0, c = task / n0;
    Vector sums = Vector::Zero(n1);
    addTransposed(axes[1], parameters[1], along.data() + c * along.rows() + i * m1, 1, sums.data());
    for (std::int64_t l = 0; l < n1; ++l)
    {
      result(i + n0 * l, c) = sums[l];
    }
  }
  return result;
}
}

FairingSystem::FairingSystem(const std::array<BSplineBasis, 2>& axes, const FairingData& data,
  const Vector& weights, int order, int threads)
  : Axes(axes)
  , Weights(weights)
  , Threads(weights.size() < SmallProblem ? 1 : resolveThreads(threads))
  , Gridded(data.Gridded)
{
  if (this->Gridded)
  {
    this->addGriddedData(data);
  }
  else
  {
    this->addScatteredData(data);
  }
  for (int k = 0; k <= order; ++k)
  {
    if (order - k <= axes[0].degree() && k <= axes[1].degree())
    {
      this->Terms.push_back({ binomial(order, k), { axes[0].gram(order - k), axes[1].gram(k) } });
    }
  }
}

void FairingSystem::addGriddedData(const FairingData& data)
{
  for (std::size_t a = 0; a < 2; ++a)
  {
    this->Gram[a] = this->Axes[a].collocationGram(data.Parameters[a]);
  }
  this->DataSide = transposedOnGrid(this->Axes, data.Parameters, data.Points, this->Threads);
}

void FairingSystem::addScatteredData(const FairingData& data)
{
  const BSplineBasis &u = this->Axes[0], &v = this->Axes[1];
  const int p = u.degree(), q = v.degree();
  for (std::size_t a = 0; a < 2; ++a)
  {
    this->Gram[a] =
      BandMatrix(this->Axes[a].size(), this->Axes[a].degree(), this->Axes[a].isPeriodic());
  }
  this->Blocks.assign(static_cast<std::size_t>(v.size() * (2 * q + 1)), this->Gram[0]);
  this->DataSide = Eigen::MatrixXd::Zero(this->size(), data.Points.cols());
  const DataBySpan sorted(v, data.Parameters[1]);

  // The functions of a row of control points and the spans on which they are not 0.
  std::vector<std::vector<std::pair<std::int64_t, int>>> spansOfRow(
    static_cast<std::size_t>(v.size()));
  for (const std::int64_t k : v.spans())
  {
    for (int l = 0; l <= q; ++l)
    {
      spansOfRow[static_cast<std::size_t>(v.index(k, l))].emplace_back(k, l);
    }
  }
  // A row belongs to one thread.
#pragma omp parallel for schedule(dynamic) num_threads(this->Threads)
  for (std::int64_t row = 0; row < v.size(); ++row)
  {
    double inU[MaximumOrder], inV[MaximumOrder];
    for (const auto& [spanV, l] : spansOfRow[static_cast<std::size_t>(row)])
    {
      const auto first = static_cast<std::size_t>(spanV);
      for (std::int64_t k = sorted.Begin[first]; k < sorted.Begin[first + 1]; ++k)
      {
        const std::int64_t point = sorted.Order[static_cast<std::size_t>(k)];
        const double s = data.Parameters[0][point];
        const std::int64_t spanU = u.span(s);
        u.evaluate(spanU, s, 0, inU);
        v.evaluate(spanV, data.Parameters[1][point], 0, inV);
        for (int i = 0; i <= p; ++i)
        {
          const std::int64_t column = u.index(spanU, i);
          const double value = inV[l] * inU[i];
          for (Eigen::Index c = 0; c < data.Points.cols(); ++c)
          {
            this->DataSide(column + row * u.size(), c) += value * data.Points(point, c);
          }
          for (int l2 = 0; l2 <= q; ++l2)
          {
            BandMatrix& block =
              this->Blocks[static_cast<std::size_t>(row * (2 * q + 1) + l2 - l + q)];
            for (int i2 = 0; i2 <= p; ++i2)
            {
              block.at(column, i2 - i) += value * inV[l2] * inU[i2];
            }
          }
        }
      }
    }
  }
}

double FairingSystem::fittingEntry(std::int64_t i, std::int64_t row, int du, int dv) const
{
  if (this->Gridded)
  {
    return this->Gram[0].at(i, du) * this->Gram[1].at(row, dv);
  }
  const int q = this->Axes[1].degree();
  return this->Blocks[static_cast<std::size_t>(row * (2 * q + 1) + dv + q)].at(i, du);
}

double FairingSystem::fairingEntry(std::int64_t i, std::int64_t row, int du, int dv) const
{
  double sum = 0;
  for (const EnergyTerm& term : this->Terms)
  {
    sum += term.Factor * term.Along[0].at(i, du) * term.Along[1].at(row, dv);
  }
  return sum;
}

Vector FairingSystem::absoluteRowSums() const
{
  Vector sums = Vector::Zero(this->size());
#pragma omp parallel for schedule(static) num_threads(this->Threads)
  for (std::int64_t j = 0; j < this->size(); ++j)
  {
    double sum = 0;
    this->visitRow(j,
      [&](std::int64_t, double g, double d)
      { sum += std::abs((1 - this->Weights[j]) * g + this->Weights[j] * d); });
    sums[j] = sum;
  }
  return sums;
}

void FairingSystem::addAcross(const BandMatrix& matrix, double factor, const Eigen::MatrixXd& along,
  std::int64_t row, Eigen::Index coordinate, Eigen::MatrixXd& result) const
{
  const std::int64_t n = this->Axes[0].size();
  double* __restrict to = result.data() + coordinate * result.rows() + row * n;
  for (int dv = -matrix.HalfWidth; dv <= matrix.HalfWidth; ++dv)
  {
    const std::int64_t from = matrix.column(row, dv);
    if (from >= 0)
    {
      const double entry = factor * matrix.at(row, dv);
      const double* __restrict x = along.data() + coordinate * along.rows() + from * n;
#pragma omp simd
      for (std::int64_t i = 0; i < n; ++i)
      {
        to[i] += entry * x[i];
      }
    }
  }
}

void FairingSystem::apply(
  const Eigen::MatrixXd& x, Eigen::MatrixXd& fitting, Eigen::MatrixXd& fairing) const
{
  const std::int64_t n = this->Axes[0].size(), rows = this->Axes[1].size();
  const std::int64_t tasks = rows * x.cols();
  const int q = this->Axes[1].degree();
  fitting.resize(x.rows(), x.cols());
  fairing.resize(x.rows(), x.cols());
  // Along the first axis, then across it; every row belongs to one thread.
  const std::size_t matrices = this->Terms.size() + (this->Gridded ? 1 : 0);
  std::vector<Eigen::MatrixXd>& along = this->Along;
  along.resize(matrices);
  for (Eigen::MatrixXd& product : along)
  {
    product.resize(x.rows(), x.cols());
  }
#pragma omp parallel num_threads(this->Threads)
  {
#pragma omp for schedule(static)
    for (std::int64_t task = 0; task < tasks; ++task)
    {
      for (std::size_t k = 0; k < matrices; ++k)
      {
        double* to = along[k].data() + task * n;
        std::fill(to, to + n, 0.0);
        const BandMatrix& matrix = k < this->Terms.size() ? this->Terms[k].Along[0] : this->Gram[0];
        matrix.addProduct(x.data() + task * n, to);
      }
    }
#pragma omp for schedule(static)
    for (std::int64_t task = 0; task < tasks; ++task)
    {
      const std::int64_t row = task % rows;
      const Eigen::Index c = task / rows;
      std::fill_n(fitting.data() + task * n, n, 0.0);
      std::fill_n(fairing.data() + task * n, n, 0.0);
      for (std::size_t k = 0; k < this->Terms.size(); ++k)
      {
        this->addAcross(this->Terms[k].Along[1], this->Terms[k].Factor, along[k], row, c, fairing);
      }
      if (this->Gridded)
      {
        this->addAcross(this->Gram[1], 1, along.back(), row, c, fitting);
        continue;
      }
      for (int dv = -q; dv <= q; ++dv)
      {
        const std::int64_t from = this->Gram[1].column(row, dv);
        if (from >= 0)
        {
          this->Blocks[static_cast<std::size_t>(row * (2 * q + 1) + dv + q)].addProduct(
            x.data() + c * x.rows() + from * n, fitting.data() + c * x.rows() + row * n);
        }
      }
    }
  }
}

Eigen::MatrixXd fittingResiduals(const TensorSpline& spline, const FairingData& data, int threads)
{
  Eigen::MatrixXd residuals(data.Points.rows(), 3);
  const std::int64_t columns = data.Parameters[0].size();
#pragma omp parallel for schedule(static) num_threads(resolveThreads(threads))
  for (std::int64_t k = 0; k < data.Points.rows(); ++k)
  {
    const double u = data.Parameters[0][data.Gridded ? k % columns : k];
    const double v = data.Parameters[1][data.Gridded ? k / columns : k];
    residuals.row(k) = data.Points.row(k) - spline.value(u, v).transpose();
  }
  return residuals;
}

double rootMeanSquare(const Eigen::MatrixXd& residuals)
{
  return std::sqrt(residuals.squaredNorm() / static_cast<double>(residuals.rows()));
}

double fairingEnergy(const TensorSpline& spline, int order)
{
  FairingData none;
  none.Points.resize(0, 3);
  const FairingSystem system(spline.Axes, none, Vector::Ones(spline.size()), order, 1);
  Eigen::MatrixXd fitting, fairing;
  system.apply(spline.ControlPoints, fitting, fairing);
  return spline.ControlPoints.cwiseProduct(fairing).sum();
}

Vector carryToControlPoints(const std::array<BSplineBasis, 2>& axes, const FairingData& data,
  const Vector& values, double otherwise)
{
  Eigen::MatrixXd weighted(values.size(), 2);
  weighted.col(0) = values;
  weighted.col(1).setOnes();
  Eigen::MatrixXd sums;
  if (data.Gridded)
  {
    sums = transposedOnGrid(axes, data.Parameters, weighted, 1);
  }
  else
  {
    sums = Eigen::MatrixXd::Zero(axes[0].size() * axes[1].size(), 2);
    double inU[MaximumOrder], inV[MaximumOrder];
    for (Eigen::Index k = 0; k < values.size(); ++k)
    {
      const double u = data.Parameters[0][k], v = data.Parameters[1][k];
      const std::int64_t spanU = axes[0].span(u), spanV = axes[1].span(v);
      axes[0].evaluate(spanU, u, 0, inU);
      axes[1].evaluate(spanV, v, 0, inV);
      for (int l = 0; l <= axes[1].degree(); ++l)
      {
        for (int i = 0; i <= axes[0].degree(); ++i)
        {
          sums.row(axes[0].index(spanU, i) + axes[0].size() * axes[1].index(spanV, l)) +=
            inU[i] * inV[l] * weighted.row(k);
        }
      }
    }
  }
  Vector carried(sums.rows());
  for (Eigen::Index j = 0; j < carried.size(); ++j)
  {
    carried[j] = sums(j, 1) > 0 ? sums(j, 0) / sums(j, 1) : otherwise;
  }
  if (values.size() > 0)
  {
    // Rounding must not leave the range.
    const double low = std::min(values.minCoeff(), otherwise);
    const double high = std::max(values.maxCoeff(), otherwise);
    carried = carried.cwiseMax(low).cwiseMin(high);
  }
  return carried;
}
}
