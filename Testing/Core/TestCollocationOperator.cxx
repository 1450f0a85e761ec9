// SPDX-License-Identifier: BSD-3-Clause
#include "CollocationOperator.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;

/// Random rows, some on the border of the domain, and their dense matrix.
template <int Dim>
struct RandomRows
{
  Lattice<Dim> Grid = ipia::test::anisotropicLattice<Dim>();
  Points<Dim> Positions;
  Vector Targets, Weights, Coefficients;
  Eigen::MatrixXd Matrix;

  RandomRows()
  {
    constexpr int n = 400;
    ipia::test::Random random(5);
    this->Positions = random.pointsIn(this->Grid, n);
    this->Positions.col(0).setZero();
    this->Positions.col(1) = ipia::test::extents(this->Grid);
    this->Positions(0, 2) = this->Grid.extent(0);
    this->Targets = random.vector(n, -1, 1);
    this->Weights = random.vector(n, 0, 3);
    this->Weights[3] = 0;
    this->Coefficients = random.vector(this->Grid.numberOfCoefficients(), -1, 1);
    this->Matrix = ipia::test::collocationMatrix(this->Grid, this->Positions);
  }

  ConstraintRows<Dim> rows() const
  {
    return { this->Grid, this->Positions, this->Targets, this->Weights };
  }
};

template <typename T>
class CollocationOperatorTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(CollocationOperatorTest, ipia::test::Dimensions);

TYPED_TEST(CollocationOperatorTest, EqualsTheDenseProducts)
{
  constexpr int Dim = TypeParam::value;
  const RandomRows<Dim> data;
  const ConstraintRows<Dim> rows = data.rows();
  const CollocationOperator<Dim> collocation(rows);
  const Eigen::MatrixXd weighted = data.Matrix.transpose() * data.Weights.asDiagonal();

  Vector result;
  const Vector r = data.Targets - data.Matrix * data.Coefficients;
  const double energy = collocation.residual(data.Coefficients, result);
  EXPECT_LE(ipia::test::relativeDifference(result, weighted * r), 1e-13);
  EXPECT_NEAR(energy, data.Weights.dot(r.cwiseAbs2()), 1e-12 * energy);

  collocation.normalProduct(data.Coefficients, result);
  EXPECT_LE(
    ipia::test::relativeDifference(result, weighted * (data.Matrix * data.Coefficients)), 1e-13);

  collocation.columnSums(result);
  EXPECT_LE(ipia::test::relativeDifference(result, data.Matrix.transpose() * data.Weights), 1e-13);

  collocation.support(result);
  EXPECT_LE(ipia::test::relativeDifference(result, data.Matrix.colwise().sum().transpose()), 1e-13);
}

TYPED_TEST(CollocationOperatorTest, GivesTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  Lattice<Dim> lattice;
  lattice.Size.fill(Dim == 2 ? 203 : 40);
  lattice.Spacing.setConstant(0.1);
  ipia::test::Random random(11);
  const Points<Dim> positions = random.pointsIn(lattice, 20000);
  const Vector targets = random.vector(20000, -1, 1), weights = random.vector(20000, 0, 3);
  const Vector c = random.vector(lattice.numberOfCoefficients(), -1, 1);
  const ConstraintRows<Dim> rows(lattice, positions, targets, weights);

  Vector reference;
  const double energy = CollocationOperator<Dim>(rows, 1).residual(c, reference);
  for (int threads : { 1, 2, 4, 2 })
  {
    Vector result;
    EXPECT_EQ(CollocationOperator<Dim>(rows, threads).residual(c, result), energy);
    EXPECT_TRUE(ipia::test::sameBits(result, reference)) << threads << " threads";
  }
}

TYPED_TEST(CollocationOperatorTest, WithoutRowsIsZero)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  const ConstraintRows<Dim> rows(lattice, Points<Dim>(Dim, 0), Vector(), Vector());
  const CollocationOperator<Dim> collocation(rows);
  Vector result;
  EXPECT_EQ(collocation.residual(Vector::Ones(lattice.numberOfCoefficients()), result), 0);
  EXPECT_EQ(result.size(), lattice.numberOfCoefficients());
  EXPECT_TRUE(result.isZero(0));
}
}
