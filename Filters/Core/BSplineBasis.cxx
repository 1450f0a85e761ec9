// SPDX-License-Identifier: BSD-3-Clause
#include "BSplineBasis.h"

#include <cmath>

namespace ipia
{
namespace
{
constexpr int MaximumOrder = BSplineBasis::MaximumDegree + 1;
constexpr double Pi = 3.14159265358979323846;
}

BSplineBasis::BSplineBasis()
  : Degree(0)
  , Periodic(false)
  , Size(1)
  , Knots{ 0, 1 }
{
}

BSplineBasis BSplineBasis::clamped(int degree, const std::vector<double>& interior)
{
  BSplineBasis basis;
  const auto end = static_cast<std::size_t>(degree + 1);
  basis.Degree = degree;
  basis.Size = static_cast<std::int64_t>(interior.size()) + degree + 1;
  basis.Knots.assign(end, 0.0);
  basis.Knots.insert(basis.Knots.end(), interior.begin(), interior.end());
  basis.Knots.insert(basis.Knots.end(), end, 1.0);
  return basis;
}

BSplineBasis BSplineBasis::periodic(int degree, const std::vector<double>& interior)
{
  BSplineBasis basis;
  basis.Degree = degree;
  basis.Periodic = true;
  basis.Size = static_cast<std::int64_t>(interior.size()) + 1;
  basis.Knots.resize(static_cast<std::size_t>(basis.Size + 2 * degree + 1));
  for (std::int64_t k = 0; k < static_cast<std::int64_t>(basis.Knots.size()); ++k)
  {
    const std::int64_t fromZero = k - degree;
    const auto turns = static_cast<std::int64_t>(
      std::floor(static_cast<double>(fromZero) / static_cast<double>(basis.Size)));
    const std::int64_t j = fromZero - turns * basis.Size;
    basis.Knots[static_cast<std::size_t>(k)] =
      static_cast<double>(turns) + (j == 0 ? 0.0 : interior[static_cast<std::size_t>(j - 1)]);
  }
  return basis;
}

std::vector<double> BSplineBasis::interiorKnots() const
{
  return { this->Knots.begin() + this->Degree + 1, this->Knots.end() - this->Degree - 1 };
}

std::vector<std::int64_t> BSplineBasis::spans() const
{
  std::vector<std::int64_t> all;
  const std::int64_t end = static_cast<std::int64_t>(this->Knots.size()) - this->Degree - 1;
  for (std::int64_t k = this->Degree; k < end; ++k)
  {
    if (this->Knots[static_cast<std::size_t>(k)] < this->Knots[static_cast<std::size_t>(k + 1)])
    {
      all.push_back(k);
    }
  }
  return all;
}

std::int64_t BSplineBasis::span(double t) const
{
  // Knots of the domain alone, its end left out, so that the last span is closed.
  const auto begin = this->Knots.begin() + this->Degree;
  const auto end = this->Knots.end() - this->Degree - 1;
  const auto above = t < 1 ? std::upper_bound(begin, end, t) : std::lower_bound(begin, end, 1.0);
  return std::max<std::int64_t>(above - this->Knots.begin() - 1, this->Degree);
}

void BSplineBasis::evaluate(std::int64_t k, double t, int derivatives, double* values) const
{
  // Algorithm A2.3 of Piegl and Tiller, The NURBS Book.
  const int p = this->Degree;
  const double* u = &this->Knots[static_cast<std::size_t>(k)];
  double table[MaximumOrder][MaximumOrder]; // functions above, knot differences below the diagonal
  double left[MaximumOrder], right[MaximumOrder];
  table[0][0] = 1;
  for (int j = 1; j <= p; ++j)
  {
    left[j] = t - u[1 - j];
    right[j] = u[j] - t;
    double saved = 0;
    for (int r = 0; r < j; ++r)
    {
      table[j][r] = right[r + 1] + left[j - r];
      const double share = table[r][j - 1] / table[j][r];
      table[r][j] = saved + right[r + 1] * share;
      saved = left[j - r] * share;
    }
    table[j][j] = saved;
  }
  for (int i = 0; i <= p; ++i)
  {
    values[i] = table[i][p];
  }
  for (int i = 0; i <= p; ++i)
  {
    double a[2][MaximumOrder] = { { 1 } };
    int now = 0, next = 1;
    double factor = p;
    for (int r = 1; r <= derivatives; ++r)
    {
      if (r > p)
      {
        values[r * (p + 1) + i] = 0;
        continue;
      }
      double sum = 0;
      const int low = i - r;
      if (i >= r)
      {
        a[next][0] = a[now][0] / table[p - r + 1][low];
        sum = a[next][0] * table[low][p - r];
      }
      const int first = low >= -1 ? 1 : -low;
      const int last = i - 1 <= p - r ? r - 1 : p - i;
      for (int j = first; j <= last; ++j)
      {
        a[next][j] = (a[now][j] - a[now][j - 1]) / table[p - r + 1][low + j];
        sum += a[next][j] * table[low + j][p - r];
      }
      if (i <= p - r)
      {
        a[next][r] = -a[now][r - 1] / table[p - r + 1][i];
        sum += a[next][r] * table[i][p - r];
      }
      values[r * (p + 1) + i] = factor * sum;
      factor *= p - r;
      std::swap(now, next);
    }
  }
}

double BSplineBasis::greville(std::int64_t j) const
{
  if (this->Degree == 0)
  {
    return 0;
  }
  double sum = 0;
  for (std::int64_t k = j + 1; k <= j + this->Degree; ++k)
  {
    sum += this->Knots[static_cast<std::size_t>(k)];
  }
  const double mean = sum / this->Degree;
  return this->Periodic ? mean - std::floor(mean) : mean;
}

BandMatrix BSplineBasis::gram(int r) const
{
  const int p = this->Degree;
  BandMatrix matrix(this->Size, p, this->Periodic);
  if (r > p)
  {
    return matrix;
  }
  std::vector<double> nodes, weights;
  gaussLegendre(p + 1, nodes, weights);
  std::vector<double> values(static_cast<std::size_t>((r + 1) * (p + 1)));
  const double* derivative = &values[static_cast<std::size_t>(r * (p + 1))];
  for (const std::int64_t k : this->spans())
  {
    const double begin = this->Knots[static_cast<std::size_t>(k)];
    const double half = (this->Knots[static_cast<std::size_t>(k + 1)] - begin) / 2;
    for (std::size_t q = 0; q < nodes.size(); ++q)
    {
      this->evaluate(k, begin + half * (1 + nodes[q]), r, values.data());
      for (int i = 0; i <= p; ++i)
      {
        for (int l = 0; l <= p; ++l)
        {
          matrix.at(this->index(k, i), l - i) += half * weights[q] * derivative[i] * derivative[l];
        }
      }
    }
  }
  return matrix;
}

BandMatrix BSplineBasis::collocationGram(const Vector& parameters) const
{
  const int p = this->Degree;
  BandMatrix matrix(this->Size, p, this->Periodic);
  double values[MaximumOrder];
  for (const double t : parameters)
  {
    const std::int64_t k = this->span(t);
    this->evaluate(k, t, 0, values);
    for (int i = 0; i <= p; ++i)
    {
      for (int l = 0; l <= p; ++l)
      {
        matrix.at(this->index(k, i), l - i) += values[i] * values[l];
      }
    }
  }
  return matrix;
}

BSplineBasis BSplineBasis::insertKnots(const std::vector<double>& inserted,
  Eigen::MatrixXd& transfer, std::vector<std::int64_t>& first) const
{
  const int p = this->Degree;
  std::vector<double> interior = this->interiorKnots();
  interior.insert(interior.end(), inserted.begin(), inserted.end());
  std::sort(interior.begin(), interior.end());
  BSplineBasis refined = this->Periodic ? periodic(p, interior) : clamped(p, interior);

  // New control point i is the blossom of any polynomial piece of its support, taken at the knots
  // i + 1 to i + p (Ramshaw). The middle piece of those in the domain extrapolates least.
  transfer = Eigen::MatrixXd::Zero(refined.Size, p + 1);
  first.resize(static_cast<std::size_t>(refined.Size));
  const std::int64_t domainEnd = static_cast<std::int64_t>(refined.Knots.size()) - p - 1;
  for (std::int64_t i = 0; i < refined.Size; ++i)
  {
    const double* u = &refined.Knots[static_cast<std::size_t>(i)];
    std::vector<std::int64_t> pieces;
    for (std::int64_t j = std::max<std::int64_t>(i, p); j <= std::min(i + p, domainEnd - 1); ++j)
    {
      if (u[j - i] < u[j - i + 1])
      {
        pieces.push_back(j - i);
      }
    }
    const std::int64_t piece = pieces[pieces.size() / 2];
    const std::int64_t k = this->span((u[piece] + u[piece + 1]) / 2);
    const double* old = &this->Knots[static_cast<std::size_t>(k)];
    // De Boor's recursion with another argument in each step, for each old control point's share.
    Eigen::MatrixXd share = Eigen::MatrixXd::Identity(p + 1, p + 1);
    for (int step = 1; step <= p; ++step)
    {
      for (int j = p; j >= step; --j)
      {
        const double low = old[j - p], high = old[j - step + 1];
        const double alpha = (u[step] - low) / (high - low);
        share.row(j) = (1 - alpha) * share.row(j - 1) + alpha * share.row(j);
      }
    }
    transfer.row(i) = share.row(p);
    first[static_cast<std::size_t>(i)] = k - p;
  }
  return refined;
}

void gaussLegendre(int n, std::vector<double>& nodes, std::vector<double>& weights)
{
  nodes.resize(static_cast<std::size_t>(n));
  weights.resize(nodes.size());
  for (int i = 0; i < n; ++i)
  {
    // Newton's method on the Legendre polynomial from Tricomi's estimate of its zero.
    double x = std::cos(Pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 20; ++step)
    {
      double before = 1, value = x;
      for (int k = 2; k <= n; ++k)
      {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
      }
      slope = n * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    nodes[static_cast<std::size_t>(i)] = x;
    weights[static_cast<std::size_t>(i)] = 2 / ((1 - x * x) * slope * slope);
  }
}
}
