// SPDX-License-Identifier: BSD-3-Clause
/**
 * Outliers and flipped normals: found as they were made, and without effect on the fit.
 */
#include "SampleChecks.h"

#include "HierarchicalFit.h"
#include "LonePoints.h"
#include "TestSupport.h"

namespace
{
using namespace ipia;
using ipia::test::unitLattice;

constexpr double Radius = 0.35;

template <int Dim>
HermiteInput<Dim> sphereInput()
{
  return test::sphereInput<Dim>(Radius, Dim == 2 ? 1000 : 12000);
}

/// Turns this share of the normals, and returns how many it was.
template <int Dim>
double flip(HermiteInput<Dim>& input, double share)
{
  test::Random random(5);
  double flipped = 0;
  for (Eigen::Index k = 0; k < input.Normals.cols(); ++k)
  {
    if (random.uniform(0, 1) < share)
    {
      input.Normals.col(k) *= -1;
      ++flipped;
    }
  }
  return flipped;
}

/// Adds so many points all over the domain, with normals of any direction.
template <int Dim>
void addOutliers(HermiteInput<Dim>& input, Eigen::Index n)
{
  test::Random random(3);
  const Eigen::Index before = input.Positions.cols();
  input.Positions.conservativeResize(Dim, before + n);
  input.Normals.conservativeResize(Dim, before + n);
  for (Eigen::Index k = before; k < before + n; ++k)
  {
    for (int a = 0; a < Dim; ++a)
    {
      input.Positions(a, k) = random.uniform(0.1, 0.9);
      input.Normals(a, k) = random.uniform(-1, 1);
    }
    input.Normals.col(k).normalize();
  }
}

/// The largest |f| on the sphere, and whether f has its signs away from it.
template <int Dim>
double largestMiss(const HierarchicalResult<Dim>& result)
{
  double miss = 0;
  test::Random random(11);
  for (int k = 0; k < 500; ++k)
  {
    Point<Dim> direction;
    for (int a = 0; a < Dim; ++a)
    {
      direction[a] = random.uniform(-1, 1);
    }
    direction.normalize();
    const auto f = [&](double r)
    { return result.Function->value(Point<Dim>::Constant(0.5) + r * direction); };
    miss = std::max(miss, std::abs(f(Radius)));
    for (double r = 0.02; r < 0.5; r += 0.02)
    {
      if (std::abs(r - Radius) > 0.015)
      {
        EXPECT_EQ(f(r) < 0, r < Radius) << "at radius " << r;
      }
    }
  }
  return miss;
}

template <typename T>
class SampleChecks : public ::testing::Test
{
};
TYPED_TEST_SUITE(SampleChecks, ipia::test::Dimensions);

TYPED_TEST(SampleChecks, CleanDataHaveNoFaults)
{
  constexpr int Dim = TypeParam::value;
  const auto result =
    fitHierarchical(unitLattice<Dim>(64), sphereInput<Dim>(), HierarchicalOptions{});
  EXPECT_EQ(result.Faults.shareOfFlippedNormals(), 0);
  EXPECT_EQ(result.Faults.shareOfOutliers(), 0);
  EXPECT_LT(largestMiss(result), 2e-5);
}

TYPED_TEST(SampleChecks, SpreadIsTheDeviationOfNormalDistances)
{
  constexpr int Dim = TypeParam::value;
  constexpr double deviation = 0.2;
  test::Random random(2);
  Samples<Dim> samples(20000);
  std::vector<SampleCheck> checks(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    samples[k].HasNormal = k % 2 == 0;
    // A sum of twelve is about normal; of samples with no normal another one, that does not count.
    double sum = -6;
    for (int i = 0; i < 12; ++i)
    {
      sum += random.uniform(0, 1);
    }
    checks[k].Distance = static_cast<float>(samples[k].HasNormal ? deviation * sum : 5);
  }
  EXPECT_NEAR(spreadOf(samples, checks), deviation, 0.02 * deviation);
  EXPECT_EQ(spreadOf(Samples<Dim>{}, {}), 0);
}

TYPED_TEST(SampleChecks, FindsFlippedNormals)
{
  constexpr int Dim = TypeParam::value;
  for (const double share : { 0.02, 0.1, 0.25 })
  {
    auto input = sphereInput<Dim>();
    const double flipped = flip(input, share) / static_cast<double>(input.Normals.cols());
    const auto result = fitHierarchical(unitLattice<Dim>(64), input, HierarchicalOptions{});
    EXPECT_NEAR(result.Faults.shareOfFlippedNormals(), flipped, 0.02) << share;
    EXPECT_EQ(result.Faults.shareOfOutliers(), 0) << share;
    EXPECT_EQ(result.SmoothingLength, 0) << share;
    EXPECT_LT(largestMiss(result), 1e-4) << share;
  }
}

TYPED_TEST(SampleChecks, FindsOutliers)
{
  constexpr int Dim = TypeParam::value;
  for (const double share : { 0.01, 0.05 })
  {
    auto input = sphereInput<Dim>();
    const auto n = static_cast<double>(input.Positions.cols());
    addOutliers(input, static_cast<Eigen::Index>(share * n));
    const auto result = fitHierarchical(unitLattice<Dim>(64), input, HierarchicalOptions{});
    // Those that happen to lie near the sphere are not told from its points.
    EXPECT_NEAR(result.Faults.shareOfOutliers(), share / (1 + share), 0.2 * share) << share;
    ASSERT_FALSE(result.Outliers.empty()) << share;
    EXPECT_EQ(static_cast<double>(result.Outliers.size()), result.Faults.Outliers) << share;
    EXPECT_TRUE(std::is_sorted(result.Outliers.begin(), result.Outliers.end())) << share;
    EXPECT_GE(result.Outliers.front(), static_cast<std::int64_t>(n)) << "a point of the sphere";
    EXPECT_EQ(result.Faults.shareOfFlippedNormals(), 0) << share;
    EXPECT_EQ(result.SmoothingLength, 0) << share;
    EXPECT_LT(largestMiss(result), 2e-3) << share;
    // The errors are those of all points.
    EXPECT_GT(result.Reports.back().MaximumError, 0.02) << share;
  }
}

TYPED_TEST(SampleChecks, GivesTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  auto input = sphereInput<Dim>();
  flip(input, 0.1);
  addOutliers(input, input.Positions.cols() / 50);
  HierarchicalOptions options;
  options.Threads = 1;
  const auto one = fitHierarchical(unitLattice<Dim>(48), input, options);
  EXPECT_GT(one.Faults.shareOfOutliers(), 0);
  EXPECT_GT(one.Faults.shareOfFlippedNormals(), 0);
  for (const int threads : { 1, 2, 4 })
  {
    options.Threads = threads;
    const auto other = fitHierarchical(unitLattice<Dim>(48), input, options);
    EXPECT_TRUE(test::sameBits(one.Function->coefficients(), other.Function->coefficients()))
      << threads << " threads";
    EXPECT_EQ(one.Faults.shareOfOutliers(), other.Faults.shareOfOutliers());
    EXPECT_EQ(one.Faults.shareOfFlippedNormals(), other.Faults.shareOfFlippedNormals());
  }
}

TYPED_TEST(SampleChecks, ThinPartsAreNotFlipped)
{
  // The two sides of a sheet, of whose normals the fit of a coarse level follows one half at most.
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unitLattice<Dim>(64);
  const int side = Dim == 2 ? 400 : 60;
  HermiteInput<Dim> input;
  const Eigen::Index n = static_cast<Eigen::Index>(std::pow(side, Dim - 1));
  input.Positions.resize(Dim, 2 * n);
  input.Normals.resize(Dim, 2 * n);
  for (Eigen::Index k = 0; k < 2 * n; ++k)
  {
    Eigen::Index rest = k % n;
    for (int a = 0; a + 1 < Dim; ++a, rest /= side)
    {
      input.Positions(a, k) = 0.1 + 0.8 * (static_cast<double>(rest % side) + 0.5) / side;
    }
    const double sign = k < n ? 1 : -1;
    input.Positions(Dim - 1, k) = 0.5 + sign * 0.25 / 64;
    input.Normals.col(k) = sign * Point<Dim>::Unit(Dim - 1);
  }
  const Samples<Dim> samples = sortedSamples(lattice, input, 1);
  std::vector<SampleCheck> checks(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    // As if f rose along the last axis everywhere.
    checks[k].Agreement = static_cast<float>(samples[k].Normal[Dim - 1]);
  }
  const SampleFaults faults = findFaults(samples, checks, {}, 1);
  EXPECT_EQ(faults.Flipped, 0);
  EXPECT_EQ(faults.Outliers, 0);
}

TYPED_TEST(SampleChecks, SpacingIsThatOfPointsWithNeighbours)
{
  constexpr int Dim = TypeParam::value;
  auto input = sphereInput<Dim>();
  Box<Dim> box;
  box.Lower.setZero();
  box.Upper.setOnes();
  const double clean = pointSpacing(input.Positions, box);
  EXPECT_EQ(robustPointSpacing(input.Positions, box, 0), clean)
    << "without lone points the same bits";
  addOutliers(input, input.Positions.cols() / 20);
  const double coarser = pointSpacing(input.Positions, box) - clean;
  EXPECT_GT(coarser, 0.08 * clean);
  EXPECT_LT(std::abs(robustPointSpacing(input.Positions, box, 0) - clean), 0.4 * coarser);
}
}
