// SPDX-License-Identifier: BSD-3-Clause
#include "IncrementalFit.h"

#include "TestSupport.h"

#include <functional>

namespace
{
using namespace ipia;
using ipia::test::sphereInput;
using ipia::test::unitLattice;

constexpr int NumberOfViews = 10;

template <int Dim>
Point<Dim> centre()
{
  return Point<Dim>::Constant(0.5);
}

/// The points for which keep(position, normal) holds.
template <int Dim, typename Keep>
HermiteInput<Dim> filtered(const HermiteInput<Dim>& input, const Keep& keep)
{
  HermiteInput<Dim> output = input;
  Eigen::Index n = 0;
  for (Eigen::Index k = 0; k < input.Positions.cols(); ++k)
  {
    if (keep(Point<Dim>(input.Positions.col(k)), Point<Dim>(input.Normals.col(k))))
    {
      output.Positions.col(n) = input.Positions.col(k);
      output.Normals.col(n++) = input.Normals.col(k);
    }
  }
  output.Positions.conservativeResize(Dim, n);
  output.Normals.conservativeResize(Dim, n);
  return output;
}

template <int Dim>
HermiteInput<Dim> joined(const HermiteInput<Dim>& first, const HermiteInput<Dim>& second)
{
  HermiteInput<Dim> both;
  both.Positions.resize(Dim, first.Positions.cols() + second.Positions.cols());
  both.Positions << first.Positions, second.Positions;
  both.Normals.resize(Dim, both.Positions.cols());
  both.Normals << first.Normals, second.Normals;
  return both;
}

/// A sphere with waves that its lattice follows within a small error only.
template <int Dim>
HermiteInput<Dim> wavyPoints(std::int64_t n)
{
  HermiteInput<Dim> input = sphereInput<Dim>(1, n);
  constexpr double waves = 14, height = 0.012;
  for (Eigen::Index k = 0; k < n; ++k)
  {
    // r = 0.33 + height sin(waves d_0) in the direction d from the centre.
    const Point<Dim> d = input.Positions.col(k) - centre<Dim>();
    const double r = 0.33 + height * std::sin(waves * d[0]);
    const double slope = height * waves * std::cos(waves * d[0]);
    input.Positions.col(k) = centre<Dim>() + r * d;
    Point<Dim> alongX = -d[0] * d;
    alongX[0] += 1;
    input.Normals.col(k) = (d - slope / r * alongX).normalized();
  }
  return input;
}

/// What a scanner sees of a torus from one of ten directions around it.
HermiteInput<3> torusView(int view, std::int64_t n, double noise = 0)
{
  constexpr double ring = 0.3, tube = 0.12, golden = 2.39996;
  const double z = 1 - 2 * (view + 0.5) / NumberOfViews;
  const double across = std::sqrt(1 - z * z);
  const Point<3> towards(across * std::cos(golden * view), across * std::sin(golden * view), z);
  const auto isInside = [](const Point<3>& p)
  {
    const double off = std::hypot(p[0], p[1]) - ring;
    return off * off + p[2] * p[2] < tube * tube - 1e-4;
  };
  test::Random random(static_cast<std::uint64_t>(view) + 1);
  HermiteInput<3> input;
  input.Positions.resize(3, n);
  input.Normals.resize(3, n);
  for (Eigen::Index k = 0; k < n;)
  {
    const double u = random.uniform(0, 2 * test::Pi), v = random.uniform(0, 2 * test::Pi);
    const Point<3> normal(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
    const Point<3> p = Point<3>(ring * std::cos(u), ring * std::sin(u), 0) + tube * normal;
    bool seen = normal.dot(towards) > 0.25;
    for (double t = 0.02; seen && t < 1; t += 0.01)
    {
      seen = !isInside(p + t * towards);
    }
    const Point<3> shift(
      random.uniform(-noise, noise), random.uniform(-noise, noise), random.uniform(-noise, noise));
    if (seen)
    {
      input.Positions.col(k) = centre<3>() + p + shift;
      input.Normals.col(k++) = normal;
    }
  }
  return input;
}

HermiteInput<3> torusViews(int count, std::int64_t n, double noise = 0)
{
  HermiteInput<3> all = torusView(0, n, noise);
  for (int view = 1; view < count; ++view)
  {
    all = joined(all, torusView(view, n, noise));
  }
  return all;
}

/// Root mean square of the difference of two functions within two knot spacings of points of a
/// lattice with unit sides.
template <int Dim>
double difference(const HierarchicalResult<Dim>& a, const HierarchicalResult<Dim>& b,
  const HermiteInput<Dim>& points)
{
  const double h = a.Function->lattice().Spacing.maxCoeff();
  test::Random random(5);
  double sum = 0;
  for (Eigen::Index k = 0; k < points.Positions.cols(); ++k)
  {
    Point<Dim> at = points.Positions.col(k);
    at += random.uniform(-2, 2) * h * points.Normals.col(k);
    const double d = a.Function->value(at) - b.Function->value(at);
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(points.Positions.cols()));
}

/// Mean distance of points on the true surface from the zero set.
template <int Dim>
double missOf(const HierarchicalResult<Dim>& result, const HermiteInput<Dim>& truth)
{
  double sum = 0;
  for (Eigen::Index k = 0; k < truth.Positions.cols(); ++k)
  {
    Point<Dim> gradient;
    const double f = result.Function->valueAndGradient(truth.Positions.col(k), gradient);
    sum += std::abs(f) / gradient.norm();
  }
  return sum / static_cast<double>(truth.Positions.cols());
}

template <int Dim>
bool isSameFunction(const HierarchicalResult<Dim>& a, const HierarchicalResult<Dim>& b)
{
  return test::sameBits(a.Function->coefficients(), b.Function->coefficients());
}

TEST(IncrementalFitOfViews, AddsTheTenthViewNearTheFitOfTen)
{
  const Lattice<3> lattice = unitLattice<3>(64);
  const HierarchicalOptions options;
  for (const double noise : { 0.0, 0.006 })
  {
    IncrementalFit<3> incremental;
    const auto nine = torusViews(9, 6000, noise), ten = torusViews(10, 6000, noise);
    EXPECT_EQ(incremental.fit(lattice, nine, options).NumberOfPointsAdded, 0);
    const auto added = incremental.fit(lattice, ten, options);
    const auto full = fitHierarchical(lattice, ten, options);
    EXPECT_EQ(added.NumberOfPointsAdded, 6000);
    const double rms = difference(added, full, ten);
    EXPECT_LT(rms, 1e-3) << "noise " << noise;
    EXPECT_GT(rms, 0) << "another way to nearly the same";
    EXPECT_EQ(added.SmoothingLength > 0, noise > 0);
    // What it costs: coefficients times iterations, where the levels are bands.
    const auto cost = [](const HierarchicalResult<3>& result)
    {
      const LevelReport& finest = result.Reports.back();
      return static_cast<double>(finest.NumberOfActiveCoefficients) * finest.NumberOfIterations;
    };
    EXPECT_LT(cost(added), cost(full) / 3) << "noise " << noise;
    RecordProperty(noise > 0 ? "RmsNoisy" : "RmsClean", std::to_string(rms));
  }
}

TEST(IncrementalFitOfViews, StaysNearWhenViewsAreAddedOneByOne)
{
  const Lattice<3> lattice = unitLattice<3>(64);
  const HierarchicalOptions options;
  IncrementalFit<3> incremental;
  HierarchicalResult<3> result;
  for (int views = 1; views <= NumberOfViews; ++views)
  {
    result = incremental.fit(lattice, torusViews(views, 6000), options);
    EXPECT_EQ(result.NumberOfPointsAdded, views == 1 ? 0 : 6000) << views << " views";
  }
  const auto all = torusViews(NumberOfViews, 6000);
  EXPECT_LT(difference(result, fitHierarchical(lattice, all, options), all), 1e-3);
}

TEST(IncrementalFitOfViews, FitsAllAgainWhenNoisyPointsHaveDoubled)
{
  const Lattice<3> lattice = unitLattice<3>(64);
  const HierarchicalOptions options;
  IncrementalFit<3> incremental;
  const auto fit = [&](int views)
  { return incremental.fit(lattice, torusViews(views, 6000, 0.006), options); };
  const auto four = fit(4), seven = fit(7), eight = fit(8);
  EXPECT_GT(four.SmoothingLength, 0);
  EXPECT_EQ(seven.NumberOfPointsAdded, 3 * 6000);
  EXPECT_EQ(seven.SmoothingLength, four.SmoothingLength);
  EXPECT_EQ(eight.NumberOfPointsAdded, 0);
  EXPECT_TRUE(isSameFunction(eight, fitHierarchical(lattice, torusViews(8, 6000, 0.006), options)));
}

TEST(IncrementalFitOfViews, FitsAllAgainWhenNoisyPointsJoinCleanOnes)
{
  const Lattice<3> lattice = unitLattice<3>(64);
  const HierarchicalOptions options;
  IncrementalFit<3> incremental;
  const auto clean = torusViews(5, 6000);
  const auto mixed = joined(clean, torusView(6, 6000, 0.012));
  EXPECT_EQ(incremental.fit(lattice, clean, options).SmoothingLength, 0);
  const auto result = incremental.fit(lattice, mixed, options);
  EXPECT_EQ(result.NumberOfPointsAdded, 0);
  EXPECT_TRUE(isSameFunction(result, fitHierarchical(lattice, mixed, options)));
}

/// With points anywhere in the domain in front.
HermiteInput<3> withOutliers(const HermiteInput<3>& points, Eigen::Index n)
{
  test::Random random(17);
  HermiteInput<3> outliers;
  outliers.Positions.resize(3, n);
  outliers.Normals.resize(3, n);
  for (Eigen::Index k = 0; k < n; ++k)
  {
    for (int a = 0; a < 3; ++a)
    {
      outliers.Positions(a, k) = random.uniform(0.05, 0.95);
      outliers.Normals(a, k) = random.uniform(-1, 1);
    }
    outliers.Normals.col(k).normalize();
  }
  return joined(outliers, points);
}

TEST(IncrementalFitOfViews, AddsToAFitThatLeftOutliersOut)
{
  const Lattice<3> lattice = unitLattice<3>(64);
  const HierarchicalOptions options;
  IncrementalFit<3> incremental;
  const auto first = incremental.fit(lattice, withOutliers(torusViews(9, 6000), 1000), options);
  EXPECT_GT(first.Outliers.size(), 500u);
  EXPECT_LT(first.Outliers.back(), 1000) << "no point of the torus";
  const auto ten = withOutliers(torusViews(10, 6000), 1000);
  const auto added = incremental.fit(lattice, ten, options);
  EXPECT_EQ(added.NumberOfPointsAdded, 6000);
  EXPECT_EQ(added.Outliers, first.Outliers);
  EXPECT_DOUBLE_EQ(
    added.Faults.shareOfOutliers(), static_cast<double>(first.Outliers.size()) / 61000);
  EXPECT_GT(added.Reports.back().MaximumError, 0.9 * first.Reports.back().MaximumError)
    << "the errors are those of all points";
  EXPECT_LT(difference(added, fitHierarchical(lattice, ten, options), torusViews(10, 6000)), 1e-3);
}

TEST(IncrementalFitOfViews, FitsAllAgainWhenAddedPointsAreFaulty)
{
  const Lattice<3> lattice = unitLattice<3>(64);
  const HierarchicalOptions options;
  IncrementalFit<3> incremental;
  const auto clean = torusViews(9, 6000);
  auto flipped = torusView(9, 6000);
  for (Eigen::Index k = 0; k < flipped.Normals.cols(); k += 10)
  {
    flipped.Normals.col(k) *= -1;
  }
  for (const auto& view : { withOutliers(torusView(9, 6000), 300), flipped })
  {
    EXPECT_EQ(incremental.fit(lattice, clean, options).Faults.shareOfOutliers(), 0);
    const auto all = joined(clean, view);
    const auto result = incremental.fit(lattice, all, options);
    EXPECT_EQ(result.NumberOfPointsAdded, 0);
    EXPECT_TRUE(isSameFunction(result, fitHierarchical(lattice, all, options)));
    EXPECT_GT(result.Faults.Outliers + result.Faults.Flipped, 200);
  }
}

/// A wavy sphere without a cap, and the cap.
constexpr double CapHeight = 0.26;

template <int Dim>
HermiteInput<Dim> wavyPart(bool cap)
{
  return filtered(wavyPoints<Dim>(Dim == 2 ? 3000 : 40000),
    [cap](const Point<Dim>& p, const Point<Dim>&)
    { return (p[Dim - 1] - 0.5 > CapHeight) == cap; });
}

template <typename T>
class IncrementalFitOf : public ::testing::Test
{
};
TYPED_TEST_SUITE(IncrementalFitOf, ipia::test::Dimensions);

TYPED_TEST(IncrementalFitOf, FollowsNewDataWhereNothingWasBefore)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(64);
  const double h = lattice.Spacing[0];
  const HierarchicalOptions options;
  const auto trueRest = wavyPart<Dim>(false), trueCap = wavyPart<Dim>(true);
  // Exact points, then what a good scanner makes of them: too little to be smoothed.
  for (const double noise : { 0.0, 0.06 * h })
  {
    test::Random random(3);
    const auto measured = [&](HermiteInput<Dim> input)
    {
      for (Eigen::Index k = 0; k < input.Positions.cols(); ++k)
      {
        input.Positions.col(k) += random.uniform(-noise, noise) * input.Normals.col(k);
      }
      return input;
    };
    const auto rest = measured(trueRest), all = joined(rest, measured(trueCap));
    IncrementalFit<Dim> incremental;
    const auto before = incremental.fit(lattice, rest, options);
    const auto added = incremental.fit(lattice, all, options);
    const auto full = fitHierarchical(lattice, all, options);
    ASSERT_EQ(added.NumberOfPointsAdded, trueCap.Positions.cols());
    EXPECT_EQ(full.SmoothingLength, 0);
    EXPECT_GT(missOf(before, trueCap), 0.1 * h) << "the hole was filled otherwise";
    EXPECT_NEAR(missOf(added, trueCap), missOf(full, trueCap), 1e-4 * h);
    EXPECT_NEAR(missOf(added, trueRest), missOf(full, trueRest), 1e-4 * h);
    if (noise > 0)
    {
      EXPECT_NEAR(missOf(added, trueCap) / missOf(full, trueCap), 1, 0.03);
      EXPECT_NEAR(added.Reports.back().AverageError / full.Reports.back().AverageError, 1, 0.03);
    }
    EXPECT_LT(added.numberOfCoefficientsSolved(), full.numberOfCoefficientsSolved());
  }
}

TYPED_TEST(IncrementalFitOf, KeepsTheBitsOfTheBandFarFromNewPoints)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(128);
  const HierarchicalOptions options;
  IncrementalFit<Dim> incremental;
  const auto rest = wavyPart<Dim>(false);
  const auto before = incremental.fit(lattice, rest, options);
  const auto after = incremental.fit(lattice, joined(rest, wavyPart<Dim>(true)), options);
  ASSERT_GT(after.NumberOfPointsAdded, 0);
  const BrickLattice<Dim>& was = before.Function->levels().back();
  const BrickLattice<Dim>& is = after.Function->levels().back();
  const double lowestNew = 0.5 + CapHeight;
  std::int64_t far = 0, same = 0, nearChanged = 0;
  for (std::int32_t b = 0; b < was.numberOfActiveBricks(); ++b)
  {
    const std::int32_t now = is.brickAt(was.position(b));
    ASSERT_NE(now, BrickLattice<Dim>::Absent);
    for (int k = 0; k < BrickSize<Dim>; ++k)
    {
      if ((was.activeMask(b) >> k & 1) == 0)
      {
        continue;
      }
      const std::int64_t at =
        was.position(b)[Dim - 1] * BrickWidth + (k >> (2 * (Dim - 1)) & (BrickWidth - 1));
      const float x = was.coefficients()[static_cast<std::size_t>(b * BrickSize<Dim> + k)];
      const float y = is.coefficients()[static_cast<std::size_t>(now * BrickSize<Dim> + k)];
      // Coefficient i stands at (i - 1) h.
      if ((static_cast<double>(at) - 1) * lattice.Spacing[Dim - 1] < lowestNew - 0.125)
      {
        ++far;
        same += x == y;
      }
      else
      {
        nearChanged += x != y;
      }
    }
  }
  EXPECT_GT(far, Dim == 2 ? 1000 : 100000);
  EXPECT_EQ(same, far);
  EXPECT_GT(nearChanged, 0);
}

