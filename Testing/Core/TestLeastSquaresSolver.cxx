// SPDX-License-Identifier: BSD-3-Clause
#include "LeastSquaresSolver.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;

/// Rows together with sqrt(W) D and sqrt(W) b, dense.
template <int Dim>
struct System
{
  ConstraintRows<Dim> Rows;
  Eigen::MatrixXd Matrix;
  Vector Targets;

  System(const Lattice<Dim>& lattice, const Points<Dim>& positions, const Vector& targets,
    const Vector& weights)
    : Rows(lattice, positions, targets, weights)
    , Matrix(weights.cwiseSqrt().asDiagonal() * ipia::test::collocationMatrix(lattice, positions))
    , Targets(weights.cwiseSqrt().cwiseProduct(targets))
  {
  }

  /// The least-squares solution nearest to @a start, by the pseudo-inverse.
  Vector nearestSolution(const Vector& start) const
  {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(this->Matrix);
    return start + decomposition.solve(this->Targets - this->Matrix * start);
  }

  Vector gradient(const Vector& c) const
  {
    return this->Matrix.transpose() * (this->Targets - this->Matrix * c);
  }

  double energy(const Vector& c) const { return (this->Targets - this->Matrix * c).squaredNorm(); }

  /// The largest eigenvalue of D^T W D.
  double largestEigenvalue() const
  {
    const Eigen::MatrixXd normal = this->Matrix.transpose() * this->Matrix;
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(normal).eigenvalues().maxCoeff();
  }
};

template <int Dim>
Lattice<Dim> smallLattice()
{
  Lattice<Dim> lattice;
  for (int a = 0; a < Dim; ++a)
  {
    lattice.Size[a] = Dim == 2 ? 9 - a : 6 - a % 2;
    lattice.Spacing[a] = 0.3 + 0.2 * a;
  }
  return lattice;
}

/// Every knot of the domain: there the smallest singular value that is not 0 is 3^-Dim or more.
template <int Dim>
Points<Dim> knots(const Lattice<Dim>& lattice)
{
  std::int64_t n = 1;
  for (int a = 0; a < Dim; ++a)
  {
    n *= lattice.cells(a) + 1;
  }
  Points<Dim> positions(Dim, n);
  for (std::int64_t k = 0; k < n; ++k)
  {
    std::int64_t rest = k;
    for (int a = 0; a < Dim; ++a)
    {
      positions(a, k) = std::min(
        static_cast<double>(rest % (lattice.cells(a) + 1)) * lattice.Spacing[a], lattice.extent(a));
      rest /= lattice.cells(a) + 1;
    }
  }
  return positions;
}

/// Fewer rows than coefficients: one at each knot.
template <int Dim>
System<Dim> underdetermined()
{
  const Lattice<Dim> lattice = smallLattice<Dim>();
  const Points<Dim> positions = knots(lattice);
  ipia::test::Random random(2);
  System<Dim> system(lattice, positions, random.vector(positions.cols(), -1, 1),
    random.vector(positions.cols(), 0.5, 1.5));
  EXPECT_LT(system.Matrix.rows(), system.Matrix.cols());
  return system;
}

/// More rows than coefficients, of contradicting targets: four at each knot.
template <int Dim>
System<Dim> overdetermined()
{
  const Lattice<Dim> lattice = smallLattice<Dim>();
  const Points<Dim> positions = knots(lattice).replicate(1, 4);
  ipia::test::Random random(3);
  System<Dim> system(lattice, positions, random.vector(positions.cols(), -1, 1),
    random.vector(positions.cols(), 0.5, 1.5));
  EXPECT_GT(system.Matrix.rows(), system.Matrix.cols());
  return system;
}

SolverOptions converged(SolverType type)
{
  SolverOptions options;
  options.Type = type;
  options.MaximumNumberOfIterations = type == SolverType::ProgressiveIteration ? 40000 : 400;
  options.Tolerance = 1e-13;
  return options;
}

constexpr SolverType BothSolvers[] = { SolverType::ProgressiveIteration,
  SolverType::ConjugateGradient };

const char* name(SolverType type)
{
  return type == SolverType::ProgressiveIteration ? "progressive iteration" : "conjugate gradient";
}

template <typename T>
class LeastSquaresSolver : public ::testing::Test
{
};
TYPED_TEST_SUITE(LeastSquaresSolver, ipia::test::Dimensions);

