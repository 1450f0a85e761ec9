// SPDX-License-Identifier: BSD-3-Clause
#include "ImplicitSpline.h"

#include "TestSupport.h"

#include <limits>

namespace
{
using namespace ipia;

template <int Dim>
ImplicitSpline<Dim> randomSpline()
{
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  return { lattice, ipia::test::Random(21).vector(lattice.numberOfCoefficients(), -1, 1) };
}

/// The same with far boxes of both signs, alone and in runs, some at the ends of rows.
template <int Dim>
ImplicitSpline<Dim> splineWithFarField()
{
  const ImplicitSpline<Dim> spline = randomSpline<Dim>();
  FarField far;
  far.Magnitude = 0.625;
  far.Sign.assign(static_cast<std::size_t>(spline.lattice().numberOfBoxes()), 0);
  ipia::test::Random random(22);
  std::int8_t sign = 0;
  for (std::int8_t& s : far.Sign)
  {
    if (random.uniform(0, 1) < 0.5)
    {
      sign = static_cast<std::int8_t>(std::floor(random.uniform(-1, 2)));
    }
    s = sign;
  }
  std::fill(far.Sign.begin(), far.Sign.begin() + spline.lattice().boxes(0), std::int8_t(-1));
  return { spline.lattice(), spline.coefficients(), far };
}

/// Uneven positions with both ends of the domain, knots and duplicates; a part of the axis if
/// asked.
template <int Dim>
AxisPositions<Dim> samplePositions(const Lattice<Dim>& lattice, double from, double to)
{
  AxisPositions<Dim> positions;
  ipia::test::Random random(23);
  for (int a = 0; a < Dim; ++a)
  {
    const double low = from * lattice.extent(a), high = to * lattice.extent(a);
    positions[a] = { low, low, high };
    for (int k = 0; k < 20 + 17 * a; ++k)
    {
      positions[a].push_back(random.uniform(low, high));
    }
    for (std::int64_t k = 0; k <= lattice.cells(a); ++k)
    {
      // Knots, where two half knots meet in the middle of a box, and borders of boxes; each also
      // with the rounding that an origin far away gives.
      for (const double shift : { 0.0, 0.25, 0.5, 0.75 })
      {
        const double x = (static_cast<double>(k) + shift) * lattice.Spacing[a];
        for (const double rounded : { x, x * (1 - 1e-15), x + (x + 1e6 - 1e6 - x) })
        {
          if (rounded >= low && rounded <= high)
          {
            positions[a].push_back(rounded);
          }
        }
      }
    }
    std::sort(positions[a].begin(), positions[a].end());
  }
  return positions;
}

template <int Dim>
std::vector<Point<Dim>> gridPoints(const AxisPositions<Dim>& positions)
{
  std::vector<Point<Dim>> points;
  const std::vector<double> once(1, 0.0);
  for (double z : Dim == 3 ? positions[Dim - 1] : once)
  {
    for (double y : positions[1])
    {
      for (double x : positions[0])
      {
        Point<Dim> p;
        p[Dim - 1] = z;
        p[1] = y;
        p[0] = x;
        points.push_back(p);
      }
    }
  }
  return points;
}

template <typename Scalar, int Dim>
void expectSamplesToEqualValues(
  const ImplicitSpline<Dim>& spline, const AxisPositions<Dim>& positions)
{
  const std::vector<Point<Dim>> points = gridPoints<Dim>(positions);
  std::vector<Scalar> samples(points.size());
  const double rounding = 16 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
  for (int axis = -1; axis < Dim; ++axis)
  {
    std::fill(samples.begin(), samples.end(), std::numeric_limits<Scalar>::quiet_NaN());
    ASSERT_TRUE(spline.sample(positions, samples.data(), 2, axis));
    double largest = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      const double expected = axis < 0 ? spline.value(points[k]) : spline.gradient(points[k])[axis];
      const double difference = std::abs(static_cast<double>(samples[k]) - expected);
      largest = difference <= largest ? largest : difference; // keeps NaN
    }
    const double scale = axis < 0 ? 1.0 : 2 / spline.lattice().Spacing[axis];
    EXPECT_LE(largest, rounding * scale) << "derivative along " << axis;
  }
}

