// SPDX-License-Identifier: BSD-3-Clause
#include "BrickLattice.h"

#include "BrickSpline.h"
#include "KnotRefinement.h"
#include "TestSupport.h"

namespace
{
using namespace ipia;

template <int Dim>
Lattice<Dim> unevenLattice(std::int64_t cells)
{
  Lattice<Dim> lattice;
  for (int a = 0; a < Dim; ++a)
  {
    lattice.Size[a] = cells + 3 - 2 * a;
    lattice.Spacing[a] = 0.5 + 0.25 * a;
  }
  return lattice;
}

template <int Dim>
Lattice<Dim> doubled(const Lattice<Dim>& fine)
{
  Lattice<Dim> coarse;
  for (int a = 0; a < Dim; ++a)
  {
    coarse.Size[a] = (fine.cells(a) + 1) / 2 + 3;
    coarse.Spacing[a] = 2 * fine.Spacing[a];
  }
  return coarse;
}

/// Where coefficient @a flat of a lattice lies in the bricks.
template <int Dim>
std::size_t indexInBricks(const BrickLattice<Dim>& bricks, std::int64_t flat)
{
  Index<Dim> brick;
  std::size_t inside = 0;
  for (int a = 0; a < Dim; ++a)
  {
    const std::int64_t i = flat % bricks.lattice().Size[a];
    flat /= bricks.lattice().Size[a];
    brick[a] = i / BrickWidth;
    inside |= static_cast<std::size_t>(i % BrickWidth) << (2 * a);
  }
  return static_cast<std::size_t>(bricks.brickAt(brick)) * BrickSize<Dim> + inside;
}

template <typename T>
class BrickLatticeTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(BrickLatticeTest, ipia::test::Dimensions);

TYPED_TEST(BrickLatticeTest, ActivatesWhatTheCellsAroundNeed)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = unevenLattice<Dim>(24);
  BrickLattice<Dim> bricks(lattice);
  Index<Dim> cell;
  cell.fill(9);
  bricks.activateAround(cell);
  bricks.storeAroundActive();
  bricks.allocate();
  std::int64_t expected = 1;
  for (int a = 0; a < Dim; ++a)
  {
    expected *= 6; // coefficients 8 .. 13
  }
  EXPECT_EQ(bricks.numberOfActiveCoefficients(), expected);
  for (std::int64_t i = 0; i < lattice.numberOfCoefficients(); ++i)
  {
    bool inside = true;
    std::int64_t rest = i;
    Index<Dim> brick;
    int bit = 0;
    for (int a = 0; a < Dim; ++a)
    {
      const std::int64_t at = rest % lattice.Size[a];
      rest /= lattice.Size[a];
      inside = inside && at >= 8 && at <= 13;
      brick[a] = at / BrickWidth;
      bit |= static_cast<int>(at % BrickWidth) << (2 * a);
    }
    const std::int32_t id = bricks.brickAt(brick);
    const bool active = id >= 0 && (bricks.activeMask(id) >> bit & 1) != 0;
    ASSERT_EQ(active, inside) << "coefficient " << i;
  }
  // Every cell that an active coefficient reaches is complete; far ones are not.
  Index<Dim> reached, far;
  reached.fill(5);
  far.fill(0);
  EXPECT_TRUE(bricks.covers(reached));
  reached.fill(13);
  EXPECT_TRUE(bricks.covers(reached));
  EXPECT_FALSE(bricks.covers(far));
}

TYPED_TEST(BrickLatticeTest, RefinesAsTheDenseLatticeDoes)
{
  constexpr int Dim = TypeParam::value;
  for (const std::int64_t cells : { 12, 13, 17 })
  {
    const Lattice<Dim> fine = unevenLattice<Dim>(cells), coarse = doubled(fine);
    BrickLattice<Dim> coarseBricks(coarse), fineBricks(fine);
    coarseBricks.activateAll();
    coarseBricks.allocate();
    fineBricks.activateAll();
    fineBricks.allocate();
    EXPECT_EQ(fineBricks.numberOfActiveCoefficients(), fine.numberOfCoefficients());
    const Vector c = test::Random().vector(coarse.numberOfCoefficients(), -1, 1);
    for (std::int64_t i = 0; i < c.size(); ++i)
    {
      coarseBricks.coefficients()[indexInBricks(coarseBricks, i)] = static_cast<float>(c[i]);
    }
    fineBricks.refineFrom(coarseBricks, 2);
    const Vector expected = refineKnots(coarse, c, fine);
    for (std::int64_t i = 0; i < expected.size(); ++i)
    {
      ASSERT_NEAR(fineBricks.coefficients()[indexInBricks(fineBricks, i)], expected[i], 1e-6);
    }
  }
}