template <int Dim>
void expectConvergence(const System<Dim>& system, const Vector& start)
{
  const CollocationOperator<Dim> collocation(system.Rows, 1);
  const Vector limit = system.nearestSolution(start);
  for (const SolverType type : BothSolvers)
  {
    Vector c = start;
    const SolverResult result = solveLeastSquares(collocation, converged(type), c);
    EXPECT_EQ(result.Status, SolverStatus::Done) << name(type);
    EXPECT_LE(ipia::test::relativeDifference(c, limit), 1e-8) << name(type);
    EXPECT_NEAR(result.Energy, system.energy(c), 1e-12 * system.Targets.squaredNorm())
      << name(type);
  }
}

TYPED_TEST(LeastSquaresSolver, FromZeroReachesTheSolutionOfLeastNorm)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> few = underdetermined<Dim>(), many = overdetermined<Dim>();
  expectConvergence<Dim>(few, Vector::Zero(few.Matrix.cols()));
  expectConvergence<Dim>(many, Vector::Zero(many.Matrix.cols()));
}

TYPED_TEST(LeastSquaresSolver, FromElsewhereReachesTheNearestSolution)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> few = underdetermined<Dim>(), many = overdetermined<Dim>();
  const Vector start = ipia::test::Random(9).vector(few.Matrix.cols(), -1, 1);
  expectConvergence<Dim>(few, start);
  expectConvergence<Dim>(many, start);
  EXPECT_GT(ipia::test::relativeDifference(
              few.nearestSolution(start), few.nearestSolution(Vector::Zero(start.size()))),
    0.1)
    << "the start must matter";
}

/// Rows everywhere leave one solution only. Its condition, 1e6, would take plain iteration 1e7
/// steps; that of a trivariate one, 1e9, is beyond double precision for a bound of 1e-8.
TEST(LeastSquaresSolverOfFullRank, ConjugateGradientReachesTheOnlySolution)
{
  Lattice<2> lattice, finer;
  lattice.Size = { 6, 5 };
  lattice.Spacing << 0.5, 0.8;
  finer.Size = { 4 * 3 + 3, 4 * 2 + 3 };
  finer.Spacing = lattice.Spacing / 4;
  const Points<2> positions = knots(finer);
  ipia::test::Random random(4);
  const System<2> system(lattice, positions, random.vector(positions.cols(), -1, 1),
    random.vector(positions.cols(), 0.5, 1.5));
  EXPECT_EQ(Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(system.Matrix).rank(),
    lattice.numberOfCoefficients());
  Vector c = Vector::Zero(lattice.numberOfCoefficients());
  solveLeastSquares(
    CollocationOperator<2>(system.Rows, 1), converged(SolverType::ConjugateGradient), c);
  EXPECT_LE(
    ipia::test::relativeDifference(c, system.nearestSolution(Vector::Zero(c.size()))), 1e-8);
}

TYPED_TEST(LeastSquaresSolver, ProgressiveIterationIsTheDenseIteration)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> system = overdetermined<Dim>();
  const Vector start = ipia::test::Random(9).vector(system.Matrix.cols(), -1, 1);
  for (const double stepSize : { 0.0, 0.1 })
  {
    for (const int iterations : { 1, 10, 200 })
    {
      SolverOptions options;
      options.MaximumNumberOfIterations = iterations;
      options.StepSize = stepSize;
      Vector c = start;
      const SolverResult result =
        solveLeastSquares(CollocationOperator<Dim>(system.Rows, 1), options, c);
      const Eigen::MatrixXd normal = system.Matrix.transpose() * system.Matrix;
      const double mu = stepSize > 0 ? stepSize : 2 / normal.rowwise().sum().maxCoeff();
      Vector expected = start;
      for (int k = 0; k < iterations; ++k)
      {
        expected += mu * system.gradient(expected);
      }
      EXPECT_EQ(result.NumberOfIterations, iterations);
      EXPECT_NEAR(result.StepSize, mu, 1e-13 * mu);
      EXPECT_LE(ipia::test::relativeDifference(c, expected), 1e-12) << iterations << " iterations";
    }
  }
}