template <typename T>
class ImplicitSplineTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(ImplicitSplineTest, ipia::test::Dimensions);

TYPED_TEST(ImplicitSplineTest, IsTheSumOfBasisFunctions)
{
  constexpr int Dim = TypeParam::value;
  const ImplicitSpline<Dim> spline = randomSpline<Dim>();
  Points<Dim> x = ipia::test::Random(5).pointsIn(spline.lattice(), 200);
  x.col(0).setZero();
  x.col(1) = ipia::test::extents(spline.lattice());
  x(0, 2) = spline.lattice().extent(0);
  const Vector expected =
    ipia::test::collocationMatrix(spline.lattice(), x) * spline.coefficients();
  for (Eigen::Index k = 0; k < x.cols(); ++k)
  {
    EXPECT_NEAR(spline.value(x.col(k)), expected[k], 1e-14);
  }
}

TYPED_TEST(ImplicitSplineTest, ReproducesCubicPolynomials)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  // The product over the axes of 1 + x - 2 x^2 + x^3 / 2, by blossoms at three knots in a row.
  const auto blossom = [](double a, double b, double c)
  { return 1 + (a + b + c) / 3 - 2 * (a * b + b * c + c * a) / 3 + a * b * c / 2; };
  Vector c(lattice.numberOfCoefficients());
  for (std::int64_t i = 0; i < c.size(); ++i)
  {
    c[i] = 1;
    std::int64_t rest = i;
    for (int a = 0; a < Dim; ++a)
    {
      const double h = lattice.Spacing[a],
                   centre = (static_cast<double>(rest % lattice.Size[a]) - 1) * h;
      c[i] *= blossom(centre - h, centre, centre + h);
      rest /= lattice.Size[a];
    }
  }
  const ImplicitSpline<Dim> spline(lattice, c);
  const Points<Dim> x = ipia::test::Random(6).pointsIn(lattice, 200);
  for (Eigen::Index k = 0; k < x.cols(); ++k)
  {
    double expected = 1;
    for (int a = 0; a < Dim; ++a)
    {
      expected *= blossom(x(a, k), x(a, k), x(a, k));
    }
    EXPECT_NEAR(spline.value(x.col(k)), expected, 1e-13 * c.cwiseAbs().maxCoeff());
  }
}

TYPED_TEST(ImplicitSplineTest, IsContinuousAtTheUpperEndOfTheDomain)
{
  constexpr int Dim = TypeParam::value;
  const ImplicitSpline<Dim> spline = randomSpline<Dim>();
  const Point<Dim> end = ipia::test::extents(spline.lattice());
  EXPECT_NEAR(spline.value(end), spline.value(end * (1 - 1e-12)), 1e-10);
  EXPECT_NE(spline.value(end), 0);
  EXPECT_LE((spline.gradient(end) - spline.gradient(end * (1 - 1e-12))).norm(), 1e-9);
}

TYPED_TEST(ImplicitSplineTest, GradientMatchesCentralDifferences)
{
  constexpr int Dim = TypeParam::value;
  const ImplicitSpline<Dim> spline = randomSpline<Dim>();
  ipia::test::Random random(31);
  for (int k = 0; k < 500; ++k)
  {
    // Outside the domain too, but not across its border, where the continuation has a kink.
    Point<Dim> x;
    bool nearBorder = false;
    for (int a = 0; a < Dim; ++a)
    {
      const double e = spline.lattice().extent(a);
      x[a] = random.uniform(-0.5, 1.5) * e;
      nearBorder = nearBorder || std::abs(x[a]) < 1e-3 || std::abs(x[a] - e) < 1e-3;
    }
    Point<Dim> inside = x.cwiseMax(Point<Dim>::Zero());
    inside = inside.cwiseMin(ipia::test::extents(spline.lattice()));
    if (nearBorder || (inside != x && std::abs(spline.value(inside)) < 1e-3))
    {
      continue;
    }
    const Point<Dim> gradient = spline.gradient(x);
    for (int a = 0; a < Dim; ++a)
    {
      const Point<Dim> step = 1e-5 * Point<Dim>::Unit(a);
      const double difference = (spline.value(x + step) - spline.value(x - step)) / 2e-5;
      if (inside == x)
      {
        EXPECT_NEAR(gradient[a], difference, 1e-7);
      }
      else
      {
        EXPECT_NEAR(gradient[a], difference, 1e-6) << "outside the domain";
      }
    }
  }
}