TYPED_TEST(BrickLatticeTest, CountsTheActiveCoefficientsOfACell)
{
  constexpr int Dim = TypeParam::value;
  BrickLattice<Dim> bricks(unevenLattice<Dim>(24));
  Index<Dim> cell;
  cell.fill(9);
  bricks.activateAround(cell); // coefficients 8 .. 13 of each axis
  Index<Dim> corner{};
  bricks.activate(corner, 1); // and coefficient 0 of all axes
  bricks.storeAroundActive();
  bricks.allocate();
  for (std::int64_t at = 0; at < 18; ++at)
  {
    cell.fill(at);
    std::int64_t onAxis = 0;
    for (std::int64_t i = at; i < at + Order; ++i)
    {
      onAxis += i >= 8 && i <= 13;
    }
    const std::int64_t expected = (Dim == 2 ? 1 : onAxis) * onAxis * onAxis + (at == 0);
    EXPECT_EQ(bricks.countActive(cell), expected) << "cell " << at;
  }
}

TYPED_TEST(BrickLatticeTest, RefinesAgainOnlyWhatReadsAMarkedBrick)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> fine = unevenLattice<Dim>(29), coarse = doubled(fine);
  BrickLattice<Dim> coarseBricks(coarse), fineBricks(fine);
  coarseBricks.activateAll();
  coarseBricks.allocate();
  fineBricks.activateAll();
  fineBricks.allocate();
  test::Random random;
  for (float& c : coarseBricks.coefficients())
  {
    c = static_cast<float>(random.uniform(-1, 1));
  }
  fineBricks.refineFrom(coarseBricks, 1);
  BrickValues changed = coarseBricks.coefficients(), again = fineBricks.coefficients();
  constexpr std::int32_t changedBrick = 1;
  for (int k = 0; k < BrickSize<Dim>; ++k)
  {
    changed[changedBrick * BrickSize<Dim> + k] += 1;
  }
  std::vector<char> marked(static_cast<std::size_t>(coarseBricks.numberOfBricks()), 0);
  marked[changedBrick] = 1;
  const std::vector<char> readers = fineBricks.readers(coarseBricks, marked);
  const auto numberOfReaders = std::count(readers.begin(), readers.end(), 1);
  EXPECT_GT(numberOfReaders, 0);
  EXPECT_LT(numberOfReaders, fineBricks.numberOfBricks());
  fineBricks.refine(coarseBricks, changed, readers, 1, again);
  // As if all had been refined, within the lattice, and that differs from before nowhere else.
  coarseBricks.coefficients() = changed;
  const BrickValues before = fineBricks.coefficients();
  fineBricks.refineFrom(coarseBricks, 1);
  for (std::int64_t i = 0; i < fine.numberOfCoefficients(); ++i)
  {
    const std::size_t at = indexInBricks(fineBricks, i);
    ASSERT_EQ(again[at], fineBricks.coefficients()[at]) << "coefficient " << i;
    ASSERT_TRUE(readers[at / BrickSize<Dim>] != 0 || again[at] == before[at]);
  }
}

TYPED_TEST(BrickLatticeTest, AssemblesBandsIntoTheSameFunction)
{
  constexpr int Dim = TypeParam::value;
  // Inherited coefficients only: the assembled spline is the coarse one.
  const Lattice<Dim> fine = unevenLattice<Dim>(24), coarse = doubled(fine);
  std::vector<BrickLattice<Dim>> levels;
  levels.emplace_back(coarse);
  levels.emplace_back(fine);
  levels[0].activateAll();
  levels[0].allocate();
  Index<Dim> cell;
  cell.fill(7);
  levels[1].activateAround(cell);
  levels[1].storeAroundActive();
  levels[1].allocate();
  const Vector c = test::Random().vector(coarse.numberOfCoefficients(), -1, 1);
  for (std::int64_t i = 0; i < c.size(); ++i)
  {
    levels[0].coefficients()[indexInBricks(levels[0], i)] = static_cast<float>(c[i]);
  }
  levels[1].refineFrom(levels[0], 1);
  EXPECT_LE(
    test::relativeDifference(BrickSpline<Dim>(levels).coefficients(), refineKnots(coarse, c, fine)),
    1e-6);
}
}
