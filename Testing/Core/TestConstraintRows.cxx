// SPDX-License-Identifier: BSD-3-Clause
#include "ConstraintRows.h"

#include "TestSupport.h"

#include <map>
#include <set>
#include <tuple>

namespace
{
using namespace ipia;

/// The coefficients that a cell touches, from the flat index of its first one.
template <int Dim>
std::set<std::int64_t> touched(const Lattice<Dim>& lattice, std::int64_t first)
{
  std::set<std::int64_t> all;
  for (std::int64_t k = 0; k < (Dim == 3 ? 4 : 1); ++k)
  {
    for (std::int64_t j = 0; j < 4; ++j)
    {
      for (std::int64_t i = 0; i < 4; ++i)
      {
        all.insert(first + i + lattice.Size[0] * (j + lattice.Size[1] * k));
      }
    }
  }
  return all;
}

/// A lattice of several tiles per colour, the last ones narrower.
template <int Dim>
Lattice<Dim> tiledLattice()
{
  Lattice<Dim> lattice;
  lattice.Size.fill(4 * 5 + 2 + 3);
  lattice.Spacing.setConstant(0.25);
  return lattice;
}

template <typename T>
class ConstraintRowsTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(ConstraintRowsTest, ipia::test::Dimensions);

TYPED_TEST(ConstraintRowsTest, KeepEveryRowOnceInItsCell)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = tiledLattice<Dim>();
  ipia::test::Random random;
  Points<Dim> positions = random.pointsIn(lattice, 700);
  positions.col(0).setZero();
  positions.col(1) = ipia::test::extents(lattice);
  positions.col(2) = positions.col(3);
  const Vector targets = random.vector(700, -1, 1), weights = random.vector(700, 0, 2);
  for (const int barAxis : { 0, 1 })
  {
    const ConstraintRows<Dim> rows(lattice, positions, targets, weights, barAxis);
    ASSERT_EQ(rows.size(), 700);

    std::map<double, std::int64_t> cellOfTarget;
    std::map<double, double> weightOfTarget;
    const std::int64_t cells = rows.tileBegin(rows.numberOfTiles());
    std::int64_t seen = 0;
    for (std::int64_t c = 0; c < cells; ++c)
    {
      EXPECT_EQ(rows.cells()[c].Begin, seen) << "cells follow one another without a gap";
      EXPECT_LT(rows.cells()[c].Begin, rows.cells()[c + 1].Begin) << "only occupied cells";
      for (; seen < rows.cells()[c + 1].Begin; ++seen)
      {
        const ConstraintRow<Dim>& row = rows.rows()[seen];
        cellOfTarget[row.Target] = rows.cells()[c].Coefficient;
        weightOfTarget[row.Target] = row.Weight;
        for (double t : row.T)
        {
          EXPECT_TRUE(t >= 0 && t <= 1 + 1e-14);
        }
      }
    }
    EXPECT_EQ(seen, 700);
    for (std::int64_t k = 0; k < 700; ++k)
    {
      Index<Dim> cell;
      for (int a = 0; a < Dim; ++a)
      {
        cell[a] = lattice.locate(positions(a, k), a).Cell;
      }
      ASSERT_EQ(cellOfTarget.count(targets[k]), 1u);
      EXPECT_EQ(cellOfTarget[targets[k]], lattice.coefficientIndex(cell));
      EXPECT_EQ(weightOfTarget[targets[k]], weights[k]);
    }
  }
}

TYPED_TEST(ConstraintRowsTest, HaveWeightOneByDefault)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = tiledLattice<Dim>();
  const ConstraintRows<Dim> rows(
    lattice, ipia::test::Random().pointsIn(lattice, 20), Vector::Zero(20), Vector());
  for (std::int64_t k = 0; k < rows.size(); ++k)
  {
    EXPECT_EQ(rows.rows()[k].Weight, 1);
  }
}

TYPED_TEST(ConstraintRowsTest, TilesOfOneColourTouchDisjointCoefficients)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = tiledLattice<Dim>();
  const std::int64_t n = 40 * lattice.numberOfCells();
  for (const int barAxis : { 0, 1 })
  {
    const ConstraintRows<Dim> rows(
      lattice, ipia::test::Random().pointsIn(lattice, n), Vector::Zero(n), Vector(), barAxis);
    EXPECT_EQ(rows.tileOfColour(0), 0);
    EXPECT_EQ(rows.tileOfColour(ConstraintRows<Dim>::NumberOfColours), rows.numberOfTiles());
    EXPECT_EQ(rows.tileBegin(rows.numberOfTiles()), lattice.numberOfCells()) << "all are occupied";
    for (int colour = 0; colour < ConstraintRows<Dim>::NumberOfColours; ++colour)
    {
      EXPECT_GE(rows.tileOfColour(colour + 1) - rows.tileOfColour(colour), Dim == 2 ? 3 : 9);
      std::set<std::int64_t> taken;
      for (std::int64_t t = rows.tileOfColour(colour); t < rows.tileOfColour(colour + 1); ++t)
      {
        std::set<std::int64_t> mine;
        for (std::int64_t c = rows.tileBegin(t); c < rows.tileBegin(t + 1); ++c)
        {
          mine.merge(touched(lattice, rows.cells()[c].Coefficient));
        }
        const std::size_t before = taken.size(), more = mine.size();
        taken.merge(mine);
        EXPECT_EQ(taken.size(), before + more) << "colour " << colour << ", tile " << t;
      }
    }
  }
}

TYPED_TEST(ConstraintRowsTest, MayBeNone)
{
  constexpr int Dim = TypeParam::value;
  const ConstraintRows<Dim> rows(tiledLattice<Dim>(), Points<Dim>(Dim, 0), Vector(), Vector());
  EXPECT_EQ(rows.size(), 0);
  EXPECT_EQ(rows.tileBegin(rows.numberOfTiles()), 0);
}
}
