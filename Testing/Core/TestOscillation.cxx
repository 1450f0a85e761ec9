// SPDX-License-Identifier: BSD-3-Clause
#include "Oscillation.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;

template <typename T>
class Oscillation : public ::testing::Test
{
};
TYPED_TEST_SUITE(Oscillation, ipia::test::Dimensions);

TYPED_TEST(Oscillation, GradientAgreesWithCentralDifferences)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  Vector c = ipia::test::Random(3).vector(lattice.numberOfCoefficients(), -1, 1);
  Vector laplacian;
  const double value = oscillation(lattice, c, laplacian, 1);
  EXPECT_NEAR(value, oscillation(lattice, c), 1e-13 * value);
  EXPECT_NEAR(value, 2 * c.dot(laplacian), 1e-13 * value);
  const double step = 1e-4;
  for (std::int64_t i = 0; i < c.size(); ++i)
  {
    const double middle = c[i];
    c[i] = middle + step;
    const double above = oscillation(lattice, c);
    c[i] = middle - step;
    const double below = oscillation(lattice, c);
    c[i] = middle;
    EXPECT_NEAR((above - below) / (2 * step), 4 * laplacian[i], 1e-6);
  }
}

TYPED_TEST(Oscillation, IsZeroOfEqualCoefficients)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  Vector laplacian;
  EXPECT_EQ(
    oscillation(lattice, Vector::Constant(lattice.numberOfCoefficients(), 0.3), laplacian, 1), 0);
  EXPECT_TRUE(laplacian.isZero(0));
}

TYPED_TEST(Oscillation, HasTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  Lattice<Dim> lattice;
  lattice.Size.fill(Dim == 2 ? 301 : 43);
  lattice.Spacing.setOnes();
  const Vector c = ipia::test::Random(5).vector(lattice.numberOfCoefficients(), -1, 1);
  Vector reference, laplacian;
  const double value = oscillation(lattice, c, reference, 1);
  EXPECT_NEAR(value, oscillation(lattice, c), 1e-12 * value);
  for (const int threads : { 2, 4 })
  {
    EXPECT_EQ(oscillation(lattice, c, laplacian, threads), value);
    EXPECT_TRUE(ipia::test::sameBits(laplacian, reference));
  }
}
}
