// SPDX-License-Identifier: BSD-3-Clause
#include "BrickOperator.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;

/// A dense level with random rows, as bricks and as matrices from the definitions.
template <int Dim>
struct System
{
  Lattice<Dim> Grid;
  std::unique_ptr<BrickLattice<Dim>> Bricks;
  HermiteRows<Dim> Rows;
  FairingWeights Fairing;
  Eigen::MatrixXd Matrix; ///< of the normal equations
  Vector Right;           ///< their right side
  Eigen::MatrixXd Values; ///< the collocation matrix of the values alone

  explicit System(const FairingWeights& fairing)
    : Fairing(fairing)
  {
    for (int a = 0; a < Dim; ++a)
    {
      this->Grid.Size[a] = 10 - a;
      this->Grid.Spacing[a] = 0.4 + 0.1 * a;
    }
    this->Bricks = std::make_unique<BrickLattice<Dim>>(this->Grid);
    this->Bricks->activateAll();
    this->Bricks->allocate();
    const std::int64_t n = this->Grid.numberOfCoefficients();
    this->Matrix = Eigen::MatrixXd::Zero(n, n);
    this->Right = Vector::Zero(n);
    this->addRows();
    this->addFairing();
  }

  double scale(int a) const { return this->Grid.Spacing.mean() / this->Grid.Spacing[a]; }

  void addRows()
  {
    // Rows sorted by brick and cell, all in the first cell of each brick and in one beside it.
    test::Random random(3);
    std::array<std::vector<typename HermiteRows<Dim>::Brick>, 1 << Dim> coloured;
    std::vector<Point<Dim>> positions;
    for (std::int32_t b = 0; b < this->Bricks->numberOfActiveBricks(); ++b)
    {
      const auto begin = static_cast<std::int64_t>(this->Rows.Rows.size());
      std::size_t colour = 0;
      bool inside = true;
      for (int a = 0; a < Dim; ++a)
      {
        colour |= static_cast<std::size_t>(this->Bricks->position(b)[a] & 1) << a;
        inside = inside && this->Bricks->position(b)[a] * BrickWidth + 1 < this->Grid.cells(a);
      }
      for (int k = 0; k < 6 && inside; ++k)
      {
        HermiteRow<Dim> row;
        row.Cell = k < 3 ? 0 : 1;
        Point<Dim> x;
        for (int a = 0; a < Dim; ++a)
        {
          row.T[a] = static_cast<float>(random.uniform(0, 1));
          row.Slope[a] = static_cast<float>(random.uniform(-1, 1));
          x[a] = (static_cast<double>(
                    this->Bricks->position(b)[a] * BrickWidth + (a == 0 ? row.Cell : 0)) +
                   row.T[a]) *
            this->Grid.Spacing[a];
        }
        row.Value = static_cast<float>(random.uniform(-1, 1));
        row.Weight = static_cast<float>(random.uniform(0.5, 2));
        row.GradientWeight = k == 4 ? 0.F : static_cast<float>(random.uniform(0.1, 1));
        row.Source = static_cast<std::int32_t>(this->Rows.Rows.size());
        this->Rows.Rows.push_back(row);
        positions.push_back(x);
      }
      const auto end = static_cast<std::int64_t>(this->Rows.Rows.size());
      if (end > begin)
      {
        coloured[colour].push_back({ b, begin, end });
      }
    }
    for (std::size_t c = 0; c < coloured.size(); ++c)
    {
      this->Rows.ColourBegin[c] = this->Rows.Bricks.size();
      this->Rows.Bricks.insert(this->Rows.Bricks.end(), coloured[c].begin(), coloured[c].end());
    }
    this->Rows.ColourBegin[coloured.size()] = this->Rows.Bricks.size();

    Points<Dim> x(Dim, static_cast<Eigen::Index>(positions.size()));
    for (std::size_t k = 0; k < positions.size(); ++k)
    {
      x.col(static_cast<Eigen::Index>(k)) = positions[k];
    }
    this->Values = test::collocationMatrix(this->Grid, x);
    this->addNormal(
      this->Values, [](const HermiteRow<Dim>& r) { return r.Weight; },
      [](const HermiteRow<Dim>& r) { return r.Value; });
    for (int a = 0; a < Dim; ++a)
    {
      // h_a df/dx_a by central differences of the recursion; exact to 1e-9 for cubics.
      const double step = 1e-5;
      Points<Dim> low = x, high = x;
      low.row(a).array() -= step * this->Grid.Spacing[a];
      high.row(a).array() += step * this->Grid.Spacing[a];
      const Eigen::MatrixXd slopes =
        (test::collocationMatrix(this->Grid, high) - test::collocationMatrix(this->Grid, low)) /
        (2 * step);
      const double s = this->scale(a) * this->scale(a);
      this->addNormal(
        slopes, [s](const HermiteRow<Dim>& r) { return s * r.GradientWeight; },
        [a](const HermiteRow<Dim>& r) { return r.Slope[static_cast<std::size_t>(a)]; });
    }
  }

