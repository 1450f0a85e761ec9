// SPDX-License-Identifier: BSD-3-Clause
#include "HierarchicalFit.h"

#include "HierarchyLevel.h"
#include "ImplicitSpline.h"
#include "TestSupport.h"

namespace
{
using namespace ipia;
using ipia::test::sphereInput;
using ipia::test::unitLattice;

template <int Dim>
ImplicitSpline<Dim> functionOf(const Lattice<Dim>& lattice, const HierarchicalResult<Dim>& result)
{
  return ImplicitSpline<Dim>(lattice, result.Function->coefficients());
}

template <typename T>
class HierarchicalFit : public ::testing::Test
{
};
TYPED_TEST_SUITE(HierarchicalFit, ipia::test::Dimensions);

TYPED_TEST(HierarchicalFit, FindsTheDistanceToASphere)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(64);
  const auto input = sphereInput<Dim>(0.35, Dim == 2 ? 400 : 12000);
  const auto result = fitHierarchical(lattice, input, HierarchicalOptions{});
  const auto f = functionOf(lattice, result);
  EXPECT_EQ(result.SmoothingLength, 0);
  EXPECT_EQ(result.Function->levels().size(), 3u);
  test::Random random(11);
  for (int k = 0; k < 500; ++k)
  {
    Point<Dim> direction;
    for (int a = 0; a < Dim; ++a)
    {
      direction[a] = random.uniform(-1, 1);
    }
    direction.normalize();
    const auto at = [&](double r) -> Point<Dim>
    { return Point<Dim>::Constant(0.5) + r * direction; };
    EXPECT_NEAR(f.value(at(0.35)), 0, 2e-5);
    EXPECT_NEAR(f.value(at(0.36)), 0.01, 5e-4);
    EXPECT_NEAR(f.gradient(at(0.35)).dot(direction), 1, 1e-2);
    // One sign on either side, up to the centre and the border of the domain.
    for (double r = 0.34; r > 0; r -= 0.02)
    {
      EXPECT_LT(f.value(at(r)), 0);
    }
    for (double r = 0.36; r < 0.5; r += 0.02)
    {
      EXPECT_GT(f.value(at(r)), 0);
    }
  }
}

TYPED_TEST(HierarchicalFit, GivesTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(48);
  const auto input = sphereInput<Dim>(0.3, 5000);
  HierarchicalOptions options;
  options.Threads = 1;
  const Vector one = fitHierarchical(lattice, input, options).Function->coefficients();
  for (const int threads : { 1, 2, 4 })
  {
    options.Threads = threads;
    EXPECT_TRUE(
      test::sameBits(one, fitHierarchical(lattice, input, options).Function->coefficients()))
      << threads << " threads";
  }
}

TYPED_TEST(HierarchicalFit, FairsBandsFinerThanTheDataMore)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(64); // its only band
  const auto input = sphereInput<Dim>(0.3, Dim == 2 ? 60 : 1500);
  const auto fitted = [&](double dataSpacing, double factor)
  {
    HierarchicalOptions options;
    options.SmoothingLength = 0;
    options.DataSpacing = dataSpacing * lattice.Spacing[0];
    options.BandThinPlate *= factor;
    return fitHierarchical(lattice, input, options).Function->coefficients();
  };
  const Vector plain = fitted(0, 1);
  for (const double spacing : { 0.5, 1.0 })
  {
    EXPECT_TRUE(test::sameBits(plain, fitted(spacing, 1))) << spacing;
  }
  EXPECT_TRUE(test::sameBits(fitted(0, 16), fitted(2, 1)));
  EXPECT_FALSE(test::sameBits(plain, fitted(2, 1)));
  for (const double spacing : { 4.0, 50.0 })
  {
    EXPECT_TRUE(test::sameBits(fitted(0, 256), fitted(spacing, 1))) << spacing;
  }
}

TYPED_TEST(HierarchicalFit, SmoothsNoisyDataOnly)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(64);
  auto input = sphereInput<Dim>(0.35, Dim == 2 ? 1500 : 20000);
  test::Random random(2);
  for (Eigen::Index k = 0; k < input.Positions.cols(); ++k)
  {
    for (int a = 0; a < Dim; ++a)
    {
      // Uniform with a standard deviation of 0.005, a third of a knot spacing.
      input.Positions(a, k) += random.uniform(-0.00866, 0.00866);
      input.Normals(a, k) += random.uniform(-0.25, 0.25);
    }
    input.Normals.col(k).normalize();
  }
  HierarchicalOptions options;
  const auto smoothed = fitHierarchical(lattice, input, options);
  options.SmoothingLength = 0;
  const auto rough = fitHierarchical(lattice, input, options);
  EXPECT_NEAR(smoothed.Noise, 0.005, 0.0015) << "the deviation along one axis";
  EXPECT_GT(smoothed.SmoothingLength, lattice.Spacing[0]);
  EXPECT_EQ(rough.SmoothingLength, 0);
  const auto truth = test::spherePoints<Dim>(Point<Dim>::Constant(0.5), 0.35, 1000);
  // Root mean squares of f and of the gradient's deviation from the normal, on the true surface.
  const auto errors = [&](const HierarchicalResult<Dim>& result)
  {
    const auto f = functionOf(lattice, result);
    Eigen::Array2d sum(0, 0);
    for (Eigen::Index k = 0; k < truth.Positions.cols(); ++k)
    {
      Point<Dim> g;
      const double v = f.valueAndGradient(truth.Positions.col(k), g);
      sum += Eigen::Array2d(v * v, (g - truth.Normals.col(k)).squaredNorm());
    }
    return Eigen::Array2d((sum / static_cast<double>(truth.Positions.cols())).sqrt());
  };
  const Eigen::Array2d quiet = errors(smoothed), loud = errors(rough);
  EXPECT_LT(quiet[0], loud[0]);
  EXPECT_LT(quiet[1], 0.5 * loud[1]);
}

