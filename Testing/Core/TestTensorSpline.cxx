// SPDX-License-Identifier: BSD-3-Clause
#include "TensorSpline.h"

#include "FairingReference.h"

namespace
{
using namespace ipia;

TensorSpline randomSpline(const BSplineBasis& u, const BSplineBasis& v)
{
  TensorSpline spline;
  spline.Axes = { u, v };
  spline.ControlPoints.resize(spline.size(), 3);
  ipia::test::Random random(23);
  for (double& x : spline.ControlPoints.reshaped())
  {
    x = random.uniform(-1, 1);
  }
  return spline;
}

TEST(TensorSpline, KnotInsertionLeavesTheCurveAsItIs)
{
  const std::vector<double> knots = { 0.1, 0.3, 0.35, 0.6, 0.8, 0.9 };
  for (int degree = 1; degree <= BSplineBasis::MaximumDegree; ++degree)
  {
    for (const bool closed : { false, true })
    {
      const TensorSpline before = randomSpline(
        closed ? BSplineBasis::periodic(degree, knots) : BSplineBasis::clamped(degree, knots), {});
      // New ones, two at once, near the ends, and existing ones as often as the degree allows.
      std::vector<double> inserted = { 0.02, 0.31, 0.32, 0.7, 0.98 };
      inserted.insert(inserted.end(), static_cast<std::size_t>(degree - 1), 0.6);
      TensorSpline after = before;
      Eigen::MatrixXd attached = Eigen::MatrixXd::Constant(before.size(), 1, 0.25);
      after.insertKnots(0, inserted, attached);
      EXPECT_EQ(after.size(), before.size() + static_cast<std::int64_t>(inserted.size()));
      EXPECT_LE((attached.array() - 0.25).abs().maxCoeff(), 1e-14);
      for (int k = 0; k <= 1000; ++k)
      {
        EXPECT_LE((after.value(k / 1000.0) - before.value(k / 1000.0)).norm(), 1e-12)
          << "degree " << degree << ", closed " << closed << ", u " << k / 1000.0;
      }
    }
  }
}

TEST(TensorSpline, KnotInsertionLeavesTheSurfaceAsItIs)
{
  const TensorSpline before = randomSpline(
    BSplineBasis::clamped(3, { 0.2, 0.5 }), BSplineBasis::periodic(2, { 0.3, 0.4, 0.8 }));
  for (const int axis : { 0, 1 })
  {
    TensorSpline after = before;
    Eigen::MatrixXd none;
    after.insertKnots(axis, { 0.25, 0.45, 0.9 }, none);
    for (int k = 0; k <= 400; ++k)
    {
      const double u = (k % 21) / 20.0, v = (k / 21) / 20.0;
      EXPECT_LE((after.value(u, v) - before.value(u, v)).norm(), 1e-12);
    }
  }
}

TEST(TensorSpline, DerivativesAreDifferenceQuotients)
{
  const TensorSpline spline =
    randomSpline(BSplineBasis::clamped(4, { 0.2, 0.5 }), BSplineBasis::clamped(3, { 0.6 }));
  const double u = 0.37, v = 0.41, h = 1e-4;
  Eigen::Matrix3Xd d;
  spline.evaluate(u, v, 2, d);
  const auto at = [&](double a, double b) { return spline.value(u + a * h, v + b * h); };
  EXPECT_LE((d.col(0) - at(0, 0)).norm(), 1e-15);
  EXPECT_LE((d.col(1) - (at(1, 0) - at(-1, 0)) / (2 * h)).norm(), 1e-5);
  EXPECT_LE((d.col(2) - (at(1, 0) - 2 * at(0, 0) + at(-1, 0)) / (h * h)).norm(), 1e-4);
  EXPECT_LE((d.col(3) - (at(0, 1) - at(0, -1)) / (2 * h)).norm(), 1e-5);
  EXPECT_LE(
    (d.col(4) - (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * h * h)).norm(), 1e-4);
  EXPECT_LE((d.col(6) - (at(0, 1) - 2 * at(0, 0) + at(0, -1)) / (h * h)).norm(), 1e-4);
}

/// Least squares without fairing of points on a known curve.
TensorSpline fittedCurve(const std::function<Eigen::Vector3d(double)>& curve, bool closed)
{
  constexpr std::int64_t m = 400, n = 80;
  ipia::test::FairingProblem problem = ipia::test::curveProblem(5, 2, closed, m, n);
  for (std::int64_t k = 0; k < m; ++k)
  {
    problem.Data.Points.row(k) =
      curve(static_cast<double>(k) / static_cast<double>(closed ? m : m - 1)).transpose();
  }
  problem.Data.Parameters[0] = parametrize(problem.Data.Points, ParametrizationType::Chord, closed);
  problem.Start.Axes[0] = averagedKnots(problem.Data.Parameters[0], 5, n, closed);
  problem.Weights.setZero();
  FairingOptions options;
  options.Solver = FairingSolver::SparseDirect;
  TensorSpline spline;
  EXPECT_EQ(problem.solve(options, spline).Status, FairingStatus::Converged);
  return spline;
}

TEST(TensorSpline, CurvatureOfACircle)
{
  const auto circle = [](double t)
  {
    const double a = 2 * ipia::test::Pi * t;
    return Eigen::Vector3d(2 * std::cos(a), 2 * std::sin(a), 1);
  };
  const TensorSpline spline = fittedCurve(circle, true);
  for (int k = 0; k <= 1000; ++k)
  {
    const CurvePoint point = curvePoint(spline, k / 1000.0);
    EXPECT_NEAR(point.Curvature, 0.5, 1e-5);
    EXPECT_NEAR(point.Torsion, 0, 1e-5);
    const Eigen::Vector3d inwards = Eigen::Vector3d(0, 0, 1) - point.Position;
    EXPECT_LE((point.CurvatureNormal - inwards / 4).norm(), 1e-5);
  }
}

TEST(TensorSpline, CurvatureAndTorsionOfAHelix)
{
  // Radius a = 1, pitch 2 pi b with b = 0.3: a / (a^2 + b^2) and b / (a^2 + b^2).
  const auto helix = [](double t)
  { return Eigen::Vector3d(std::cos(9 * t), std::sin(9 * t), 0.3 * 9 * t); };
  const TensorSpline spline = fittedCurve(helix, false);
  for (int k = 50; k <= 950; ++k)
  {
    const CurvePoint point = curvePoint(spline, k / 1000.0);
    EXPECT_NEAR(point.Curvature, 1 / 1.09, 1e-4);
    EXPECT_NEAR(point.Torsion, 0.3 / 1.09, 1e-3);
  }
}

TEST(TensorSpline, CurvatureOfAStraightLineAndAPoint)
{
  TensorSpline spline;
  spline.Axes[0] = BSplineBasis::clamped(3, {});
  spline.ControlPoints.resize(4, 3);
  spline.ControlPoints << 0, 0, 0, 1, 2, 3, 2, 4, 6, 3, 6, 9;
  const CurvePoint point = curvePoint(spline, 0.3);
  EXPECT_NEAR(point.Curvature, 0, 1e-14);
  EXPECT_EQ(point.Torsion, 0);
  spline.ControlPoints.setZero();
  EXPECT_EQ(curvePoint(spline, 0.3).Curvature, 0);
  EXPECT_EQ(curvePoint(spline, 0.3).Tangent.norm(), 0);
}

/// The saddle z = (x^2 - y^2) / 2 and the bowl z = -(x^2 + y^2) / 2, exact as bicubic splines.
TEST(TensorSpline, CurvaturesOfQuadrics)
{
  const BSplineBasis axis = BSplineBasis::clamped(2, {});
  for (const double sign : { -1.0, 1.0 })
  {
    TensorSpline spline;
    spline.Axes = { axis, axis };
    spline.ControlPoints.resize(9, 3);
    // Control points of u^2 are 0, 0, 1; the domain is x = 2 u - 1, so x^2 has 1, -1, 1.
    const double x[3] = { -1, 0, 1 }, squared[3] = { 1, -1, 1 };
    for (int j = 0; j < 9; ++j)
    {
      spline.ControlPoints.row(j) << x[j % 3], x[j / 3],
        -(squared[j % 3] + sign * squared[j / 3]) / 2;
    }
    const SurfacePoint point = surfacePoint(spline, 0.5, 0.5);
    EXPECT_LE((point.Normal - Eigen::Vector3d(0, 0, 1)).norm(), 1e-14);
    EXPECT_NEAR(point.MeanCurvature, (1 + sign) / 2, 1e-14);
    EXPECT_NEAR(point.GaussCurvature, sign, 1e-14);
  }
}
}