  template <typename Weight, typename Target>
  void addNormal(const Eigen::MatrixXd& rows, const Weight& weight, const Target& target)
  {
    for (Eigen::Index k = 0; k < rows.rows(); ++k)
    {
      const HermiteRow<Dim>& row = this->Rows.Rows[static_cast<std::size_t>(k)];
      this->Matrix += weight(row) * rows.row(k).transpose() * rows.row(k);
      this->Right += weight(row) * target(row) * rows.row(k).transpose();
    }
  }

  /// All differences that stay in the lattice, one by one.
  void addFairing()
  {
    const std::int64_t n = this->Grid.numberOfCoefficients();
    std::int64_t strideA = 1;
    for (int a = 0; a < Dim; ++a, strideA *= this->Grid.Size[a - 1])
    {
      const double sa = this->scale(a);
      for (std::int64_t i = 0; i < n; ++i)
      {
        const std::int64_t at = i / strideA % this->Grid.Size[a];
        if (at + 1 < this->Grid.Size[a])
        {
          this->addSquare(this->Fairing.Membrane, { { i, -sa }, { i + strideA, sa } });
        }
        if (at + 2 < this->Grid.Size[a])
        {
          this->addSquare(this->Fairing.ThinPlate,
            { { i, sa * sa }, { i + strideA, -2 * sa * sa }, { i + 2 * strideA, sa * sa } });
        }
        std::int64_t strideB = strideA * this->Grid.Size[a];
        for (int b = a + 1; b < Dim; ++b)
        {
          const double sb = this->scale(b);
          if (at + 1 < this->Grid.Size[a] &&
            i / strideB % this->Grid.Size[b] + 1 < this->Grid.Size[b])
          {
            this->addSquare(2 * this->Fairing.ThinPlate,
              { { i, sa * sb }, { i + strideA, -sa * sb }, { i + strideB, -sa * sb },
                { i + strideA + strideB, sa * sb } });
          }
          strideB *= this->Grid.Size[b];
        }
      }
    }
  }

  void addSquare(double weight, const std::vector<std::pair<std::int64_t, double>>& difference)
  {
    for (const auto& p : difference)
    {
      for (const auto& q : difference)
      {
        this->Matrix(p.first, q.first) += weight * p.second * q.second;
      }
    }
  }

  BrickValues toBricks(const Vector& v) const
  {
    BrickValues bricks(this->Bricks->coefficients().size(), 0.F);
    this->forAll(
      [&](std::int64_t flat, std::size_t index) { bricks[index] = static_cast<float>(v[flat]); });
    return bricks;
  }

  Vector fromBricks(const BrickValues& bricks) const
  {
    Vector v(this->Grid.numberOfCoefficients());
    this->forAll([&](std::int64_t flat, std::size_t index) { v[flat] = bricks[index]; });
    return v;
  }

