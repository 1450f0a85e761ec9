// SPDX-License-Identifier: BSD-3-Clause
#include "Parametrization.h"

#include <cmath>

namespace ipia
{
namespace
{
double step(double distance, ParametrizationType type)
{
  return type == ParametrizationType::Uniform ? 1.0
    : type == ParametrizationType::Chord      ? distance
                                              : std::sqrt(distance);
}

/// Running sums of the steps, scaled so that all of them end at 1; all 0 if the steps are.
Vector fromSteps(const Vector& steps, bool closed)
{
  const Eigen::Index m = closed ? steps.size() : steps.size() + 1;
  Vector parameters = Vector::Zero(m);
  double sum = 0;
  for (Eigen::Index k = 0; k + 1 < m; ++k)
  {
    sum += steps[k];
    parameters[k + 1] = sum;
  }
  const double total = closed ? sum + steps[m - 1] : sum;
  if (total > 0)
  {
    parameters /= total;
    if (!closed)
    {
      parameters[m - 1] = 1;
    }
  }
  return parameters;
}
}

Vector parametrize(const Eigen::MatrixXd& points, ParametrizationType type, bool closed)
{
  const Eigen::Index m = points.rows();
  Vector steps(closed ? m : m - 1);
  for (Eigen::Index k = 0; k < steps.size(); ++k)
  {
    steps[k] = step((points.row((k + 1) % m) - points.row(k)).norm(), type);
  }
  return fromSteps(steps, closed);
}

Vector parametrizeGrid(const Eigen::MatrixXd& points, std::int64_t rows, std::int64_t columns,
  int axis, ParametrizationType type, bool closed)
{
  const std::int64_t along = axis == 0 ? rows : columns, lines = axis == 0 ? columns : rows;
  const std::int64_t stride = axis == 0 ? 1 : rows, between = axis == 0 ? rows : 1;
  Vector sum = Vector::Zero(along);
  double counted = 0;
  Eigen::MatrixXd line(along, points.cols());
  for (std::int64_t l = 0; l < lines; ++l)
  {
    for (std::int64_t k = 0; k < along; ++k)
    {
      line.row(k) = points.row(l * between + k * stride);
    }
    const Vector parameters = parametrize(line, type, closed);
    if (parameters[along - 1] > 0)
    {
      sum += parameters;
      counted += 1;
    }
  }
  if (counted > 0)
  {
    sum /= counted;
    if (!closed)
    {
      sum[along - 1] = 1;
    }
  }
  return sum;
}

BSplineBasis averagedKnots(const Vector& parameters, int degree, std::int64_t n, bool closed)
{
  const Eigen::Index m = parameters.size();
  const std::int64_t spans = closed ? n : n - degree;
  const double d = static_cast<double>(m) / static_cast<double>(spans);
  std::vector<double> interior;
  for (std::int64_t j = 1; j < spans; ++j)
  {
    const double position = static_cast<double>(j) * d;
    const auto i = static_cast<Eigen::Index>(position);
    const double alpha = position - static_cast<double>(i);
    const double low = closed ? parameters[i] : parameters[i - 1];
    const double high = !closed ? parameters[i] : i + 1 < m ? parameters[i + 1] : 1.0;
    const double knot = (1 - alpha) * low + alpha * high;
    const bool same =
      !interior.empty() && std::abs(knot - interior.back()) < BSplineBasis::SmallestSpan;
    interior.push_back(same ? interior.back() : knot);
  }
  return closed ? BSplineBasis::periodic(degree, interior)
                : BSplineBasis::clamped(degree, interior);
}

BSplineBasis uniformKnots(int degree, std::int64_t n, bool closed)
{
  const std::int64_t spans = closed ? n : n - degree;
  std::vector<double> interior;
  for (std::int64_t j = 1; j < spans; ++j)
  {
    interior.push_back(static_cast<double>(j) / static_cast<double>(spans));
  }
  return closed ? BSplineBasis::periodic(degree, interior)
                : BSplineBasis::clamped(degree, interior);
}

std::vector<std::int64_t> initialPoints(const BSplineBasis& basis, std::int64_t m)
{
  const std::int64_t n = basis.size();
  std::vector<std::int64_t> points(static_cast<std::size_t>(n), 0);
  for (std::int64_t j = 0; j < n; ++j)
  {
    auto& point = points[static_cast<std::size_t>(j)];
    if (basis.isPeriodic())
    {
      const double centre = static_cast<double>(j) - (basis.degree() - 1) / 2.0;
      const auto k = static_cast<std::int64_t>(
        std::floor(static_cast<double>(m) * centre / static_cast<double>(n)));
      point = ((k % m) + m) % m;
    }
    else if (j > 0)
    {
      point = j + 1 == n ? m - 1 : std::max<std::int64_t>(m * (j + 1) / n - 1, 0);
    }
  }
  return points;
}
}
