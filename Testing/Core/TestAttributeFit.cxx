// SPDX-License-Identifier: BSD-3-Clause
#include "AttributeFit.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;
using ipia::test::unitLattice;

constexpr double Radius = 0.35;

/// Points on a circle or sphere, about one to a cell of the lattice of 64 cells.
template <int Dim>
Points<Dim> points()
{
  return test::spherePoints<Dim>(Point<Dim>::Constant(0.5), Radius, Dim == 2 ? 400 : 12000)
    .Positions;
}

/// A wave with about three periods across the unit cube.
template <int Dim>
double wave(const Point<Dim>& x)
{
  return 5 + 2 * std::sin(18 * x[0] + 1) * std::cos(7 * x[1]);
}

template <int Dim, typename Function>
Eigen::MatrixXd valuesAt(const Points<Dim>& positions, const Function& function)
{
  Eigen::MatrixXd values(1, positions.cols());
  for (Eigen::Index k = 0; k < positions.cols(); ++k)
  {
    values(0, k) = function(Point<Dim>(positions.col(k)));
  }
  return values;
}

template <int Dim>
AttributeResult<Dim> fit(const Points<Dim>& positions, std::vector<Eigen::MatrixXd> arrays,
  const Vector& weights = {}, int threads = 0)
{
  return fitAttributes<Dim>(
    unitLattice<Dim>(64), { positions, weights, std::move(arrays) }, threads);
}

template <int Dim>
double valueAt(const AttributeSpline<Dim>& spline, const Point<Dim>& x)
{
  double value = 0;
  spline.evaluate(x, &value);
  return value;
}

/// The root mean square error on the circle or sphere, between the points.
template <int Dim, typename Function>
double errorOf(const AttributeSpline<Dim>& spline, const Function& truth)
{
  test::Random random(5);
  double sum = 0;
  constexpr int n = 3000;
  for (int k = 0; k < n; ++k)
  {
    Point<Dim> u;
    do
    {
      for (int a = 0; a < Dim; ++a)
      {
        u[a] = random.uniform(-1, 1);
      }
    } while (u.norm() > 1 || u.norm() < 0.1);
    const Point<Dim> x = Point<Dim>::Constant(0.5) + Radius * u.normalized();
    const double miss = valueAt(spline, x) - truth(x);
    sum += miss * miss;
  }
  return std::sqrt(sum / n);
}

/// Uniform deviates of the given standard deviation.
void addNoise(double deviation, Eigen::MatrixXd& values)
{
  test::Random random(7);
  const double half = std::sqrt(3.0) * deviation;
  for (Eigen::Index k = 0; k < values.size(); ++k)
  {
    values(k) += random.uniform(-half, half);
  }
}

template <typename T>
class AttributeFit : public ::testing::Test
{
};
TYPED_TEST_SUITE(AttributeFit, ipia::test::Dimensions);

TYPED_TEST(AttributeFit, KeepsConstantsExactly)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  const double constant = 0.1 + 1e6;
  const auto result =
    fit<Dim>(positions, { Eigen::MatrixXd::Constant(1, positions.cols(), constant) });
  EXPECT_EQ(valueAt<Dim>(result.Arrays[0], positions.col(3)), constant);
  EXPECT_EQ(valueAt<Dim>(result.Arrays[0], Point<Dim>::Constant(0.5)), constant);
  EXPECT_EQ(valueAt<Dim>(result.Arrays[0], Point<Dim>::Constant(-3)), constant);
}

TYPED_TEST(AttributeFit, KeepsLinearFunctionsInTheirRange)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  const auto linear = [](const Point<Dim>& x) { return 1000 * x[0] - 300 * x[1] + 7; };
  const Eigen::MatrixXd values = valuesAt<Dim>(positions, linear);
  const auto result = fit<Dim>(positions, { values });
  const AttributeSpline<Dim>& spline = result.Arrays[0];
  EXPECT_LT(errorOf(spline,
              [&](const Point<Dim>& x)
              { return std::min(std::max(linear(x), values.minCoeff()), values.maxCoeff()); }),
    1e-6 * 1000);
  // Inside the surface, where there are no data, too; beyond it the range ends it.
  const Point<Dim> centre = Point<Dim>::Constant(0.5);
  EXPECT_NEAR(valueAt(spline, centre), linear(centre), 1e-6 * 1000);
  Point<Dim> corner = Point<Dim>::Zero();
  corner[0] = 1;
  EXPECT_EQ(valueAt(spline, corner), values.maxCoeff());
}

TYPED_TEST(AttributeFit, FollowsDetailWithoutNoise)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  const auto result = fit<Dim>(positions, { valuesAt<Dim>(positions, wave<Dim>) });
  EXPECT_LT(errorOf(result.Arrays[0], wave<Dim>), 2e-3);
  EXPECT_LT(result.Reports[0].PredictionError, 2e-3);
}

TYPED_TEST(AttributeFit, SmoothsNoiseAndTellsHowMuch)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  constexpr double noise = 0.4;
  Eigen::MatrixXd values = valuesAt<Dim>(positions, wave<Dim>);
  addNoise(noise, values);
  const auto result = fit<Dim>(positions, { values });
  EXPECT_LT(errorOf(result.Arrays[0], wave<Dim>), (Dim == 2 ? 0.45 : 0.2) * noise);
  EXPECT_NEAR(result.Reports[0].PredictionError, noise, 0.25 * noise);
  EXPECT_EQ(result.Reports[0].NumberOfLevels, 3);
}

