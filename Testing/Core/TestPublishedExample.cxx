// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Example 1 of "Implicit Uniform Rational Spline Reconstruction" (Huang et al., 2024) with its
 * B-spline basis: Table 1 has E_max = 2.1919e-03 and E_ave = 1.2682e-06 after 200 iterations.
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

constexpr double PublishedMaximumError = 2.1919e-03;
constexpr double PublishedAverageError = 1.2682e-06;

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

FitResult<2> fitOn(const Box<2>& domain, const ipia::test::OrientedPoints<2>& points)
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
  options.Solver.MaximumNumberOfIterations = 200;
  options.FarField.Threshold = 0;
  return fitImplicit(lattice.Grid, input, options);
}

void expectPublishedErrors(const FitResult<2>& result)
{
  EXPECT_EQ(result.Solver.NumberOfIterations, 200);
  EXPECT_LE(result.MaximumError, 1.5 * PublishedMaximumError);
  EXPECT_GE(result.MaximumError, PublishedMaximumError / 1.5);
  EXPECT_LE(result.AverageError, 1.5 * PublishedAverageError);
  EXPECT_GE(result.AverageError, PublishedAverageError / 1.5);
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
  expectPublishedErrors(fitOn(enlarged(points.Positions, 0.1 * longest), points));
  expectPublishedErrors(fitOn(enlarged(points.Positions, 1), points));
}

TEST(PublishedExample, TheOrientationOfTheNormalsMatchesOnlyTheSign)
{
  const ipia::test::OrientedPoints<2> points = curve();
  ipia::test::OrientedPoints<2> flipped = points;
  flipped.Normals *= -1;
  const Box<2> domain = enlarged(points.Positions, 1);
  const FitResult<2> outward = fitOn(domain, points), inward = fitOn(domain, flipped);
  expectPublishedErrors(inward);
  EXPECT_LE(ipia::test::relativeDifference(
              inward.Function.coefficients(), -outward.Function.coefficients()),
    1e-12);
}
}
