// SPDX-License-Identifier: BSD-3-Clause
#include "AutomaticFairing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ipia
{
namespace
{
/// Samples per knot span at which curvature is taken.
constexpr int SamplesPerSpan = 8;

/// Parameters in the middle of equal parts of every span that is not empty.
Vector sampleParameters(const BSplineBasis& basis)
{
  if (basis.degree() == 0)
  {
    return Vector::Zero(1);
  }
  const std::vector<std::int64_t> spans = basis.spans();
  Vector parameters(static_cast<Eigen::Index>(spans.size()) * SamplesPerSpan);
  Eigen::Index k = 0;
  for (const std::int64_t span : spans)
  {
    const double begin = basis.knots()[static_cast<std::size_t>(span)];
    const double end = basis.knots()[static_cast<std::size_t>(span + 1)];
    for (int i = 0; i < SamplesPerSpan; ++i)
    {
      parameters[k++] = begin + (end - begin) * (i + 0.5) / SamplesPerSpan;
    }
  }
  return parameters;
}
}

Vector secondDifferences(const Eigen::MatrixXd& points, const std::array<std::int64_t, 2>& size,
  const std::array<bool, 2>& closed)
{
  Vector differences = Vector::Zero(points.rows());
  for (std::size_t axis = 0; axis < 2; ++axis)
  {
    const std::int64_t n = size[axis], lines = size[1 - axis];
    const std::int64_t stride = axis == 0 ? 1 : size[0], between = axis == 0 ? size[0] : 1;
    for (std::int64_t line = 0; n >= 3 && line < lines; ++line)
    {
      for (std::int64_t i = 0; i < n; ++i)
      {
        const std::int64_t middle = closed[axis] ? i : std::clamp<std::int64_t>(i, 1, n - 2);
        const auto row = [&](std::int64_t k)
        { return points.row(line * between + (k + n) % n * stride); };
        differences[line * between + i * stride] +=
          (row(middle - 1) - 2 * row(middle) + row(middle + 1)).norm();
      }
    }
  }
  return differences;
}

Vector curvatureVariation(const TensorSpline& spline)
{
  FairingData samples;
  const bool curve = spline.Axes[1].degree() == 0;
  samples.Parameters = { sampleParameters(spline.Axes[0]), sampleParameters(spline.Axes[1]) };
  const std::int64_t size[2] = { samples.Parameters[0].size(), samples.Parameters[1].size() };
  std::vector<double> curvature(static_cast<std::size_t>(size[0] * size[1]));
  Eigen::Matrix3Xd position(3, size[0] * size[1]);
  for (std::int64_t k = 0; k < size[0] * size[1]; ++k)
  {
    const double u = samples.Parameters[0][k % size[0]], v = samples.Parameters[1][k / size[0]];
    if (curve)
    {
      const CurvePoint point = curvePoint(spline, u);
      curvature[static_cast<std::size_t>(k)] = point.Curvature;
      position.col(k) = point.Position;
    }
    else
    {
      const SurfacePoint point = surfacePoint(spline, u, v);
      curvature[static_cast<std::size_t>(k)] = point.MeanCurvature;
      position.col(k) = point.Position;
    }
  }
  Vector squared = Vector::Zero(size[0] * size[1]);
  for (std::size_t axis = 0; axis < 2; ++axis)
  {
    const bool closed = spline.Axes[axis].isPeriodic();
    const std::int64_t n = size[axis], stride = axis == 0 ? 1 : size[0];
    for (std::int64_t k = 0; n >= 3 && k < squared.size(); ++k)
    {
      const std::int64_t i = axis == 0 ? k % size[0] : k / size[0];
      const std::int64_t low = i > 0 ? i - 1 : closed ? n - 1 : 0;
      const std::int64_t high = i + 1 < n ? i + 1 : closed ? 0 : n - 1;
      const std::int64_t from = k + (low - i) * stride, to = k + (high - i) * stride;
      const double length =
        (position.col(to) - position.col(k)).norm() + (position.col(k) - position.col(from)).norm();
      if (length > 0)
      {
        const double slope =
          (curvature[static_cast<std::size_t>(to)] - curvature[static_cast<std::size_t>(from)]) /
          length;
        squared[k] += slope * slope;
      }
    }
  }
  return carryToControlPoints(spline.Axes, samples, squared, 0).cwiseSqrt();
}

Vector raiseLargest(const Vector& measure, double share, double base, double raised)
{
  const Eigen::Index n = measure.size();
  std::vector<Eigen::Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&](Eigen::Index a, Eigen::Index b) { return measure[a] > measure[b]; });
  const auto count = static_cast<std::size_t>(std::llround(share * static_cast<double>(n)));
  Vector weights = Vector::Constant(n, base);
  for (std::size_t k = 0; k < std::min(count, order.size()); ++k)
  {
    weights[order[k]] = raised;
  }
  return weights;
}
}
