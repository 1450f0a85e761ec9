// SPDX-License-Identifier: BSD-3-Clause
#include "AutomaticFairing.h"

#include "FairingReference.h"

namespace
{
using namespace ipia;

TEST(AutomaticFairing, SecondDifferencesOfAParabolaAndASpike)
{
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(6, 3);
  for (int k = 0; k < 6; ++k)
  {
    points(k, 0) = k * k;
  }
  EXPECT_LE(
    (secondDifferences(points, { 6, 1 }, { false, false }).array() - 2).abs().maxCoeff(), 1e-14);
  // Closed: 0 and 25 are neighbours.
  const Vector closed = secondDifferences(points, { 6, 1 }, { true, false });
  EXPECT_NEAR(closed[0], 26, 1e-13);
  EXPECT_NEAR(closed[5], 34, 1e-13);
  EXPECT_NEAR(closed[2], 2, 1e-14);

  // A spike in a flat 5 x 4 grid counts along both axes.
  Eigen::MatrixXd grid = Eigen::MatrixXd::Zero(20, 3);
  for (int k = 0; k < 20; ++k)
  {
    grid.row(k) << k % 5, k / 5, 0;
  }
  grid(7, 2) = 0.5;
  const Vector differences = secondDifferences(grid, { 5, 4 }, { false, false });
  EXPECT_NEAR(differences[7], 2, 1e-14);
  EXPECT_NEAR(differences[8], 0.5, 1e-14);
  EXPECT_EQ(differences[19], 0);
}

TEST(AutomaticFairing, CurvatureVariationIsLargestAtADent)
{
  for (const bool closed : { false, true })
  {
    ipia::test::FairingProblem problem = ipia::test::curveProblem(3, 2, closed, 120, 40);
    for (int k = 0; k < 120; ++k)
    {
      const double a = (closed ? 2 * ipia::test::Pi / 120 : ipia::test::Pi / 119) * k;
      problem.Data.Points.row(k) << std::cos(a), std::sin(a), 0;
    }
    problem.Data.Points.row(60) *= 0.97;
    problem.Data.Parameters[0] =
      parametrize(problem.Data.Points, ParametrizationType::Uniform, closed);
    problem.Start.Axes[0] = averagedKnots(problem.Data.Parameters[0], 3, 40, closed);
    FairingOptions options;
    options.Solver = FairingSolver::SparseDirect;
    problem.Weights.setConstant(1e-12);
    TensorSpline spline;
    problem.solve(options, spline);
    const Vector variation = curvatureVariation(spline);
    Eigen::Index largest = 0;
    variation.maxCoeff(&largest);
    EXPECT_NEAR(spline.Axes[0].greville(largest), problem.Data.Parameters[0][60], 0.06);
    EXPECT_GT(variation.maxCoeff(), 10 * variation[10]);
  }
}

/// Of the circle, the cylinder and the sphere the curvature does not change; of a paraboloid it
/// does.
TEST(AutomaticFairing, CurvatureVariationOfSurfaces)
{
  const BSplineBasis axis = BSplineBasis::clamped(2, {});
  TensorSpline spline;
  spline.Axes = { axis, axis };
  spline.ControlPoints.resize(9, 3);
  const double x[3] = { -1, 0, 1 }, squared[3] = { 1, -1, 1 };
  for (int j = 0; j < 9; ++j)
  {
    spline.ControlPoints.row(j) << x[j % 3], x[j / 3], 0;
  }
  EXPECT_LE(curvatureVariation(spline).maxCoeff(), 1e-12);
  for (int j = 0; j < 9; ++j)
  {
    spline.ControlPoints(j, 2) = squared[j % 3];
  }
  EXPECT_GT(curvatureVariation(spline).minCoeff(), 0.1);
}

TEST(AutomaticFairing, RaisesTheShareWithTheLargestMeasure)
{
  Vector measure(5);
  measure << 1, 5, 3, 5, 0;
  Vector expected(5);
  expected << 0, 0.5, 0, 0.5, 0;
  EXPECT_EQ(raiseLargest(measure, 0.4, 0, 0.5), expected);
  EXPECT_EQ(raiseLargest(measure, 0.2, 0, 0.5), Vector(0.5 * Vector::Unit(5, 1)));
  EXPECT_EQ(raiseLargest(measure, 0, 0.1, 0.5), Vector(Vector::Constant(5, 0.1)));
  EXPECT_EQ(raiseLargest(measure, 1, 0.1, 0.5), Vector(Vector::Constant(5, 0.5)));
}
}
