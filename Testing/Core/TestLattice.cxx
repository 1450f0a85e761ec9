// SPDX-License-Identifier: BSD-3-Clause
#include "Lattice.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;

template <typename T>
class LatticeTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(LatticeTest, ipia::test::Dimensions);

TYPED_TEST(LatticeTest, CountsCoefficientsAndCells)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  EXPECT_EQ(lattice.numberOfCoefficients(), Dim == 2 ? 9 * 8 : 9 * 8 * 7);
  EXPECT_EQ(lattice.numberOfCells(), Dim == 2 ? 6 * 5 : 6 * 5 * 4);
  EXPECT_DOUBLE_EQ(lattice.extent(0), 6 * 0.3);
  EXPECT_DOUBLE_EQ(lattice.extent(1), 5 * 0.5);
}

TYPED_TEST(LatticeTest, NumbersXFastest)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  Index<Dim> i{};
  EXPECT_EQ(lattice.coefficientIndex(i), 0);
  i[0] = 1;
  EXPECT_EQ(lattice.coefficientIndex(i), 1);
  EXPECT_EQ(lattice.cellIndex(i), 1);
  i = {};
  i[1] = 1;
  EXPECT_EQ(lattice.coefficientIndex(i), 9);
  EXPECT_EQ(lattice.cellIndex(i), 6);
  i = {};
  i[Dim - 1] = 2;
  EXPECT_EQ(lattice.coefficientIndex(i), Dim == 2 ? 18 : 2 * 72);
  EXPECT_EQ(lattice.cellIndex(i), Dim == 2 ? 12 : 2 * 30);
}

TYPED_TEST(LatticeTest, TheLastCellIsClosed)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  for (int a = 0; a < Dim; ++a)
  {
    const AxisLocation lower = lattice.locate(0, a);
    EXPECT_EQ(lower.Cell, 0);
    EXPECT_EQ(lower.T, 0);
    const AxisLocation upper = lattice.locate(lattice.extent(a), a);
    EXPECT_EQ(upper.Cell, lattice.cells(a) - 1);
    EXPECT_NEAR(upper.T, 1, 1e-14);
    const AxisLocation knot = lattice.locate(2 * lattice.Spacing[a], a);
    EXPECT_EQ(knot.Cell, 2) << "cells are half open";
    EXPECT_EQ(knot.T, 0);
    EXPECT_EQ(lattice.locate(-lattice.Spacing[a], a).Cell, 0);
    EXPECT_EQ(lattice.locate(2 * lattice.extent(a), a).Cell, lattice.cells(a) - 1);
  }
}

TYPED_TEST(LatticeTest, LocatesBoxesWhateverTheRounding)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  std::int64_t number = 1;
  for (int a = 0; a < Dim; ++a)
  {
    const double h = lattice.Spacing[a];
    const std::int64_t boxes = 2 * lattice.cells(a) + 1;
    EXPECT_EQ(lattice.boxes(a), boxes);
    number *= boxes;
    for (std::int64_t i = 0; i < boxes; ++i)
    {
      const double centre = static_cast<double>(i) * h / 2;
      for (const double rounding : { -1e-10 * h, 0.0, 1e-10 * h })
      {
        EXPECT_EQ(lattice.locateBox(centre + rounding, a), i) << "a default sample";
        EXPECT_EQ(lattice.locateBox(centre - h / 4 + rounding, a), i) << "on the border of two";
      }
      EXPECT_EQ(lattice.locateBox(centre + 0.2499 * h, a), i);
    }
    EXPECT_EQ(lattice.locateBox(-h, a), 0);
    EXPECT_EQ(lattice.locateBox(lattice.extent(a) + h, a), boxes - 1);
  }
  EXPECT_EQ(lattice.numberOfBoxes(), number);
}

TYPED_TEST(LatticeTest, TheDomainIsClosed)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  EXPECT_TRUE(lattice.contains(Point<Dim>::Zero()));
  EXPECT_TRUE(lattice.contains(ipia::test::extents(lattice)));
  for (int a = 0; a < Dim; ++a)
  {
    Point<Dim> outside = ipia::test::extents(lattice) / 2;
    outside[a] = lattice.extent(a) * (1 + 1e-9);
    EXPECT_FALSE(lattice.contains(outside));
    outside[a] = -1e-9 * lattice.extent(a);
    EXPECT_FALSE(lattice.contains(outside));
    outside[a] = std::nan("");
    EXPECT_FALSE(lattice.contains(outside));
  }
}
}