TYPED_TEST(HierarchicalFit, TakesNoPartThatItCannotFollowForNoise)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(64);
  constexpr double radius = 0.35;
  auto input = sphereInput<Dim>(radius, Dim == 2 ? 4000 : 30000);
  // A cap of two layers that contradict each other: each is two thirds of a spacing away.
  double sum = 0;
  for (Eigen::Index k = 0; k < input.Positions.cols(); ++k)
  {
    const Point<Dim> p = input.Positions.col(k);
    if (p[Dim - 1] > 0.5 + 0.8 * radius)
    {
      const double shift = (k % 2 == 0 ? 0.66 : -0.66) * lattice.Spacing[0];
      input.Positions.col(k) += shift * input.Normals.col(k);
      sum += shift * shift;
    }
  }
  const double rms = std::sqrt(sum / static_cast<double>(input.Positions.cols()));
  EXPECT_GT(rms, 0.15 * lattice.Spacing[0]) << "much, if all counted alike";
  const auto result = fitHierarchical(lattice, input, HierarchicalOptions{});
  EXPECT_EQ(result.SmoothingLength, 0);
  EXPECT_LT(result.Noise, 0.05 * lattice.Spacing[0]);
  // The other side is as it was.
  Point<Dim> below = Point<Dim>::Constant(0.5);
  below[Dim - 1] -= radius;
  EXPECT_NEAR(result.Function->value(below), 0, 1e-4);
}

TYPED_TEST(HierarchicalFit, FillsAHole)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(48);
  auto input = sphereInput<Dim>(0.35, 8000);
  const double cut = 0.5 + 0.35 * std::cos(0.5); // a cap of half an opening angle of 0.5
  Eigen::Index kept = 0;
  for (Eigen::Index k = 0; k < input.Positions.cols(); ++k)
  {
    if (input.Positions(0, k) < cut)
    {
      input.Positions.col(kept) = input.Positions.col(k);
      input.Normals.col(kept++) = input.Normals.col(k);
    }
  }
  input.Positions.conservativeResize(Dim, kept);
  input.Normals.conservativeResize(Dim, kept);
  const auto f = functionOf(lattice, fitHierarchical(lattice, input, HierarchicalOptions{}));
  Point<Dim> x = Point<Dim>::Constant(0.5);
  int changes = 0;
  double before = f.value(x), crossing = 0;
  for (; x[0] < 1; x[0] += 0.001)
  {
    const double value = f.value(x);
    if (value * before < 0)
    {
      ++changes;
      crossing = x[0];
    }
    before = value;
  }
  EXPECT_EQ(changes, 1);
  EXPECT_NEAR(crossing, 0.85, 0.03);
}

TYPED_TEST(HierarchicalFit, MeetsExtraRows)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(32);
  auto input = sphereInput<Dim>(0.35, 3000);
  input.ExtraPositions = Point<Dim>::Constant(0.5);
  input.ExtraValues = Vector::Constant(1, -0.5);
  input.ExtraWeights = Vector::Constant(1, 100);
  const auto f = functionOf(lattice, fitHierarchical(lattice, input, HierarchicalOptions{}));
  EXPECT_NEAR(f.value(Point<Dim>::Constant(0.5)), -0.5, 0.05);
}

TYPED_TEST(HierarchicalFit, StopsAsAsked)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(64);
  const auto input = sphereInput<Dim>(0.35, 3000);
  int calls = 0;
  const auto aborted = fitHierarchical<Dim>(
    lattice, input, HierarchicalOptions{}, [&](double) { return ++calls < 2; });
  EXPECT_TRUE(aborted.Aborted);
  HierarchicalOptions options;
  options.FinestIterations = 3;
  options.FinestTolerance = 0;
  const auto three = fitHierarchical(lattice, input, options);
  EXPECT_EQ(three.Reports.back().NumberOfIterations, 3);
  EXPECT_EQ(three.Reports.back().ResidualHistory.size(), 4u);
  EXPECT_EQ(three.Reports.back().ResidualHistory.front(), 1);
  EXPECT_GT(three.Reports.back().Energy, 0);
  options.NumberOfLevels = 1;
  EXPECT_EQ(fitHierarchical(lattice, input, options).Function->levels().size(), 1u);
}
TYPED_TEST(HierarchicalFit, TrustsRowsThatThePredictionFollows)
{
  constexpr int Dim = TypeParam::value;
  HermiteRow<Dim> row{};
  row.Slope[0] = 0.3F; // h n
  row.Slope[1] = -0.4F;
  const auto trust = [&](float share, float across)
  {
    std::array<float, Dim> gradient{};
    gradient[0] = share * row.Slope[0] + across * 0.4F;
    gradient[1] = share * row.Slope[1] + across * 0.3F;
    return trustInSlope<Dim>(row, gradient.data());
  };
  EXPECT_EQ(trust(1, 0), 1);
  EXPECT_EQ(trust(0.8F, 5), 1);
  EXPECT_NEAR(trust(0.35F, 0), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(trust(0.35F, 2), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(trust(0, 1), std::sqrt(0.03), 1e-6);
  EXPECT_NEAR(trust(-1, 0), std::sqrt(0.03), 1e-6);
  row.Slope.fill(0);
  EXPECT_EQ(trust(0, 0), 1);
}
}