TYPED_TEST(ImplicitSplineTest, SamplesEqualValues)
{
  constexpr int Dim = TypeParam::value;
  for (const ImplicitSpline<Dim>& spline : { randomSpline<Dim>(), splineWithFarField<Dim>() })
  {
    for (const auto& range :
      { std::array<double, 2>{ 0, 1 }, { 0.3, 0.55 }, { 0.9, 1 }, { 0, 0.05 } })
    {
      const AxisPositions<Dim> positions = samplePositions(spline.lattice(), range[0], range[1]);
      expectSamplesToEqualValues<double, Dim>(spline, positions);
      expectSamplesToEqualValues<float, Dim>(spline, positions);
    }
  }
}

TYPED_TEST(ImplicitSplineTest, SamplesManyBlocks)
{
  constexpr int Dim = TypeParam::value;
  const ImplicitSpline<Dim> spline = splineWithFarField<Dim>();
  AxisPositions<Dim> positions;
  for (int a = 0; a < Dim; ++a)
  {
    for (int k = 0; k < 71; ++k)
    {
      positions[a].push_back(spline.lattice().extent(a) * k / 70);
    }
  }
  expectSamplesToEqualValues<double, Dim>(spline, positions);
}

TYPED_TEST(ImplicitSplineTest, SamplesOfAPartAreThoseOfTheWhole)
{
  constexpr int Dim = TypeParam::value;
  const ImplicitSpline<Dim> spline = splineWithFarField<Dim>();
  const AxisPositions<Dim> whole = samplePositions(spline.lattice(), 0, 1);
  AxisPositions<Dim> part;
  for (int a = 0; a < Dim; ++a)
  {
    part[a].assign(whole[a].begin() + 3 + a, whole[a].end() - 5);
  }
  std::vector<float> all(gridPoints<Dim>(whole).size()), some(gridPoints<Dim>(part).size());
  spline.sample(whole, all.data(), 1);
  spline.sample(part, some.data(), 2);
  for (std::size_t k = 0; k < some.size(); ++k)
  {
    std::size_t rest = k, stride = 1, index = 0;
    for (int a = 0; a < Dim; ++a)
    {
      index += (rest % part[a].size() + 3 + static_cast<std::size_t>(a)) * stride;
      rest /= part[a].size();
      stride *= whole[a].size();
    }
    ASSERT_EQ(some[k], all[index]) << "any extent has the same bits";
  }
}

TYPED_TEST(ImplicitSplineTest, SamplesHaveTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  const ImplicitSpline<Dim> spline = splineWithFarField<Dim>();
  const AxisPositions<Dim> positions = samplePositions(spline.lattice(), 0, 1);
  std::vector<double> reference(gridPoints<Dim>(positions).size()), samples(reference.size());
  spline.sample(positions, reference.data(), 1);
  for (const int threads : { 1, 2, 4 })
  {
    std::fill(samples.begin(), samples.end(), 0.0);
    spline.sample(positions, samples.data(), threads);
    EXPECT_EQ(samples, reference) << threads << " threads";
  }
}

TYPED_TEST(ImplicitSplineTest, SamplingAborts)
{
  constexpr int Dim = TypeParam::value;
  const ImplicitSpline<Dim> spline = randomSpline<Dim>();
  AxisPositions<Dim> positions;
  for (int a = 0; a < Dim; ++a)
  {
    positions[a].assign(100, 0.5);
  }
  std::vector<float> samples(gridPoints<Dim>(positions).size());
  int calls = 0;
  EXPECT_FALSE(spline.sample(positions, samples.data(), 1, -1,
    [&](double share)
    {
      EXPECT_TRUE(share >= 0 && share <= 1);
      return ++calls < 3;
    }));
  EXPECT_EQ(calls, 3);
  EXPECT_TRUE(spline.sample(positions, samples.data(), 1, -1, [](double) { return true; }));
}

