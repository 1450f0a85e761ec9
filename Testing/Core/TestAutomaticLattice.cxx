// SPDX-License-Identifier: BSD-3-Clause
#include "AutomaticLattice.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;

template <int Dim>
Box<Dim> boxOf(const Points<Dim>& points)
{
  return { points.rowwise().minCoeff(), points.rowwise().maxCoeff() };
}

template <int Dim>
Box<Dim> unevenBox()
{
  Box<Dim> box;
  for (int a = 0; a < Dim; ++a)
  {
    box.Lower[a] = 5 - 2 * a;
    box.Upper[a] = box.Lower[a] + 3 + 1.7 * a;
  }
  return box;
}

/// side^(Dim - 1) points at distance @a spacing on a flat sheet (a line in 2-D).
template <int Dim>
Points<Dim> sheet(int side, double spacing)
{
  const int n = Dim == 3 ? side * side : side;
  Points<Dim> points = Points<Dim>::Constant(Dim, n, 12.5);
  for (int k = 0; k < n; ++k)
  {
    points(0, k) += spacing * (k % side);
    if (Dim == 3)
    {
      points(1, k) += spacing * (k / side);
    }
  }
  return points;
}

template <typename T>
class AutomaticLattice : public ::testing::Test
{
};
TYPED_TEST_SUITE(AutomaticLattice, ipia::test::Dimensions);

TYPED_TEST(AutomaticLattice, FindsTheSpacingOfRegularGrids)
{
  constexpr int Dim = TypeParam::value;
  for (const int side : { 32, 100, 200 })
  {
    for (const double spacing : { 1e-6, 0.25, 1e6 })
    {
      const Points<Dim> points = sheet<Dim>(side, spacing);
      const double found = pointSpacing<Dim>(points, boxOf<Dim>(points));
      EXPECT_NEAR(found, spacing, 0.1 * spacing) << side << " points a side";
    }
  }
}

TYPED_TEST(AutomaticLattice, FindsTheSpacingOnRoundShapes)
{
  constexpr int Dim = TypeParam::value;
  for (const std::int64_t n : { 500, 5000 })
  {
    const Points<Dim> points =
      ipia::test::spherePoints<Dim>(Point<Dim>::Constant(3), 2, n).Positions;
    const double perPoint = Dim == 2 ? 4 * ipia::test::Pi / static_cast<double>(n)
                                     : std::sqrt(16 * ipia::test::Pi / static_cast<double>(n));
    const double found = pointSpacing<Dim>(points, boxOf<Dim>(points));
    EXPECT_GT(found, perPoint / 1.5);
    EXPECT_LT(found, perPoint * 1.5);
  }
}

TYPED_TEST(AutomaticLattice, SpacingIgnoresDuplicatesAndOrder)
{
  constexpr int Dim = TypeParam::value;
  const Points<Dim> points = sheet<Dim>(50, 0.5);
  const Points<Dim> twice = points.rowwise().reverse().replicate(1, 2);
  EXPECT_EQ(
    pointSpacing<Dim>(points, boxOf<Dim>(points)), pointSpacing<Dim>(twice, boxOf<Dim>(twice)));
}

TYPED_TEST(AutomaticLattice, SpacingOfNothingIsZero)
{
  constexpr int Dim = TypeParam::value;
  const Box<Dim> none{ Point<Dim>::Zero(), Point<Dim>::Zero() };
  EXPECT_EQ(pointSpacing<Dim>(Points<Dim>(Dim, 0), none), 0);
  const Points<Dim> equal = Points<Dim>::Constant(Dim, 9, 4.0);
  EXPECT_EQ(pointSpacing<Dim>(equal, boxOf<Dim>(equal)), 0);
}

template <int Dim>
void expectMargins(const PlacedLattice<Dim>& placed, const Box<Dim>& box, double padding)
{
  const double h = placed.Grid.Spacing[0];
  const double margin = std::max(padding * box.sides().maxCoeff(), MarginInKnotSpacings * h);
  for (int a = 0; a < Dim; ++a)
  {
    EXPECT_EQ(placed.Grid.Spacing[a], h) << "one spacing for all axes";
    const double below = box.Lower[a] - placed.Lower[a];
    const double above = placed.Lower[a] + placed.Grid.extent(a) - box.Upper[a];
    EXPECT_GE(below, margin * (1 - 1e-9));
    EXPECT_GE(above, margin * (1 - 1e-9));
  }
}

