// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * B-spline curves and tensor-product surfaces: values, derivatives, knots, curvature.
 */
#ifndef ipia_TensorSpline_h
#define ipia_TensorSpline_h

#include "BSplineBasis.h"

#include <array>

namespace ipia
{
/**
 * P(u, v) = sum_jl N_j(u) N_l(v) P_jl in space. A curve has the constant basis on its second axis,
 * which is that of a BSplineBasis made by default, and v = 0.
 */
struct TensorSpline
{
  std::array<BSplineBasis, 2> Axes;
  /// #control points by 3 coordinates, those along u fastest.
  Eigen::MatrixXd ControlPoints;

  std::int64_t size() const { return this->Axes[0].size() * this->Axes[1].size(); }

  /**
   * The derivatives d^(a + b) P / du^a dv^b for a, b <= @a order, of a point (u, v) in [0, 1]^2.
   * @param result  3 by (order + 1)^2, column a + (order + 1) b
   */
  void evaluate(double u, double v, int order, Eigen::Matrix3Xd& result) const;

  Eigen::Vector3d value(double u, double v = 0) const;

  /**
   * The same function on more knots.
   * @param axis      0 or 1
   * @param inserted  in (0, 1); no knot may become more than degree-fold
   * @param attached  values per control point that go along as coordinates do, size() by any
   */
  void insertKnots(int axis, const std::vector<double>& inserted, Eigen::MatrixXd& attached);
};

/// What a curve is like at a parameter.
struct CurvePoint
{
  Eigen::Vector3d Position, Tangent; ///< tangent of length 1
  double Curvature = 0;              ///< |P' x P''| / |P'|^3, >= 0
  double Torsion = 0; ///< det(P', P'', P''') / |P' x P''|^2, 0 where the curve is straight
  /// Curvature times the principal normal: points to the centre of curvature, length Curvature.
  Eigen::Vector3d CurvatureNormal;
};

/// Where P' = 0, or so small that curvature leaves the range of double, all but the position are 0.
CurvePoint curvePoint(const TensorSpline& curve, double u);

/// What a surface is like at a pair of parameters.
struct SurfacePoint
{
  Eigen::Vector3d Position;
  Eigen::Vector3d Normal; ///< P_u x P_v, of length 1
  /// (k1 + k2) / 2, > 0 where the surface bends away from the normal, as a sphere with normals that
  /// point outwards; the convention of vtkCurvatures.
  double MeanCurvature = 0;
  double GaussCurvature = 0; ///< k1 k2
};

/// Where P_u and P_v are parallel, such as at a pole, or so small that curvature leaves the range
/// of double, all but the position are 0.
SurfacePoint surfacePoint(const TensorSpline& surface, double u, double v);
}

#endif