TYPED_TEST(IncrementalFitOf, SolvesForNothingWhereTheFitWasRight)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(64);
  const HierarchicalOptions options;
  const auto once = sphereInput<Dim>(0.35, 5000);
  IncrementalFit<Dim> incremental;
  const auto first = incremental.fit(lattice, once, options);
  const auto again = incremental.fit(lattice, joined(once, once), options);
  EXPECT_EQ(again.NumberOfPointsAdded, 5000);
  EXPECT_EQ(again.Reports.back().NumberOfActiveCoefficients, 0);
  EXPECT_LT(difference(first, again, once), 1e-6);
  const auto nothing = incremental.fit(lattice, joined(once, once), options);
  EXPECT_EQ(nothing.NumberOfPointsAdded, 0);
  EXPECT_EQ(nothing.numberOfCoefficientsSolved(), 0);
  EXPECT_TRUE(isSameFunction(again, nothing));
}

TYPED_TEST(IncrementalFitOf, GivesTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(96);
  const auto rest = wavyPart<Dim>(false), all = joined(rest, wavyPart<Dim>(true));
  const auto fit = [&](int threads)
  {
    HierarchicalOptions options;
    options.Threads = threads;
    IncrementalFit<Dim> incremental;
    incremental.fit(lattice, rest, options);
    return incremental.fit(lattice, all, options);
  };
  const auto one = fit(1);
  ASSERT_GT(one.NumberOfPointsAdded, 0);
  for (const int threads : { 2, 4 })
  {
    EXPECT_TRUE(isSameFunction(one, fit(threads))) << threads << " threads";
  }
}

