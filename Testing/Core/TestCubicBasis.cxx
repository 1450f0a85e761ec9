// SPDX-License-Identifier: BSD-3-Clause
#include "CubicBasis.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;

std::vector<double> localCoordinates()
{
  std::vector<double> t;
  for (int i = 0; i <= 32; ++i)
  {
    t.push_back(i / 32.0);
  }
  return t;
}

double sum(const BasisValues& v)
{
  return v[0] + v[1] + v[2] + v[3];
}

/// sum_j v_j c_j where c_j are the coefficients of the cell 2 <= x <= 3 with unit spacing:
/// coefficient i of x^p is the blossom of x^p at the knots i - 2, i - 1, i.
double withPolynomial(const BasisValues& v, int power)
{
  double total = 0;
  for (std::size_t j = 0; j < 4; ++j)
  {
    const double centre = static_cast<double>(j) + 1, a = centre - 1, b = centre, c = centre + 1;
    const double blossom = power == 0 ? 1.0
      : power == 1                    ? (a + b + c) / 3
      : power == 2                    ? (a * b + b * c + c * a) / 3
                                      : a * b * c;
    total += v[j] * blossom;
  }
  return total;
}

TEST(CubicBasis, IsAPartitionOfUnity)
{
  for (double t : localCoordinates())
  {
    EXPECT_NEAR(sum(cubicBasis(t)), 1, 1e-15);
    EXPECT_NEAR(sum(cubicBasisFirstDerivative(t)), 0, 1e-15);
    EXPECT_NEAR(sum(cubicBasisSecondDerivative(t)), 0, 1e-15);
    for (double v : cubicBasis(t))
    {
      EXPECT_GE(v, 0);
    }
  }
}

TEST(CubicBasis, FollowsTheRecursionOfCoxAndDeBoor)
{
  for (double t : localCoordinates())
  {
    const BasisValues v = cubicBasis(t);
    for (int j = 0; j < 4; ++j)
    {
      EXPECT_NEAR(v[static_cast<std::size_t>(j)], ipia::test::coxDeBoor(j, 3, 1.0, 1, t), 1e-15);
    }
  }
}

TEST(CubicBasis, ReproducesCubicPolynomials)
{
  for (double t : localCoordinates())
  {
    const double x = 2 + t;
    for (int p = 0; p <= 3; ++p)
    {
      EXPECT_NEAR(withPolynomial(cubicBasis(t), p), std::pow(x, p), 1e-13) << "x^" << p;
      EXPECT_NEAR(withPolynomial(cubicBasisFirstDerivative(t), p),
        p == 0 ? 0.0 : p * std::pow(x, p - 1), 1e-13)
        << "x^" << p;
      EXPECT_NEAR(withPolynomial(cubicBasisSecondDerivative(t), p),
        p < 2 ? 0.0 : p * (p - 1) * std::pow(x, p - 2), 1e-13)
        << "x^" << p;
    }
  }
}

TEST(CubicBasis, DerivativesMatchCentralDifferences)
{
  constexpr double step = 1e-5;
  for (double t : localCoordinates())
  {
    const BasisValues before = cubicBasis(t - step), after = cubicBasis(t + step);
    const BasisValues slopeBefore = cubicBasisFirstDerivative(t - step);
    const BasisValues slopeAfter = cubicBasisFirstDerivative(t + step);
    for (std::size_t j = 0; j < 4; ++j)
    {
      EXPECT_NEAR(cubicBasisDerivative(t, 1)[j], (after[j] - before[j]) / (2 * step), 1e-9);
      EXPECT_NEAR(
        cubicBasisDerivative(t, 2)[j], (slopeAfter[j] - slopeBefore[j]) / (2 * step), 1e-9);
    }
  }
}

TEST(CubicBasis, IsTwiceContinuouslyDifferentiableAtKnots)
{
  for (int order = 0; order <= 2; ++order)
  {
    const BasisValues end = cubicBasisDerivative(1, order);
    const BasisValues start = cubicBasisDerivative(0, order);
    // The spline that is number j in a cell is number j - 1 in the next.
    EXPECT_NEAR(end[0], 0, 1e-15);
    for (std::size_t j = 1; j < 4; ++j)
    {
      EXPECT_NEAR(end[j], start[j - 1], 1e-15) << "order " << order;
    }
    EXPECT_NEAR(start[3], 0, 1e-15);
  }
}
}
