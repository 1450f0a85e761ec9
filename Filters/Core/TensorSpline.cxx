// SPDX-License-Identifier: BSD-3-Clause
#include "TensorSpline.h"

#include <Eigen/Geometry>

#include <cmath>

namespace ipia
{
namespace
{
constexpr int MaximumOrder = BSplineBasis::MaximumDegree + 1;
constexpr int MaximumDerivative = 3;

/// A cross product below this share of what its factors allow is rounding.
constexpr double Parallel = 1e-12;
}

void TensorSpline::evaluate(double u, double v, int order, Eigen::Matrix3Xd& result) const
{
  double values[2][MaximumOrder * (MaximumDerivative + 1)];
  const std::int64_t span[2] = { this->Axes[0].span(u), this->Axes[1].span(v) };
  this->Axes[0].evaluate(span[0], u, order, values[0]);
  this->Axes[1].evaluate(span[1], v, order, values[1]);
  const int columns = this->Axes[0].degree() + 1, rows = this->Axes[1].degree() + 1;
  result.setZero(3, (order + 1) * (order + 1));
  for (int l = 0; l < rows; ++l)
  {
    const std::int64_t row = this->Axes[1].index(span[1], l) * this->Axes[0].size();
    Eigen::Matrix<double, 3, MaximumDerivative + 1> along;
    along.setZero();
    for (int j = 0; j < columns; ++j)
    {
      const Eigen::Vector3d p =
        this->ControlPoints.row(row + this->Axes[0].index(span[0], j)).transpose();
      for (int a = 0; a <= order; ++a)
      {
        along.col(a) += values[0][a * columns + j] * p;
      }
    }
    for (int b = 0; b <= order; ++b)
    {
      for (int a = 0; a <= order; ++a)
      {
        result.col(a + (order + 1) * b) += values[1][b * rows + l] * along.col(a);
      }
    }
  }
}

Eigen::Vector3d TensorSpline::value(double u, double v) const
{
  Eigen::Matrix3Xd result;
  this->evaluate(u, v, 0, result);
  return result.col(0);
}

void TensorSpline::insertKnots(
  int axis, const std::vector<double>& inserted, Eigen::MatrixXd& attached)
{
  Eigen::MatrixXd transfer;
  std::vector<std::int64_t> first;
  const auto a = static_cast<std::size_t>(axis);
  const BSplineBasis old = this->Axes[a];
  this->Axes[a] = old.insertKnots(inserted, transfer, first);
  const std::int64_t across = this->Axes[1 - a].size();
  const auto refine = [&](Eigen::MatrixXd& values)
  {
    Eigen::MatrixXd refined = Eigen::MatrixXd::Zero(this->size(), values.cols());
    const std::int64_t strideOld = axis == 0 ? 1 : across, lineOld = axis == 0 ? old.size() : 1;
    const std::int64_t lineNew = axis == 0 ? this->Axes[a].size() : 1;
    for (std::int64_t l = 0; l < across; ++l)
    {
      for (std::int64_t i = 0; i < this->Axes[a].size(); ++i)
      {
        for (int c = 0; c <= old.degree(); ++c)
        {
          const std::int64_t j = (first[static_cast<std::size_t>(i)] + c) % old.size();
          refined.row(l * lineNew + i * strideOld) +=
            transfer(i, c) * values.row(l * lineOld + j * strideOld);
        }
      }
    }
    values = std::move(refined);
  };
  refine(this->ControlPoints);
  if (attached.rows() > 0)
  {
    refine(attached);
  }
}

CurvePoint curvePoint(const TensorSpline& curve, double u)
{
  Eigen::Matrix3Xd d;
  curve.evaluate(u, 0, 3, d);
  CurvePoint point;
  point.Position = d.col(0);
  point.Tangent.setZero();
  point.CurvatureNormal.setZero();
  const Eigen::Vector3d first = d.col(1), second = d.col(2), third = d.col(3);
  const double speed = first.norm();
  if (!(speed > 0))
  {
    return point;
  }
  // Divided by the speed at once: its powers leave the range of double long before curvature does.
  const Eigen::Vector3d tangent = first / speed;
  const Eigen::Vector3d along = second / speed;
  const Eigen::Vector3d turn = tangent.cross(along);
  const Eigen::Vector3d binormal = turn / speed; // times the curvature
  const double curvature = binormal.norm();
  double torsion = 0;
  if (turn.norm() > Parallel * along.norm())
  {
    const Eigen::Vector3d rise = third / speed / speed / speed;
    torsion = (binormal / curvature).dot(rise) / curvature;
  }
  if (std::isfinite(curvature) && std::isfinite(torsion))
  {
    point.Tangent = tangent;
    point.Curvature = curvature;
    point.Torsion = torsion;
    point.CurvatureNormal = binormal.cross(tangent);
  }
  return point;
}

SurfacePoint surfacePoint(const TensorSpline& surface, double u, double v)
{
  Eigen::Matrix3Xd d;
  surface.evaluate(u, v, 2, d);
  SurfacePoint point;
  point.Position = d.col(0);
  point.Normal.setZero();
  const double a = d.col(1).norm(), b = d.col(3).norm();
  if (!(a > 0 && b > 0))
  {
    return point;
  }
  // Divided by the lengths at once, as above.
  const Eigen::Vector3d du = d.col(1) / a, dv = d.col(3) / b;
  const Eigen::Vector3d cross = du.cross(dv);
  const double area = cross.norm();
  if (area > Parallel)
  {
    const Eigen::Vector3d normal = cross / area;
    const double f = du.dot(dv);
    const double l = d.col(2).dot(normal) / a / a, m = d.col(4).dot(normal) / a / b;
    const double n = d.col(6).dot(normal) / b / b;
    const double mean = -(n - 2 * f * m + l) / (2 * area * area);
    const double gauss = (l * n - m * m) / (area * area);
    if (std::isfinite(mean) && std::isfinite(gauss))
    {
      point.Normal = normal;
      point.MeanCurvature = mean;
      point.GaussCurvature = gauss;
    }
  }
  return point;
}
}
