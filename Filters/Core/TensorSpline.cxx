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
  if (speed > 0)
  {
    point.Tangent = first / speed;
    const Eigen::Vector3d binormal = first.cross(second);
    point.Curvature = binormal.norm() / (speed * speed * speed);
    point.CurvatureNormal = binormal.cross(first) / std::pow(speed, 4);
    if (binormal.norm() > Parallel * speed * second.norm())
    {
      point.Torsion = binormal.dot(third) / binormal.squaredNorm();
    }
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
  const Eigen::Vector3d du = d.col(1), duu = d.col(2), dv = d.col(3), duv = d.col(4),
                        dvv = d.col(6);
  const Eigen::Vector3d cross = du.cross(dv);
  const double area = cross.norm();
  if (area > Parallel * du.norm() * dv.norm())
  {
    point.Normal = cross / area;
    const double e = du.dot(du), f = du.dot(dv), g = dv.dot(dv);
    const double l = duu.dot(point.Normal), m = duv.dot(point.Normal), n = dvv.dot(point.Normal);
    point.MeanCurvature = -(e * n - 2 * f * m + g * l) / (2 * area * area);
    point.GaussCurvature = (l * n - m * m) / (area * area);
  }
  return point;
}
}
