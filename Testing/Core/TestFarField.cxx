// SPDX-License-Identifier: BSD-3-Clause
#include "FarField.h"

#include "ImplicitFit.h"
#include "TestSupport.h"

namespace
{
using namespace ipia;
using ipia::test::OrientedPoints;
using ipia::test::spherePoints;

const double Threshold = FarFieldOptions().Threshold;

/// The domain of these tests is [0, 4]^Dim.
template <int Dim>
Lattice<Dim> cube(std::int64_t cells)
{
  return test::cubeLattice<Dim>(4, cells);
}

/// Two-sided offsets of one knot spacing, conjugate gradients.
template <int Dim>
FitResult<Dim> fit(const Lattice<Dim>& lattice, const OrientedPoints<Dim>& points, double threshold)
{
  FitInput<Dim> input;
  input.Positions = points.Positions;
  input.Normals = points.Normals;
  input.OutwardDistance = Vector::Constant(points.Positions.cols(), lattice.Spacing[0]);
  input.InwardDistance = input.OutwardDistance;
  FitOptions options;
  options.Solver.Type = SolverType::ConjugateGradient;
  options.Solver.MaximumNumberOfIterations = 15;
  options.FarField.Threshold = threshold;
  options.FarField.Magnitude = lattice.Spacing[0];
  return fitImplicit(lattice, input, options);
}

/// How many connected regions of f < 0 and of f >= 0 a contour filter would separate.
struct Regions
{
  int Negative = 0, Positive = 0;
};

template <int Dim>
Regions countRegions(const ImplicitSpline<Dim>& function)
{
  constexpr std::int64_t n = 81;
  AxisPositions<Dim> positions;
  std::int64_t size = 1;
  for (int a = 0; a < Dim; ++a)
  {
    for (std::int64_t k = 0; k < n; ++k)
    {
      positions[a].push_back(function.lattice().extent(a) * static_cast<double>(k) / (n - 1));
    }
    size *= n;
  }
  std::vector<float> f(static_cast<std::size_t>(size));
  function.sample(positions, f.data());

  Regions regions;
  std::vector<char> seen(f.size(), 0);
  std::vector<std::int64_t> front;
  for (std::int64_t seed = 0; seed < size; ++seed)
  {
    if (seen[static_cast<std::size_t>(seed)])
    {
      continue;
    }
    const bool negative = f[static_cast<std::size_t>(seed)] < 0;
    ++(negative ? regions.Negative : regions.Positive);
    front.assign(1, seed);
    seen[static_cast<std::size_t>(seed)] = 1;
    while (!front.empty())
    {
      const std::int64_t at = front.back();
      front.pop_back();
      std::int64_t stride = 1;
      for (int a = 0; a < Dim; ++a, stride *= n)
      {
        const std::int64_t i = at / stride % n;
        for (const std::int64_t next : { i > 0 ? at - stride : at, i + 1 < n ? at + stride : at })
        {
          const auto k = static_cast<std::size_t>(next);
          if (!seen[k] && (f[k] < 0) == negative)
          {
            seen[k] = 1;
            front.push_back(next);
          }
        }
      }
    }
  }
  return regions;
}

/// Calls check(sign, centre) for every box.
template <int Dim, typename Check>
void forBoxes(const ImplicitSpline<Dim>& function, const Check& check)
{
  const Lattice<Dim>& lattice = function.lattice();
  ASSERT_EQ(function.farField().Sign.size(), static_cast<std::size_t>(lattice.numberOfBoxes()));
  for (std::int64_t b = 0; b < lattice.numberOfBoxes(); ++b)
  {
    Point<Dim> centre;
    std::int64_t rest = b;
    for (int a = 0; a < Dim; ++a)
    {
      centre[a] = static_cast<double>(rest % lattice.boxes(a)) / 2 * lattice.Spacing[a];
      rest /= lattice.boxes(a);
    }
    check(function.farField().Sign[static_cast<std::size_t>(b)], centre);
  }
}

template <int Dim>
Point<Dim> middle()
{
  return Point<Dim>::Constant(2);
}

template <typename T>
class FarFieldTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(FarFieldTest, ipia::test::Dimensions);

TYPED_TEST(FarFieldTest, ClosedShapeIsNegativeInsidePositiveOutside)
{
  constexpr int Dim = TypeParam::value;
  constexpr double radius = 1.5;
  const FitResult<Dim> result = fit<Dim>(
    cube<Dim>(32), spherePoints<Dim>(middle<Dim>(), radius, Dim == 2 ? 200 : 4000), Threshold);
  int inside = 0, outside = 0;
  forBoxes<Dim>(result.Function,
    [&](int sign, const Point<Dim>& x)
    {
      const double distance = (x - middle<Dim>()).norm() - radius;
      if (std::abs(distance) > 5 * 4.0 / 32)
      {
        EXPECT_EQ(sign, distance < 0 ? -1 : 1) << "no row reaches this box";
      }
      if (std::abs(distance) < 0.25 * 4.0 / 32)
      {
        EXPECT_EQ(sign, 0) << "the spline counts at the data";
      }
      inside += sign < 0;
      outside += sign > 0;
      EXPECT_TRUE(sign == 0 || sign == (distance < 0 ? -1 : 1));
    });
  EXPECT_GT(inside, 0);
  EXPECT_GT(outside, 0);
  EXPECT_EQ(result.Function.value(middle<Dim>()), -4.0 / 32);
  EXPECT_EQ(result.Function.value(Point<Dim>::Zero()), 4.0 / 32);
  EXPECT_EQ(result.Function.farField().NumberOfMixedRegions, 0);
  const Regions regions = countRegions(result.Function);
  EXPECT_EQ(regions.Negative, 1);
  EXPECT_EQ(regions.Positive, 1);
}

/// Why there is a far field at all: without it the same fit has sheets that no data ask for.
TYPED_TEST(FarFieldTest, WithoutItASecondSheetAppears)
{
  constexpr int Dim = TypeParam::value;
  const FitResult<Dim> result =
    fit<Dim>(cube<Dim>(32), spherePoints<Dim>(middle<Dim>(), 1.5, Dim == 2 ? 200 : 4000), 0);
  EXPECT_TRUE(result.Function.farField().Sign.empty());
  EXPECT_EQ(result.Function.value(middle<Dim>()), 0);
  const Regions regions = countRegions(result.Function);
  EXPECT_GT(regions.Negative + regions.Positive, 2);
  EXPECT_GT(regions.Positive, 1) << "zeros inside the band count as outside";
}

TYPED_TEST(FarFieldTest, NestedSpheresEncloseAShell)
{
  constexpr int Dim = TypeParam::value;
  OrientedPoints<Dim> points = spherePoints<Dim>(middle<Dim>(), 1.7, Dim == 2 ? 250 : 8000);
  OrientedPoints<Dim> hollow = spherePoints<Dim>(middle<Dim>(), 0.8, Dim == 2 ? 120 : 1800);
  hollow.Normals *= -1;
  points.append(hollow);
  const FitResult<Dim> result = fit<Dim>(cube<Dim>(40), points, Threshold);
  EXPECT_GT(result.Function.value(middle<Dim>()), 0);
  EXPECT_LT(result.Function.value(middle<Dim>() + 1.25 * Point<Dim>::Unit(1)), 0);
  EXPECT_GT(result.Function.value(Point<Dim>::Constant(0.1)), 0);
  EXPECT_EQ(result.Function.farField().NumberOfMixedRegions, 0);
  const Regions regions = countRegions(result.Function);
  EXPECT_EQ(regions.Negative, 1);
  EXPECT_EQ(regions.Positive, 2);
}

TYPED_TEST(FarFieldTest, AnOpenSheetHasAMixedRegion)
{
  constexpr int Dim = TypeParam::value;
  const OrientedPoints<Dim> all = spherePoints<Dim>(middle<Dim>(), 1.5, Dim == 2 ? 200 : 4000);
  OrientedPoints<Dim> half{ Points<Dim>(Dim, 0), Points<Dim>(Dim, 0) };
  for (Eigen::Index k = 0; k < all.Positions.cols(); ++k)
  {
    if (all.Normals(Dim - 1, k) > 0)
    {
      half.append({ all.Positions.col(k), all.Normals.col(k) });
    }
  }
  EXPECT_EQ(fit<Dim>(cube<Dim>(32), half, Threshold).Function.farField().NumberOfMixedRegions, 1);
}

TYPED_TEST(FarFieldTest, ASheetAcrossTheDomainHasNone)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = cube<Dim>(24);
  const int side = 97, n = Dim == 2 ? side : side * side;
  OrientedPoints<Dim> sheet{ Points<Dim>(Dim, n), Points<Dim>::Zero(Dim, n) };
  for (int k = 0; k < n; ++k)
  {
    sheet.Positions(0, k) = 4.0 * (k % side) / (side - 1);
    sheet.Positions(1, k) = 4.0 * (k / side) / (side - 1);
    sheet.Positions(Dim - 1, k) = 2.1;
    sheet.Normals(Dim - 1, k) = 1;
  }
  const FitResult<Dim> result = fit<Dim>(lattice, sheet, Threshold);
  EXPECT_EQ(result.Function.farField().NumberOfMixedRegions, 0);
  Point<Dim> x = middle<Dim>();
  x[Dim - 1] = 0.2;
  EXPECT_LT(result.Function.value(x), 0);
  x[Dim - 1] = 3.8;
  EXPECT_GT(result.Function.value(x), 0);
}