TYPED_TEST(AutomaticLattice, FollowsTheWantedSpacing)
{
  constexpr int Dim = TypeParam::value;
  const Box<Dim> box = unevenBox<Dim>();
  for (const double padding : { 0.0, 0.1, 0.5 })
  {
    for (const double spacing : { 0.05, 0.31, 2.0 })
    {
      const PlacedLattice<Dim> placed = latticeAround<Dim>(box, padding, Index<Dim>{}, spacing);
      EXPECT_EQ(placed.Grid.Spacing[0], spacing);
      expectMargins(placed, box, padding);
      const double margin =
        std::max(padding * box.sides().maxCoeff(), MarginInKnotSpacings * spacing);
      for (int a = 0; a < Dim; ++a)
      {
        EXPECT_NEAR(placed.Lower[a], box.Lower[a] - margin, 1e-12) << "only hi grows";
        EXPECT_LT(placed.Grid.extent(a), box.sides()[a] + 2 * margin + spacing)
          << "by less than one spacing";
      }
    }
  }
}

TYPED_TEST(AutomaticLattice, KeepsGivenSizes)
{
  constexpr int Dim = TypeParam::value;
  const Box<Dim> box = unevenBox<Dim>();
  for (const double padding : { 0.0, 0.1, 0.5 })
  {
    for (int given = 1; given < (1 << Dim); ++given)
    {
      Index<Dim> size{};
      for (int a = 0; a < Dim; ++a)
      {
        size[a] = (given >> a) & 1 ? 20 + 7 * a : 0;
      }
      const PlacedLattice<Dim> placed = latticeAround<Dim>(box, padding, size, 0.1);
      for (int a = 0; a < Dim; ++a)
      {
        EXPECT_GE(placed.Grid.Size[a], 4);
        if (size[a] > 0)
        {
          EXPECT_EQ(placed.Grid.Size[a], size[a]);
        }
      }
      expectMargins(placed, box, padding);
    }
  }
}

TYPED_TEST(AutomaticLattice, CentresTheBoxWhereTheSizeLeavesNoMargin)
{
  constexpr int Dim = TypeParam::value;
  const Box<Dim> box = unevenBox<Dim>();
  for (const std::int64_t n : { 4, 5, 7 })
  {
    Index<Dim> size;
    size.fill(n);
    const PlacedLattice<Dim> placed = latticeAround<Dim>(box, 0.1, size, 0.1);
    for (int a = 0; a < Dim; ++a)
    {
      EXPECT_EQ(placed.Grid.Size[a], n);
      EXPECT_LE(placed.Lower[a], box.Lower[a]);
      EXPECT_GE(placed.Lower[a] + placed.Grid.extent(a), box.Upper[a] - 1e-12);
    }
  }
}

TYPED_TEST(AutomaticLattice, IsOnExactlyTheGivenBox)
{
  constexpr int Dim = TypeParam::value;
  const Box<Dim> box = unevenBox<Dim>();
  Index<Dim> size{};
  size[1] = 33;
  for (const double spacing : { 0.05, 0.31, 100.0 })
  {
    const PlacedLattice<Dim> placed = latticeOn<Dim>(box, size, spacing);
    EXPECT_EQ(placed.Lower, box.Lower);
    EXPECT_EQ(placed.Grid.Size[1], 33);
    for (int a = 0; a < Dim; ++a)
    {
      EXPECT_NEAR(placed.Grid.extent(a), box.sides()[a], 1e-13);
      EXPECT_GE(placed.Grid.Size[a], 4);
      if (size[a] == 0)
      {
        EXPECT_LE(placed.Grid.Spacing[a], spacing * (1 + 1e-9)) << "not coarser than wanted";
        EXPECT_GT(placed.Grid.Spacing[a] * (placed.Grid.Size[a] > 4 ? 2 : 1e9), spacing)
          << "nor much finer";
      }
    }
  }
}

TYPED_TEST(AutomaticLattice, ASpacingThatDividesTheBoxIsKept)
{
  constexpr int Dim = TypeParam::value;
  const Box<Dim> box{ Point<Dim>::Zero(), Point<Dim>::Constant(0.7) };
  const PlacedLattice<Dim> placed = latticeOn<Dim>(box, Index<Dim>{}, 0.1);
  for (int a = 0; a < Dim; ++a)
  {
    EXPECT_EQ(placed.Grid.Size[a], 7 + 3) << "rounding adds no cell";
  }
}
}