TYPED_TEST(ImplicitSplineTest, MaySampleNothing)
{
  constexpr int Dim = TypeParam::value;
  const ImplicitSpline<Dim> spline = randomSpline<Dim>();
  AxisPositions<Dim> positions = samplePositions(spline.lattice(), 0, 1);
  positions[1].clear();
  float untouched = 5;
  EXPECT_TRUE(spline.sample(positions, &untouched));
  EXPECT_EQ(untouched, 5);
}

TYPED_TEST(ImplicitSplineTest, TheContinuationKeepsTheSignAndIsContinuous)
{
  constexpr int Dim = TypeParam::value;
  for (const ImplicitSpline<Dim>& spline : { randomSpline<Dim>(), splineWithFarField<Dim>() })
  {
    const Point<Dim> upper = ipia::test::extents(spline.lattice());
    ipia::test::Random random(41);
    for (int k = 0; k < 500; ++k)
    {
      Point<Dim> x;
      for (int a = 0; a < Dim; ++a)
      {
        x[a] = random.uniform(-1, 2) * upper[a];
      }
      const Point<Dim> inside = x.cwiseMax(Point<Dim>::Zero()).cwiseMin(upper);
      const double distance = (x - inside).norm();
      const double f = spline.value(x), atBorder = spline.value(inside);
      if (distance == 0)
      {
        continue;
      }
      EXPECT_EQ(f < 0, atBorder < 0);
      EXPECT_NEAR(std::abs(f), std::abs(atBorder) + distance, 1e-13);
      // Across the border, and along the way out.
      EXPECT_NEAR(spline.value(inside + 1e-9 * (x - inside)), atBorder, 1e-8);
      EXPECT_NEAR(spline.value(x + 1e-9 * (x - inside)), f, 1e-8);
    }
  }
}

TYPED_TEST(ImplicitSplineTest, ManyPositionsAreEvaluatedAsOneIs)
{
  constexpr int Dim = TypeParam::value;
  for (const ImplicitSpline<Dim>& spline : { randomSpline<Dim>(), splineWithFarField<Dim>() })
  {
    ipia::test::Random random(17);
    Points<Dim> positions(Dim, 500), gradients;
    for (Eigen::Index k = 0; k < positions.cols(); ++k)
    {
      for (int a = 0; a < Dim; ++a)
      {
        positions(a, k) = random.uniform(-0.1, 1.1) * spline.lattice().extent(a);
      }
    }
    Vector values;
    spline.valuesAndGradients(positions, values, gradients);
    ASSERT_EQ(values.size(), positions.cols());
    for (Eigen::Index k = 0; k < positions.cols(); ++k)
    {
      Point<Dim> g;
      EXPECT_NEAR(values[k], spline.valueAndGradient(positions.col(k), g), 1e-12);
      EXPECT_LE((gradients.col(k) - g).norm(), 1e-11 * (1 + g.norm()));
    }
  }
}

TYPED_TEST(ImplicitSplineTest, TheGradientPointsAwayFromAFarFieldAtTheBorder)
{
  constexpr int Dim = TypeParam::value;
  const ImplicitSpline<Dim> plain = randomSpline<Dim>();
  FarField far;
  far.Magnitude = 2;
  far.Sign.assign(static_cast<std::size_t>(plain.lattice().numberOfBoxes()), std::int8_t(-1));
  const ImplicitSpline<Dim> spline(plain.lattice(), plain.coefficients(), far);
  const Point<Dim> middle = ipia::test::extents(plain.lattice()) / 2;
  EXPECT_EQ(spline.value(middle), -2);
  EXPECT_TRUE(spline.gradient(middle).isZero(0));
  Point<Dim> outside = middle;
  outside[0] = -3;
  EXPECT_EQ(spline.value(outside), -5);
  EXPECT_LE((spline.gradient(outside) - Point<Dim>::Unit(0)).norm(), 1e-15);
}

/// A rational spline with weights from 0 to 3.
template <int Dim>
ImplicitSpline<Dim> rationalSpline(FarField farField = {})
{
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  ipia::test::Random random(91);
  const Vector c = random.vector(lattice.numberOfCoefficients(), -1, 1);
  Vector w = random.vector(lattice.numberOfCoefficients(), 0.2, 3);
  w[w.size() / 2] = 0;
  return { lattice, c, w, std::move(farField) };
}

