// SPDX-License-Identifier: BSD-3-Clause
#include "BrickSpline.h"

#include "HierarchicalFit.h"
#include "TestSupport.h"

#include <map>

namespace
{
using namespace ipia;

/// A lattice of different sizes per axis, not multiples of anything.
template <int Dim>
Lattice<Dim> unevenLattice()
{
  Lattice<Dim> lattice;
  for (int a = 0; a < Dim; ++a)
  {
    lattice.Size[a] = (Dim == 2 ? 203 : 76) - 5 * a;
    lattice.Spacing[a] = 1.0 / (Dim == 2 ? 200 : 73);
  }
  return lattice;
}

/// A sphere and a small one beside it, so that some of the zero set is far from most blocks.
template <int Dim>
BrickSpline<Dim> fittedSpline(int numberOfLevels = 0)
{
  auto points = test::spherePoints<Dim>(Point<Dim>::Constant(0.4), 0.28, Dim == 2 ? 800 : 9000);
  points.append(test::spherePoints<Dim>(Point<Dim>::Constant(0.78), 0.05, Dim == 2 ? 120 : 400));
  HermiteInput<Dim> input;
  input.Positions = points.Positions;
  input.Normals = points.Normals;
  HierarchicalOptions options;
  options.NumberOfLevels = numberOfLevels;
  return *fitHierarchical(unevenLattice<Dim>(), input, options).Function;
}

template <typename T>
class BrickSplineTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(BrickSplineTest, ipia::test::Dimensions);

TYPED_TEST(BrickSplineTest, EqualsTheSplineOfItsCoefficients)
{
  constexpr int Dim = TypeParam::value;
  const BrickSpline<Dim> bricks = fittedSpline<Dim>();
  ASSERT_GE(bricks.levels().size(), 3u);
  EXPECT_LT(bricks.levels().back().numberOfActiveCoefficients(),
    bricks.lattice().numberOfCoefficients() * 3 / 4)
    << "the finest level is a band";
  const ImplicitSpline<Dim> dense(bricks.lattice(), bricks.coefficients());
  test::Random random(3);
  for (int k = 0; k < 2000; ++k)
  {
    Point<Dim> x;
    for (int a = 0; a < Dim; ++a)
    {
      x[a] = random.uniform(-0.2, 1.2); // some beyond the domain
    }
    Point<Dim> g;
    const double f = bricks.valueAndGradient(x, g);
    EXPECT_EQ(f, bricks.value(x));
    EXPECT_NEAR(f, dense.value(x), 1e-6);
    EXPECT_NEAR((g - dense.gradient(x)).norm(), 0, 1e-4);
  }
}

TYPED_TEST(BrickSplineTest, BlocksHoldEveryChangeOfSign)
{
  constexpr int Dim = TypeParam::value;
  for (const int levels : { 0, 1 })
  {
    const BrickSpline<Dim> bricks = fittedSpline<Dim>(levels);
    const Lattice<Dim>& lattice = bricks.lattice();
    const ImplicitSpline<Dim> dense(lattice, bricks.coefficients());
    std::vector<char> visited(static_cast<std::size_t>(lattice.numberOfCells()), 0);
    std::map<std::int64_t, double> seen; // by coefficient
    std::size_t blocks = 0;
    for (const auto& part : bricks.zeroSetParts())
    {
      bricks.forZeroSetBlocks(part,
        [&](const typename BrickSpline<Dim>::Block& block)
        {
          ++blocks;
          const auto function = bricks.blockFunction(block);
          const ImplicitSpline<Dim>& local = function.Spline;
          for (std::int64_t i = 0; i < local.coefficients().size(); ++i)
          {
            Index<Dim> at;
            bool inside = true;
            std::int64_t rest = i;
            for (int a = 0; a < Dim; ++a)
            {
              const std::int64_t k = rest % local.lattice().Size[a];
              at[a] = function.Corner[a] + k;
              inside = inside && k >= function.Begin[a] && k < function.End[a];
              rest /= local.lattice().Size[a];
            }
            const std::int64_t index = lattice.coefficientIndex(at);
            EXPECT_NEAR(local.coefficients()[i], dense.coefficients()[index], 1e-6);
            const auto entry = seen.emplace(index, local.coefficients()[i]).first;
            ASSERT_EQ(entry->second, local.coefficients()[i]) << "blocks agree on what they share";
            if (inside)
            {
              visited[static_cast<std::size_t>(lattice.cellIndex(at))] = 1;
            }
          }
        });
    }
    EXPECT_GT(blocks, 0u);
    AxisPositions<Dim> positions;
    std::int64_t n = 1;
    for (int a = 0; a < Dim; ++a)
    {
      for (std::int64_t i = 0; i < lattice.cells(a); ++i)
      {
        positions[a].push_back((static_cast<double>(i) + 0.25) * lattice.Spacing[a]);
        positions[a].push_back((static_cast<double>(i) + 0.75) * lattice.Spacing[a]);
      }
      n *= 2 * lattice.cells(a);
    }
    std::vector<double> f(static_cast<std::size_t>(n));
    dense.sample(positions, f.data(), 1);
    std::vector<char> low(visited.size(), 0), high(visited.size(), 0);
    for (std::int64_t k = 0; k < n; ++k)
    {
      Index<Dim> cell;
      std::int64_t rest = k;
      for (int a = 0; a < Dim; ++a)
      {
        cell[a] = rest % (2 * lattice.cells(a)) / 2;
        rest /= 2 * lattice.cells(a);
      }
      const auto c = static_cast<std::size_t>(lattice.cellIndex(cell));
      (f[static_cast<std::size_t>(k)] < 0 ? low : high)[c] = 1;
    }
    std::size_t crossed = 0, skipped = 0;
    for (std::size_t c = 0; c < visited.size(); ++c)
    {
      crossed += low[c] && high[c];
      skipped += !visited[c];
      EXPECT_TRUE(visited[c] || !(low[c] && high[c]));
    }
    EXPECT_GT(crossed, 0u);
    EXPECT_GT(skipped, 0u) << "blocks without zeros are left out";
  }
}
}
