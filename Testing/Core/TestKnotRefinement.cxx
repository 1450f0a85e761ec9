// SPDX-License-Identifier: BSD-3-Clause
#include "KnotRefinement.h"

#include "ImplicitSpline.h"
#include "TestSupport.h"

namespace
{
using namespace ipia;

/// Half the spacing; @a cropped cells fewer than twice as many on each axis.
template <int Dim>
Lattice<Dim> halved(const Lattice<Dim>& coarse, std::int64_t cropped)
{
  Lattice<Dim> fine;
  for (int a = 0; a < Dim; ++a)
  {
    fine.Size[a] = 2 * coarse.cells(a) + 3 - cropped;
    fine.Spacing[a] = coarse.Spacing[a] / 2;
  }
  return fine;
}

/// The largest difference of both splines over the domain of the finer one, its border included.
template <int Dim>
double largestDifference(const ImplicitSpline<Dim>& coarse, const ImplicitSpline<Dim>& fine)
{
  ipia::test::Random random(7);
  double largest = 0;
  for (int k = 0; k < 2000; ++k)
  {
    Point<Dim> x;
    for (int a = 0; a < Dim; ++a)
    {
      const double share = random.uniform(-0.2, 1.2);
      x[a] = std::min(std::max(share, 0.0), 1.0) * fine.lattice().extent(a);
    }
    largest = std::max(largest, std::abs(coarse.value(x) - fine.value(x)));
  }
  return largest;
}

template <typename T>
class KnotRefinement : public ::testing::Test
{
};
TYPED_TEST_SUITE(KnotRefinement, ipia::test::Dimensions);

TYPED_TEST(KnotRefinement, LeavesTheFunctionUnchanged)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> coarse = ipia::test::anisotropicLattice<Dim>();
  const Vector c = ipia::test::Random().vector(coarse.numberOfCoefficients(), -1, 1);
  const Lattice<Dim> fine = halved(coarse, 0);
  const Vector refined = refineKnots(coarse, c, fine);
  ASSERT_EQ(refined.size(), fine.numberOfCoefficients());
  EXPECT_LE(
    largestDifference(ImplicitSpline<Dim>(coarse, c), ImplicitSpline<Dim>(fine, refined)), 1e-13);
}

TYPED_TEST(KnotRefinement, CropsAtTheUpperEnd)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> coarse = ipia::test::anisotropicLattice<Dim>();
  const Vector c = ipia::test::Random().vector(coarse.numberOfCoefficients(), -1, 1);
  for (std::int64_t cropped : { 1, 2, 5 })
  {
    const Lattice<Dim> fine = halved(coarse, cropped);
    const Vector refined = refineKnots(coarse, c, fine);
    ASSERT_EQ(refined.size(), fine.numberOfCoefficients());
    EXPECT_LE(
      largestDifference(ImplicitSpline<Dim>(coarse, c), ImplicitSpline<Dim>(fine, refined)), 1e-13)
      << cropped << " cells cropped";
  }
}

TYPED_TEST(KnotRefinement, RefinesTheSmallestLattice)
{
  constexpr int Dim = TypeParam::value;
  Lattice<Dim> coarse;
  coarse.Size.fill(4);
  coarse.Spacing.setConstant(3);
  const Vector c = ipia::test::Random(3).vector(coarse.numberOfCoefficients(), -1, 1);
  for (std::int64_t cropped : { 0, 1 })
  {
    const Lattice<Dim> fine = halved(coarse, cropped);
    EXPECT_LE(largestDifference(ImplicitSpline<Dim>(coarse, c),
                ImplicitSpline<Dim>(fine, refineKnots(coarse, c, fine))),
      1e-13);
  }
}

TYPED_TEST(KnotRefinement, KeepsConstants)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> coarse = ipia::test::anisotropicLattice<Dim>();
  const Vector refined = refineKnots<Dim>(
    coarse, Vector::Constant(coarse.numberOfCoefficients(), 0.75), halved(coarse, 0));
  EXPECT_LE((refined.array() - 0.75).abs().maxCoeff(), 1e-15);
}
}