  template <typename Action>
  void forAll(const Action& action) const
  {
    for (std::int64_t flat = 0; flat < this->Grid.numberOfCoefficients(); ++flat)
    {
      std::int64_t rest = flat;
      Index<Dim> brick;
      std::size_t inside = 0;
      for (int a = 0; a < Dim; ++a)
      {
        const std::int64_t at = rest % this->Grid.Size[a];
        rest /= this->Grid.Size[a];
        brick[a] = at / BrickWidth;
        inside |= static_cast<std::size_t>(at % BrickWidth) << (2 * a);
      }
      action(
        flat, static_cast<std::size_t>(this->Bricks->brickAt(brick)) * BrickSize<Dim> + inside);
    }
  }
};

template <typename T>
class BrickOperatorTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(BrickOperatorTest, ipia::test::Dimensions);

TYPED_TEST(BrickOperatorTest, EqualsTheDenseNormalEquations)
{
  constexpr int Dim = TypeParam::value;
  for (const FairingWeights& fairing : { FairingWeights{ 0, 0 }, FairingWeights{ 0.3F, 0 },
         FairingWeights{ 0, 0.2F }, FairingWeights{ 0.1F, 0.05F } })
  {
    System<Dim> system(fairing);
    const BrickOperator<Dim> op(*system.Bricks, system.Rows, fairing, 2);
    const Vector c = test::Random(5).vector(system.Grid.numberOfCoefficients(), -1, 1);
    BrickValues result;
    op.product(system.toBricks(c), result);
    EXPECT_LE(test::relativeDifference(system.fromBricks(result), system.Matrix * c), 1e-5);
    system.Bricks->coefficients() = system.toBricks(c);
    op.residual(result);
    EXPECT_LE(
      test::relativeDifference(system.fromBricks(result), system.Right - system.Matrix * c), 1e-5);
  }
}

TYPED_TEST(BrickOperatorTest, HasTheDiagonalOfTheRows)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> system(FairingWeights{});
  BrickValues result;
  BrickOperator<Dim>(*system.Bricks, system.Rows, {}, 1).diagonal(result);
  EXPECT_LE(test::relativeDifference(system.fromBricks(result), system.Matrix.diagonal()), 1e-5);
}

TYPED_TEST(BrickOperatorTest, EvaluatesAndMeasures)
{
  constexpr int Dim = TypeParam::value;
  System<Dim> system(FairingWeights{});
  const BrickOperator<Dim> op(*system.Bricks, system.Rows, {}, 2);
  const Vector c = test::Random(5).vector(system.Grid.numberOfCoefficients(), -1, 1);
  system.Bricks->coefficients() = system.toBricks(c);
  const Vector expected = system.Values * c;
  BrickValues values, all;
  op.evaluate(system.Bricks->coefficients(), values);
  op.evaluateWithGradient(system.Bricks->coefficients(), all);
  for (std::size_t k = 0; k < values.size(); ++k)
  {
    ASSERT_NEAR(values[k], expected[static_cast<Eigen::Index>(k)], 1e-5);
    ASSERT_NEAR(all[k * (1 + Dim)], expected[static_cast<Eigen::Index>(k)], 1e-5);
  }
  // E = c^T A c - 2 b^T c + constant; the constant is the energy of 0.
  system.Bricks->coefficients() = system.toBricks(Vector::Zero(c.size()));
  const double atZero = op.energy();
  system.Bricks->coefficients() = system.toBricks(c);
  const double quadratic = c.dot(system.Matrix * c) - 2 * system.Right.dot(c);
  EXPECT_NEAR(op.energy(), atZero + quadratic, 1e-4 * (atZero + std::abs(quadratic)));
  // Density: the same as columns of the collocation matrix, weighted.
  BrickValues sums;
  op.density(sums);
  Vector weights(static_cast<Eigen::Index>(system.Rows.Rows.size()));
  for (std::size_t k = 0; k < system.Rows.Rows.size(); ++k)
  {
    weights[static_cast<Eigen::Index>(k)] = system.Rows.Rows[k].Weight;
  }
  EXPECT_LE(
    test::relativeDifference(system.fromBricks(sums), system.Values.transpose() * weights), 1e-5);
}
}