TYPED_TEST(LeastSquaresSolver, ResidualHistoryIsThatOfTheCoefficients)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> system = overdetermined<Dim>();
  const CollocationOperator<Dim> collocation(system.Rows, 1);
  const Vector start = ipia::test::Random(9).vector(system.Matrix.cols(), -1, 1);
  for (const SolverType type : BothSolvers)
  {
    for (const int iterations : { 0, 1, 7 })
    {
      SolverOptions options;
      options.Type = type;
      options.MaximumNumberOfIterations = iterations;
      Vector c = start;
      const SolverResult result = solveLeastSquares(collocation, options, c);
      ASSERT_EQ(result.ResidualHistory.size(), static_cast<std::size_t>(iterations) + 1);
      EXPECT_EQ(result.ResidualHistory.front(), 1);
      EXPECT_NEAR(result.ResidualHistory.back(),
        system.gradient(c).norm() / system.gradient(start).norm(), 1e-12)
        << name(type);
      EXPECT_NEAR(result.Energy, system.energy(c), 1e-12 * result.Energy);
    }
  }
}

TYPED_TEST(LeastSquaresSolver, StopsAtTheRelativeResidual)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> system = overdetermined<Dim>();
  for (const SolverType type : BothSolvers)
  {
    SolverOptions options = converged(type);
    options.Tolerance = 1e-3;
    Vector c = Vector::Zero(system.Matrix.cols());
    const SolverResult result =
      solveLeastSquares(CollocationOperator<Dim>(system.Rows, 1), options, c);
    const std::size_t n = result.ResidualHistory.size();
    ASSERT_GT(n, 2u);
    EXPECT_EQ(n, static_cast<std::size_t>(result.NumberOfIterations) + 1);
    EXPECT_LT(result.ResidualHistory[n - 1], options.Tolerance) << name(type);
    for (std::size_t k = 0; k + 1 < n; ++k)
    {
      EXPECT_GE(result.ResidualHistory[k], options.Tolerance) << name(type);
    }
  }
}

TYPED_TEST(LeastSquaresSolver, StopsAtTheChangeOfTheEnergy)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> system = overdetermined<Dim>();
  const CollocationOperator<Dim> collocation(system.Rows, 1);
  for (const SolverType type : BothSolvers)
  {
    SolverOptions options = converged(type);
    options.Rule = StoppingRule::EnergyChange;
    options.Tolerance = 1e-3;
    Vector c = Vector::Zero(system.Matrix.cols());
    const int stopped = solveLeastSquares(collocation, options, c).NumberOfIterations;
    ASSERT_GT(stopped, 1);

    std::vector<double> energies;
    options.Tolerance = 0;
    for (int k = 0; k <= stopped; ++k)
    {
      options.MaximumNumberOfIterations = k;
      c.setZero();
      solveLeastSquares(collocation, options, c);
      energies.push_back(system.energy(c));
    }
    for (std::size_t k = 1; k < energies.size(); ++k)
    {
      const bool small = std::abs(energies[k] - energies[k - 1]) < 1e-3;
      EXPECT_EQ(small, k + 1 == energies.size()) << name(type) << ", iteration " << k;
    }
  }
}

TYPED_TEST(LeastSquaresSolver, AbortsWhenTheCallbackSaysSo)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> system = overdetermined<Dim>();
  const CollocationOperator<Dim> collocation(system.Rows, 1);
  for (const SolverType type : BothSolvers)
  {
    SolverOptions options;
    options.Type = type;
    options.MaximumNumberOfIterations = 20;
    std::vector<double> shares;
    Vector c = Vector::Zero(system.Matrix.cols());
    const SolverResult result = solveLeastSquares<Dim>(collocation, options, c,
      [&](double share)
      {
        shares.push_back(share);
        return shares.size() <= 5;
      });
    EXPECT_EQ(result.Status, SolverStatus::Aborted) << name(type);
    EXPECT_EQ(result.NumberOfIterations, 5);
    ASSERT_EQ(shares.size(), 6u);
    for (std::size_t k = 0; k < shares.size(); ++k)
    {
      EXPECT_DOUBLE_EQ(shares[k], static_cast<double>(k) / 20);
    }

    options.MaximumNumberOfIterations = 5;
    Vector expected = Vector::Zero(system.Matrix.cols());
    solveLeastSquares(collocation, options, expected);
    EXPECT_TRUE(ipia::test::sameBits(c, expected)) << name(type);
  }
}

