// SPDX-License-Identifier: BSD-3-Clause
#include "Parametrization.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;

/// Steps of lengths 1, 4 and 3; the way back is 4.
Eigen::MatrixXd corners()
{
  Eigen::MatrixXd points(4, 3);
  points << 0, 0, 0, 0, 1, 0, 4, 1, 0, 4, 4, 0;
  return points;
}

TEST(Parametrization, OfOpenPolylines)
{
  const auto of = [](ParametrizationType type) { return parametrize(corners(), type, false); };
  EXPECT_LE(
    (of(ParametrizationType::Uniform) - Eigen::Vector4d(0, 1 / 3.0, 2 / 3.0, 1)).norm(), 1e-15);
  EXPECT_LE(
    (of(ParametrizationType::Chord) - Eigen::Vector4d(0, 1 / 8.0, 5 / 8.0, 1)).norm(), 1e-15);
  const double all = 1 + 2 + std::sqrt(3);
  EXPECT_LE(
    (of(ParametrizationType::Centripetal) - Eigen::Vector4d(0, 1 / all, 3 / all, 1)).norm(), 1e-15);
}

TEST(Parametrization, OfClosedPolylinesCountsTheWayBack)
{
  const Vector t = parametrize(corners(), ParametrizationType::Chord, true);
  const double all = 8 + std::sqrt(32);
  EXPECT_LE((t - Eigen::Vector4d(0, 1, 5, 8) / all).norm(), 1e-15);
  const Vector uniform = parametrize(corners(), ParametrizationType::Uniform, true);
  EXPECT_LE((uniform - Eigen::Vector4d(0, 0.25, 0.5, 0.75)).norm(), 1e-15);
}

TEST(Parametrization, OfGridsIsTheMeanOverTheLines)
{
  // Rows of steps (1, 3) and (2, 2), and one that is a point.
  Eigen::MatrixXd points(9, 3);
  points << 0, 0, 0, 1, 0, 0, 4, 0, 0, 0, 1, 0, 2, 1, 0, 4, 1, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0;
  const Vector u = parametrizeGrid(points, 3, 3, 0, ParametrizationType::Chord, false);
  EXPECT_LE((u - Eigen::Vector3d(0, 0.375, 1)).norm(), 1e-15);
  const Vector v = parametrizeGrid(points, 3, 3, 1, ParametrizationType::Uniform, false);
  EXPECT_LE((v - Eigen::Vector3d(0, 0.5, 1)).norm(), 1e-15);
}

/// By hand for m = 10, n = 7, degree 3: d = 2.5; j d = 2.5, 5, 7.5.
TEST(Parametrization, KnotsAverageTheParameters)
{
  Vector t(10);
  t << 0, 0.05, 0.2, 0.3, 0.45, 0.5, 0.6, 0.8, 0.9, 1;
  const std::vector<double> knots = averagedKnots(t, 3, 7, false).interiorKnots();
  ASSERT_EQ(knots.size(), 3u);
  EXPECT_NEAR(knots[0], (t[1] + t[2]) / 2, 1e-15);
  EXPECT_NEAR(knots[1], t[4], 1e-15);
  EXPECT_NEAR(knots[2], (t[6] + t[7]) / 2, 1e-15);
  EXPECT_EQ(averagedKnots(t, 3, 4, false).interiorKnots().size(), 0u);
  for (int degree = 1; degree <= 5; ++degree)
  {
    for (std::int64_t n = degree + 1; n <= 10; ++n)
    {
      for (const bool closed : { false, true })
      {
        const BSplineBasis basis = averagedKnots(closed ? Vector(0.95 * t) : t, degree, n, closed);
        EXPECT_EQ(basis.size(), n);
        const auto& all = basis.knots();
        EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
        // Every span has data.
        const Vector parameters = closed ? Vector(0.95 * t) : t;
        for (const std::int64_t k : basis.spans())
        {
          EXPECT_TRUE(std::any_of(parameters.begin(), parameters.end(),
            [&](double parameter) { return basis.span(parameter) == k; }))
            << "degree " << degree << ", n " << n << ", closed " << closed << ", span " << k;
        }
      }
    }
  }
}

TEST(Parametrization, InitialPointsAreThoseOfThePaper)
{
  // P_1 = Q_1, P_j = Q_floor(m j / n), P_n = Q_m, numbered from 1.
  const std::vector<std::int64_t> points = initialPoints(uniformKnots(3, 7, false), 24);
  EXPECT_EQ(points, (std::vector<std::int64_t>{ 0, 5, 9, 12, 16, 19, 23 }));
  // A closed one of degree 3 begins one point before the seam.
  EXPECT_EQ(initialPoints(uniformKnots(3, 6, true), 24),
    (std::vector<std::int64_t>{ 20, 0, 4, 8, 12, 16 }));
}
}