TYPED_TEST(ImplicitSplineTest, RationalValuesAndGradientsAreThoseOfTheQuotient)
{
  constexpr int Dim = TypeParam::value;
  const auto spline = rationalSpline<Dim>();
  EXPECT_TRUE(spline.isRational());
  const Points<Dim> x = ipia::test::Random(92).pointsIn(spline.lattice(), 200);
  const Eigen::MatrixXd b = ipia::test::collocationMatrix(spline.lattice(), x);
  const Vector expected =
    (b * spline.weights().cwiseProduct(spline.coefficients())).cwiseQuotient(b * spline.weights());
  Vector values;
  Points<Dim> gradients;
  spline.valuesAndGradients(x, values, gradients);
  EXPECT_LE((values - expected).cwiseAbs().maxCoeff(), 1e-13);
  const double step = 1e-6;
  for (Eigen::Index k = 0; k < x.cols(); ++k)
  {
    EXPECT_NEAR(spline.value(x.col(k)), expected[k], 1e-13);
    const Point<Dim> g = spline.gradient(x.col(k));
    EXPECT_LE((g - gradients.col(k)).norm(), 1e-12);
    for (int a = 0; a < Dim; ++a)
    {
      const Point<Dim> e = step * Point<Dim>::Unit(a);
      const double difference =
        (spline.value(x.col(k) + e) - spline.value(x.col(k) - e)) / (2 * step);
      // Beyond the domain f goes on differently.
      if (spline.lattice().contains(x.col(k) + e) && spline.lattice().contains(x.col(k) - e))
      {
        EXPECT_NEAR(g[a], difference, 1e-6);
      }
    }
  }
}

TYPED_TEST(ImplicitSplineTest, RationalSamplesAreValuesWithAndWithoutAFarField)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  FarField far;
  far.Magnitude = 0.7;
  far.Sign.resize(static_cast<std::size_t>(lattice.numberOfBoxes()));
  for (std::size_t i = 0; i < far.Sign.size(); ++i)
  {
    far.Sign[i] = static_cast<std::int8_t>(i % 5 == 0 ? -1 : i % 3 == 0 ? 1 : 0);
  }
  for (const FarField& field : { FarField{}, far })
  {
    const auto spline = rationalSpline<Dim>(field);
    AxisPositions<Dim> positions;
    std::int64_t total = 1;
    for (int a = 0; a < Dim; ++a)
    {
      for (int k = 0; k < 37; ++k)
      {
        positions[a].push_back(lattice.extent(a) * (k + 0.3) / 37);
      }
      total *= 37;
    }
    for (int axis = -1; axis < Dim; ++axis)
    {
      Vector one(total), two(total);
      EXPECT_TRUE(spline.sample(positions, one.data(), 1, axis));
      EXPECT_TRUE(spline.sample(positions, two.data(), 3, axis));
      EXPECT_TRUE(ipia::test::sameBits(one, two));
      for (std::int64_t i = 0; i < total; i += 7)
      {
        Point<Dim> x;
        std::int64_t rest = i;
        for (int a = 0; a < Dim; ++a, rest /= 37)
        {
          x[a] = positions[a][static_cast<std::size_t>(rest % 37)];
        }
        EXPECT_NEAR(one[i], axis < 0 ? spline.value(x) : spline.gradient(x)[axis], 1e-11);
      }
    }
  }
}

TYPED_TEST(ImplicitSplineTest, EqualWeightsMakeNoDifference)
{
  constexpr int Dim = TypeParam::value;
  const auto rational = rationalSpline<Dim>();
  const ImplicitSpline<Dim> equal(rational.lattice(), rational.coefficients(),
    Vector::Constant(rational.coefficients().size(), 0.3)),
    polynomial(rational.lattice(), rational.coefficients());
  const Points<Dim> x = ipia::test::Random(93).pointsIn(rational.lattice(), 50);
  for (Eigen::Index k = 0; k < x.cols(); ++k)
  {
    EXPECT_NEAR(equal.value(1.5 * x.col(k)), polynomial.value(1.5 * x.col(k)), 1e-13);
  }
}
}