TYPED_TEST(AttributeFit, NothingButNoiseIsSmoothedAway)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(1, positions.cols(), 5);
  addNoise(1, values);
  const auto result = fit<Dim>(positions, { values });
  // 50 held-out points of the circle tell less than 1500 of the sphere.
  EXPECT_LE(result.Reports[0].Level, Dim == 2 ? 1 : 0);
  EXPECT_LT(
    errorOf(result.Arrays[0], [](const Point<Dim>&) { return 5.0; }), Dim == 2 ? 0.35 : 0.15);
}

TYPED_TEST(AttributeFit, EachArrayIsAsAlone)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  const Eigen::MatrixXd smooth = valuesAt<Dim>(positions, wave<Dim>);
  Eigen::MatrixXd noisy = smooth;
  addNoise(0.4, noisy);
  Eigen::MatrixXd both(2, positions.cols());
  both << smooth, 3 * smooth;
  const auto together = fit<Dim>(positions, { smooth, noisy, both });
  const auto first = fit<Dim>(positions, { smooth }), second = fit<Dim>(positions, { noisy });
  ASSERT_EQ(together.Arrays.size(), 3u);
  ASSERT_EQ(together.Arrays[2].numberOfComponents(), 2);
  EXPECT_NE(together.Reports[0].Level, together.Reports[1].Level);
  for (Eigen::Index k = 0; k < positions.cols(); k += 97)
  {
    const Point<Dim> x = positions.col(k);
    EXPECT_EQ(valueAt(together.Arrays[0], x), valueAt(first.Arrays[0], x));
    EXPECT_EQ(valueAt(together.Arrays[1], x), valueAt(second.Arrays[0], x));
    double v[2];
    together.Arrays[2].evaluate(x, v);
    EXPECT_NEAR(v[1], 3 * v[0], 1e-4);
  }
}

TYPED_TEST(AttributeFit, GivesTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  Eigen::MatrixXd values = valuesAt<Dim>(positions, wave<Dim>);
  addNoise(0.1, values);
  const auto one = fit<Dim>(positions, { values }, {}, 1);
  const auto three = fit<Dim>(positions, { values }, {}, 3);
  EXPECT_EQ(one.Reports[0].PredictionError, three.Reports[0].PredictionError);
  EXPECT_EQ(one.Arrays[0].component(0).Splines, three.Arrays[0].component(0).Splines);
}

TYPED_TEST(AttributeFit, PointsWithoutWeightSayNothing)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  Eigen::MatrixXd values = valuesAt<Dim>(positions, wave<Dim>);
  Vector weights = Vector::Constant(positions.cols(), 1e30);
  for (Eigen::Index k = 0; k < positions.cols(); k += 5)
  {
    weights[k] = 0;
    values(0, k) = -40;
  }
  const auto result = fit<Dim>(positions, { values }, weights);
  EXPECT_LT(errorOf(result.Arrays[0], wave<Dim>), 5e-3);
}

TYPED_TEST(AttributeFit, SamplesAreTheValuesThere)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  Eigen::MatrixXd values(2, positions.cols());
  values << valuesAt<Dim>(positions, wave<Dim>),
    valuesAt<Dim>(positions, [](const Point<Dim>& x) { return x[1]; });
  const auto result = fit<Dim>(positions, { values });
  AxisPositions<Dim> axes;
  for (int a = 0; a < Dim; ++a)
  {
    for (int i = 0; i <= 20 + a; ++i)
    {
      axes[static_cast<std::size_t>(a)].push_back(i / (20.0 + a));
    }
  }
  for (int c = 0; c < 2; ++c)
  {
    std::vector<double> samples(21 * 22 * (Dim == 2 ? 1 : 23));
    ASSERT_TRUE(result.Arrays[0].sample(axes, c, samples.data()));
    std::size_t next = 0;
    for (int z = 0; z < (Dim == 2 ? 1 : 23); ++z)
    {
      for (int y = 0; y < 22; ++y)
      {
        for (int x = 0; x < 21; ++x)
        {
          Point<Dim> at;
          at[0] = x / 20.0;
          at[1] = y / 21.0;
          if (Dim == 3)
          {
            at[Dim - 1] = z / 22.0;
          }
          double v[2];
          result.Arrays[0].evaluate(at, v);
          ASSERT_NEAR(samples[next++], v[c], 1e-5);
        }
      }
    }
  }
}

TYPED_TEST(AttributeFit, TakesFewPointsAndFlatOnes)
{
  constexpr int Dim = TypeParam::value;
  // Two points, and a line of points along x: no slope across it.
  Points<Dim> line = Points<Dim>::Constant(Dim, 40, 0.5);
  for (Eigen::Index k = 0; k < line.cols(); ++k)
  {
    line(0, k) = 0.1 + 0.02 * static_cast<double>(k);
  }
  const Points<Dim> two = line.leftCols(2);
  const auto linear = [](const Point<Dim>& x) { return 10 * x[0]; };
  const auto ofTwo = fit<Dim>(two, { valuesAt<Dim>(two, linear) });
  EXPECT_NEAR(valueAt<Dim>(ofTwo.Arrays[0], two.col(1)), 1.2, 1e-9);
  const auto ofLine = fit<Dim>(line, { valuesAt<Dim>(line, linear) });
  Point<Dim> beside = line.col(20);
  beside[1] += 0.3;
  EXPECT_NEAR(valueAt(ofLine.Arrays[0], beside), 5, 1e-9);
}

TYPED_TEST(AttributeFit, CanBeAborted)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> positions = points<Dim>();
  double last = 0;
  int calls = 0;
  const auto progress = [&](double share)
  {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return ++calls < 40;
  };
  const auto result = fitAttributes<Dim>(
    unitLattice<Dim>(64), { positions, {}, { valuesAt<Dim>(positions, wave<Dim>) } }, 0, progress);
  EXPECT_TRUE(result.Aborted);
  EXPECT_TRUE(result.Arrays.empty());
  EXPECT_EQ(calls, 40);
}
}