TYPED_TEST(IncrementalFitOf, FitsAllAgainWhatIsNotAnAddition)
{
  constexpr int Dim = TypeParam::value;
  using Input = HermiteInput<Dim>;
  const Lattice<Dim> lattice = unitLattice<Dim>(40);
  HierarchicalOptions options;
  options.DataSpacing = 0.04;
  Input base = sphereInput<Dim>(0.33, 3000);
  base.Weights = Vector::LinSpaced(3000, 0.5, 1);
  base.LocalFairing = Vector::LinSpaced(3000, 0.5, 2);
  base.ExtraPositions = centre<Dim>();
  base.ExtraValues = Vector::Constant(1, -0.33);
  base.ExtraWeights = Vector::Constant(1, 1.0);
  Input more = base;
  more.Positions.conservativeResize(Dim, 3001);
  more.Positions.col(3000) = centre<Dim>() + Point<Dim>::Unit(0) * 0.34;
  more.Normals.conservativeResize(Dim, 3001);
  more.Normals.col(3000) = Point<Dim>::Unit(0);
  more.Weights.conservativeResize(3001);
  more.Weights[3000] = 1;
  more.LocalFairing.conservativeResize(3001);
  more.LocalFairing[3000] = 1;

  struct Case
  {
    const char* Name;
    std::function<void(Input&, Lattice<Dim>&, HierarchicalOptions&)> Change;
  };
  const Case cases[] = {
    { "a point moved", [](Input& in, auto&, auto&) { in.Positions(0, 7) += 1e-12; } },
    { "a normal turned", [](Input& in, auto&, auto&) { in.Normals.col(7) *= -1; } },
    { "a weight", [](Input& in, auto&, auto&) { in.Weights[7] *= 0.5; } },
    { "no weights", [](Input& in, auto&, auto&) { in.Weights.resize(0); } },
    { "a local fairing weight", [](Input& in, auto&, auto&) { in.LocalFairing[7] *= 2; } },
    { "no local fairing", [](Input& in, auto&, auto&) { in.LocalFairing.resize(0); } },
    { "an extra value", [](Input& in, auto&, auto&) { in.ExtraValues[0] = -0.3; } },
    { "no extra rows",
      [](Input& in, auto&, auto&)
      {
        in.ExtraPositions.resize(Dim, 0);
        in.ExtraValues.resize(0);
        in.ExtraWeights.resize(0);
      } },
    { "points in another order",
      [](Input& in, auto&, auto&) { in.Positions.col(0).swap(in.Positions.col(1)); } },
    { "a point less",
      [](Input& in, auto&, auto&)
      {
        in.Positions.conservativeResize(Dim, 2999);
        in.Normals.conservativeResize(Dim, 2999);
        in.Weights.conservativeResize(2999);
        in.LocalFairing.conservativeResize(2999);
      } },
    { "another spacing", [](auto&, Lattice<Dim>& grid, auto&) { grid.Spacing *= 1.01; } },
    { "another grid size", [](auto&, Lattice<Dim>& grid, auto&) { grid.Size[0] += 1; } },
    { "another fairing", [](auto&, auto&, HierarchicalOptions& o) { o.BandThinPlate *= 2; } },
    { "another number of levels",
      [](auto&, auto&, HierarchicalOptions& o) { o.NumberOfLevels = 2; } },
    { "another tolerance", [](auto&, auto&, HierarchicalOptions& o) { o.FinestTolerance = 1e-2; } },
  };
  for (const Case& c : cases)
  {
    IncrementalFit<Dim> incremental;
    incremental.fit(lattice, base, options);
    Input changed = more;
    Lattice<Dim> grid = lattice;
    HierarchicalOptions method = options;
    c.Change(changed, grid, method);
    const auto result = incremental.fit(grid, changed, method);
    EXPECT_EQ(result.NumberOfPointsAdded, 0) << c.Name;
    EXPECT_GT(result.numberOfCoefficientsSolved(), 0) << c.Name;
    EXPECT_TRUE(isSameFunction(result, fitHierarchical(grid, changed, method))) << c.Name;
  }
  IncrementalFit<Dim> incremental;
  incremental.fit(lattice, base, options);
  // Points that are added make the spacing that suits them smaller: that of the last fit stays.
  HierarchicalOptions denser = options;
  denser.DataSpacing = 0.9 * options.DataSpacing;
  EXPECT_EQ(incremental.fit(lattice, more, denser).NumberOfPointsAdded, 1);
}

TYPED_TEST(IncrementalFitOf, StartsAgainAfterAnAbort)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(64);
  const HierarchicalOptions options;
  const auto rest = wavyPart<Dim>(false), all = joined(rest, wavyPart<Dim>(true));
  IncrementalFit<Dim> incremental;
  incremental.fit(lattice, rest, options);
  const auto aborted =
    incremental.fit(lattice, all, options, [](double share) { return share < 0.5; });
  EXPECT_TRUE(aborted.Aborted);
  EXPECT_FALSE(aborted.Function);
  const auto result = incremental.fit(lattice, all, options);
  EXPECT_EQ(result.NumberOfPointsAdded, 0);
  EXPECT_TRUE(isSameFunction(result, fitHierarchical(lattice, all, options)));
}
}
