// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Example 1 of "Implicit Uniform Rational Spline Reconstruction" (Huang et al., 2024): Table 1 has
 * E_max = 2.1919e-03 and E_ave = 1.2682e-06 after 200 iterations with the B-spline basis, and
 * 2.3667e-03 and 8.4608e-07 with the rational one. Its E cannot be reproduced: the sum of squared
 * residuals is 0.012 on this domain, for either basis, where the paper has 9.4e-04 and 1.6e-03.
 *
 * The paper does not say on which domain. The data box [-4, 4] x [-8, 0.45], enlarged on all sides
 * by a tenth of its longest side, or by 1, gives both figures within a factor of 1.25. Margins from
 * about 0.06 to 0.16 of the longest side keep them within 1.5; much smaller and larger ones do not.
 */
#include "ImplicitFit.h"

#include "AutomaticLattice.h"
#include "TestSupport.h"

namespace
{
using namespace ipia;

struct PublishedErrors
{
  double Maximum, Average;
};
constexpr PublishedErrors Published = { 2.1919e-03, 1.2682e-06 };
constexpr PublishedErrors PublishedRational = { 2.3667e-03, 8.4608e-07 };

/// x = 4 cos t, y = sin t (3 - 5 sin t) at 120 uniform parameters, with its exact unit normals.
ipia::test::OrientedPoints<2> curve()
{
  constexpr int n = 120;
  ipia::test::OrientedPoints<2> points{ Points<2>(2, n), Points<2>(2, n) };
  for (int k = 0; k < n; ++k)
  {
    const double t = 2 * ipia::test::Pi * k / n, s = std::sin(t), c = std::cos(t);
    points.Positions.col(k) << 4 * c, s * (3 - 5 * s);
    points.Normals.col(k) = Point<2>(3 * c - 10 * s * c, 4 * s).normalized();
  }
  return points;
}

FitResult<2> fitOn(const Box<2>& domain, const ipia::test::OrientedPoints<2>& points,
  Basis basis = Basis::BSpline, double tau = 1e-2, int iterations = 200)
{
  const PlacedLattice<2> lattice = latticeOn<2>(domain, { 9, 9 }, 1);
  FitInput<2> input;
  input.Positions = points.Positions.colwise() - lattice.Lower;
  input.Normals = points.Normals;
  input.OutwardDistance = Vector::Constant(points.Positions.cols(), 0.1);
  input.InwardDistance = input.OutwardDistance;
  input.OutwardValue = input.InwardValue = 0.01;
  FitOptions options;
  options.Solver.Type = SolverType::ProgressiveIteration;
  options.Solver.MaximumNumberOfIterations = iterations;
  options.Type = basis;
  options.Rational.WeightStepSize = tau;
  options.FarField.Threshold = 0;
  return fitImplicit(lattice.Grid, input, options);
}

void expectErrors(const FitResult<2>& result, const PublishedErrors& published)
{
  EXPECT_EQ(result.Solver.NumberOfIterations, 200);
  EXPECT_LE(result.MaximumError, 1.5 * published.Maximum);
  EXPECT_GE(result.MaximumError, published.Maximum / 1.5);
  EXPECT_LE(result.AverageError, 1.5 * published.Average);
  EXPECT_GE(result.AverageError, published.Average / 1.5);
}

Box<2> enlarged(const Points<2>& points, double margin)
{
  return { (points.rowwise().minCoeff().array() - margin).matrix(),
    (points.rowwise().maxCoeff().array() + margin).matrix() };
}

TEST(PublishedExample, Example1HasThePublishedErrors)
{
  const ipia::test::OrientedPoints<2> points = curve();
  const double longest =
    (points.Positions.rowwise().maxCoeff() - points.Positions.rowwise().minCoeff()).maxCoeff();
  expectErrors(fitOn(enlarged(points.Positions, 0.1 * longest), points), Published);
  expectErrors(fitOn(enlarged(points.Positions, 1), points), Published);
}

TEST(PublishedExample, Example1HasThePublishedErrorsOfTheRationalSpline)
{
  const ipia::test::OrientedPoints<2> points = curve();
  const double longest =
    (points.Positions.rowwise().maxCoeff() - points.Positions.rowwise().minCoeff()).maxCoeff();
  const Box<2> domain = enlarged(points.Positions, 0.1 * longest);
  const FitResult<2> result = fitOn(domain, points, Basis::UniformRational);
  expectErrors(result, PublishedRational);
  // With this tau the weights hardly move, and the gain is as small.
  const FitResult<2> spline = fitOn(domain, points);
  EXPECT_LT((result.Function.weights().array() - 1).abs().maxCoeff(), 1e-3);
  EXPECT_NEAR(result.Solver.Energy, spline.Solver.Energy, 2e-3 * spline.Solver.Energy);
  EXPECT_LT(result.Solver.Energy, spline.Solver.Energy);
}

/// tau counts in units of 1 / f^2: it makes a difference from about 1 / OffsetValue^2 / 100 on.
TEST(PublishedExample, ALargerStepOfTheWeightsFitsBetter)
{
  const ipia::test::OrientedPoints<2> points = curve();
  const Box<2> domain = enlarged(points.Positions, 1);
  const double spline = fitOn(domain, points).Solver.Energy;
  const FitResult<2> result = fitOn(domain, points, Basis::UniformRational, 100);
  EXPECT_LT(result.Solver.Energy, 0.5 * spline);
  EXPECT_GT((result.Function.weights().array() - 1).abs().maxCoeff(), 0.1);
}

TEST(PublishedExample, TheOrientationOfTheNormalsMatchesOnlyTheSign)
{
  const ipia::test::OrientedPoints<2> points = curve();
  ipia::test::OrientedPoints<2> flipped = points;
  flipped.Normals *= -1;
  const Box<2> domain = enlarged(points.Positions, 1);
  const FitResult<2> outward = fitOn(domain, points), inward = fitOn(domain, flipped);
  expectErrors(inward, Published);
  EXPECT_LE(ipia::test::relativeDifference(
              inward.Function.coefficients(), -outward.Function.coefficients()),
    1e-12);
}
}