TYPED_TEST(LeastSquaresSolver, NoticesAStepThatIsTooLarge)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> system = overdetermined<Dim>();
  const CollocationOperator<Dim> collocation(system.Rows, 1);
  SolverOptions options;
  options.MaximumNumberOfIterations = 5000;
  for (const double factor : { 1.9, 2.1, 100.0 })
  {
    options.StepSize = factor / system.largestEigenvalue();
    Vector c = Vector::Zero(system.Matrix.cols());
    const SolverResult result = solveLeastSquares(collocation, options, c);
    EXPECT_EQ(result.Status, factor < 2 ? SolverStatus::Done : SolverStatus::Diverged) << factor;
    EXPECT_EQ(
      result.ResidualHistory.size(), static_cast<std::size_t>(result.NumberOfIterations) + 1);
    EXPECT_NEAR(result.ResidualHistory.back(),
      system.gradient(c).norm() / system.gradient(Vector::Zero(c.size())).norm(),
      1e-9 * result.ResidualHistory.back() + 1e-12);
    if (factor > 2)
    {
      EXPECT_LT(result.NumberOfIterations, 1000);
    }
  }
}

TYPED_TEST(LeastSquaresSolver, IteratingOnAtTheSolutionIsNoDivergence)
{
  constexpr int Dim = TypeParam::value;
  const System<Dim> system = underdetermined<Dim>();
  for (const double scale : { 1e-6, 1.0, 1e6 })
  {
    const System<Dim> scaled(system.Rows.lattice(), knots(system.Rows.lattice()),
      ipia::test::Random(2).vector(system.Matrix.rows(), -scale, scale),
      Vector::Ones(system.Matrix.rows()));
    for (const SolverType type : BothSolvers)
    {
      SolverOptions options = converged(type);
      options.Tolerance = 0;
      Vector c = Vector::Zero(system.Matrix.cols());
      const SolverResult result =
        solveLeastSquares(CollocationOperator<Dim>(scaled.Rows, 1), options, c);
      EXPECT_EQ(result.Status, SolverStatus::Done) << name(type) << ", targets of size " << scale;
      EXPECT_EQ(
        result.ResidualHistory.size(), static_cast<std::size_t>(result.NumberOfIterations) + 1);
      EXPECT_LE(
        ipia::test::relativeDifference(c, scaled.nearestSolution(Vector::Zero(c.size()))), 1e-8);
    }
  }
}

TYPED_TEST(LeastSquaresSolver, StartingAtTheSolutionDoesNothing)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = smallLattice<Dim>();
  const ConstraintRows<Dim> rows(
    lattice, knots(lattice), Vector::Zero(knots(lattice).cols()), Vector());
  for (const SolverType type : BothSolvers)
  {
    Vector c = Vector::Zero(lattice.numberOfCoefficients());
    const SolverResult result =
      solveLeastSquares(CollocationOperator<Dim>(rows, 1), converged(type), c);
    EXPECT_EQ(result.Status, SolverStatus::Done);
    EXPECT_EQ(result.NumberOfIterations, 0);
    EXPECT_TRUE(c.isZero(0));
  }
}

TYPED_TEST(LeastSquaresSolver, WithoutRowsKeepsTheStart)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = smallLattice<Dim>();
  const ConstraintRows<Dim> rows(lattice, Points<Dim>(Dim, 0), Vector(), Vector());
  for (const SolverType type : BothSolvers)
  {
    Vector c = Vector::Ones(lattice.numberOfCoefficients());
    const SolverResult result =
      solveLeastSquares(CollocationOperator<Dim>(rows, 1), converged(type), c);
    EXPECT_EQ(result.Status, SolverStatus::Done);
    EXPECT_TRUE((c.array() == 1).all());
  }
}

TYPED_TEST(LeastSquaresSolver, GivesTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  Lattice<Dim> lattice;
  lattice.Size.fill(Dim == 2 ? 203 : 36);
  lattice.Spacing.setConstant(0.1);
  ipia::test::Random random(11);
  const Points<Dim> positions = random.pointsIn(lattice, 5000);
  const ConstraintRows<Dim> rows(
    lattice, positions, random.vector(5000, -1, 1), random.vector(5000, 0, 3));
  for (const SolverType type : BothSolvers)
  {
    SolverOptions options;
    options.Type = type;
    options.MaximumNumberOfIterations = 10;
    Vector reference = Vector::Zero(lattice.numberOfCoefficients());
    const SolverResult first =
      solveLeastSquares(CollocationOperator<Dim>(rows, 1), options, reference);
    for (const int threads : { 1, 2, 4 })
    {
      Vector c = Vector::Zero(lattice.numberOfCoefficients());
      const SolverResult result =
        solveLeastSquares(CollocationOperator<Dim>(rows, threads), options, c);
      EXPECT_TRUE(ipia::test::sameBits(c, reference)) << name(type) << ", " << threads;
      EXPECT_EQ(result.ResidualHistory, first.ResidualHistory);
      EXPECT_EQ(result.Energy, first.Energy);
    }
  }
}
}