/// A spline that is 1 but for a bubble of -1 in the middle, supported everywhere.
template <int Dim>
Vector bubble(const Lattice<Dim>& lattice)
{
  Vector c = Vector::Ones(lattice.numberOfCoefficients());
  for (std::int64_t i = 0; i < c.size(); ++i)
  {
    double squared = 0;
    std::int64_t rest = i;
    for (int a = 0; a < Dim; ++a)
    {
      const double x = static_cast<double>(rest % lattice.Size[a] - 1) * lattice.Spacing[a] - 2;
      squared += x * x;
      rest /= lattice.Size[a];
    }
    c[i] = squared < 0.5 * 0.5 ? -1 : 1;
  }
  return c;
}

TYPED_TEST(FarFieldTest, ASignThatNothingVouchesForIsFlipped)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = cube<Dim>(20);
  const Vector support = Vector::Ones(lattice.numberOfCoefficients()), c = bubble(lattice);
  const Points<Dim> nothing(Dim, 0), corner = Points<Dim>::Constant(Dim, 1, 0.3),
                                     centre = middle<Dim>();
  FarFieldOptions options;
  options.Magnitude = 0.5;

  EXPECT_EQ(countRegions(ImplicitSpline<Dim>(lattice, c)).Negative, 1);
  const FarField flipped =
    computeFarField<Dim>(lattice, support, c, corner, nothing, nothing, options);
  const ImplicitSpline<Dim> without(lattice, c, flipped);
  EXPECT_EQ(without.value(middle<Dim>() + Point<Dim>::Constant(0.05)), 0.5);
  EXPECT_EQ(countRegions(without).Negative, 0);

  const FarField kept = computeFarField<Dim>(lattice, support, c, corner, centre, nothing, options);
  EXPECT_EQ(countRegions(ImplicitSpline<Dim>(lattice, c, kept)).Negative, 1)
    << "a position known to be inside vouches for the bubble";
  for (const std::int8_t sign : kept.Sign)
  {
    ASSERT_EQ(sign, 0);
  }

  const FarField held = computeFarField<Dim>(lattice, support, c, corner, nothing, centre, options);
  EXPECT_EQ(ImplicitSpline<Dim>(lattice, c, held).value(middle<Dim>()),
    ImplicitSpline<Dim>(lattice, c).value(middle<Dim>()))
    << "boxes with data are left alone";
}

TYPED_TEST(FarFieldTest, MedianSupportIsTheMedianOverThePoints)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = cube<Dim>(8);
  ipia::test::Random random(51);
  const Vector support = random.vector(lattice.numberOfCoefficients(), 0, 1);
  const Points<Dim> points = random.pointsIn(lattice, 101);
  const Vector values = ipia::test::collocationMatrix(lattice, points) * support;
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  EXPECT_NEAR(medianSupport<Dim>(lattice, support, points, 2), sorted[50], 1e-14);
  EXPECT_EQ(medianSupport<Dim>(lattice, support, Points<Dim>(Dim, 0), 1), 0);
}
}
