// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The iteration of the uniform rational spline and the steps with an oscillation's weight, against
 * the same formulas with dense matrices.
 */
#include "RationalSolver.h"

#include "RationalOperator.h"
#include "TestSupport.h"

namespace
{
using namespace ipia;
using ipia::test::relativeDifference;

/// Rows about a circle or sphere in part of an uneven lattice.
template <int Dim>
struct Problem
{
  Lattice<Dim> Grid;
  Points<Dim> Positions;
  Vector Targets, RowWeights;
  Eigen::MatrixXd B;

  explicit Problem(std::int64_t n = Dim == 2 ? 150 : 240)
  {
    const std::array<std::int64_t, 3> sizes = { 9, 8, 7 };
    const std::array<double, 3> spacings = { 0.5, 0.7, 0.6 };
    for (int a = 0; a < Dim; ++a)
    {
      this->Grid.Size[a] = sizes[static_cast<std::size_t>(a)];
      this->Grid.Spacing[a] = spacings[static_cast<std::size_t>(a)];
    }
    ipia::test::Random random(17);
    const auto sphere = ipia::test::spherePoints<Dim>(Point<Dim>::Constant(1.15), 0.8, n);
    this->Positions = sphere.Positions;
    this->Targets.resize(n);
    for (std::int64_t k = 0; k < n; ++k)
    {
      const double offset = 0.2 * static_cast<double>(k % 3 - 1);
      this->Positions.col(k) += offset * sphere.Normals.col(k);
      this->Targets[k] = offset + random.uniform(-0.05, 0.05);
    }
    this->RowWeights = random.vector(n, 0.2, 2);
    this->B = ipia::test::collocationMatrix(this->Grid, this->Positions);
  }

  /// With bars along y, as fits have them.
  ConstraintRows<Dim> rows(int barAxis = 1) const
  {
    return { this->Grid, this->Positions, this->Targets, this->RowWeights, barAxis };
  }
};

/// L of the coefficient grid from its definition.
template <int Dim>
Eigen::MatrixXd laplacianMatrix(const Lattice<Dim>& lattice)
{
  const std::int64_t n = lattice.numberOfCoefficients();
  Eigen::MatrixXd l = Eigen::MatrixXd::Zero(n, n);
  for (std::int64_t i = 0; i < n; ++i)
  {
    std::int64_t stride = 1, rest = i;
    for (int a = 0; a < Dim; ++a)
    {
      if (rest % lattice.Size[a] + 1 < lattice.Size[a])
      {
        l(i, i) += 1;
        l(i + stride, i + stride) += 1;
        l(i, i + stride) -= 1;
        l(i + stride, i) -= 1;
      }
      rest /= lattice.Size[a];
      stride *= lattice.Size[a];
    }
  }
  return l;
}

/// The method from its definition, with dense matrices.
template <int Dim>
struct DenseIteration
{
  const Problem<Dim>& P;
  Eigen::MatrixXd L;
  OscillationOptions Oscillation;
  Vector C, W;
  double StepSize = 0;

  DenseIteration(const Problem<Dim>& problem, const OscillationOptions& oscillation)
    : P(problem)
    , L(laplacianMatrix(problem.Grid))
    , Oscillation(oscillation)
    , C(Vector::Zero(problem.B.cols()))
    , W(Vector::Ones(problem.B.cols()))
  {
  }

  Eigen::MatrixXd matrix(const Vector& w) const
  {
    return (this->P.B * w).cwiseInverse().asDiagonal() * this->P.B * w.asDiagonal();
  }

  double rowEnergy(const Vector& w) const
  {
    return this->P.RowWeights.dot((this->P.Targets - this->matrix(w) * this->C).cwiseAbs2());
  }

  double energy() const
  {
    return this->rowEnergy(this->W) + 2 * this->Oscillation.Weight * this->C.dot(this->L * this->C);
  }

  Vector weightGradient() const
  {
    const Vector d = this->P.B * this->W, g = this->matrix(this->W) * this->C;
    Vector gradient = Vector::Zero(this->W.size());
    for (Eigen::Index k = 0; k < g.size(); ++k)
    {
      const double factor = 2 * this->P.RowWeights[k] * (g[k] - this->P.Targets[k]) / d[k];
      gradient +=
        factor * this->P.B.row(k).transpose().cwiseProduct((this->C.array() - g[k]).matrix());
    }
    return gradient;
  }

  void step(double tau)
  {
    const Vector gradient = this->weightGradient();
    Vector w;
    for (;; tau /= 2)
    {
      w = (this->W - tau * gradient).cwiseMax(0);
      if ((this->P.B * w).minCoeff() > 1e-9 &&
        this->rowEnergy(w) <= (1 + 1e-12) * this->rowEnergy(this->W))
      {
        break;
      }
    }
    this->W = w;
    const Eigen::MatrixXd d = this->matrix(w);
    const Eigen::MatrixXd dw = d.transpose() * this->P.RowWeights.asDiagonal();
    const double norm = (dw * d.rowwise().sum()).maxCoeff(); // no entry is negative
    const double lambda = this->Oscillation.Weight;
    const Vector data = dw * (this->P.Targets - d * this->C), smooth = this->L * this->C;
    if (this->Oscillation.Step == OscillationStep::AsPrinted)
    {
      this->StepSize = 2 / norm;
      this->C += this->StepSize * data - 4 * lambda * smooth;
    }
    else
    {
      this->StepSize = 2 / (norm + 8 * Dim * lambda);
      this->C += this->StepSize * (data - 2 * lambda * smooth);
    }
  }
};

template <typename T>
class RationalSolver : public ::testing::Test
{
};
TYPED_TEST_SUITE(RationalSolver, ipia::test::Dimensions);

SolverOptions iterations(int count, const OscillationOptions& oscillation = {})
{
  SolverOptions options;
  options.MaximumNumberOfIterations = count;
  options.Oscillation = oscillation;
  return options;
}

TYPED_TEST(RationalSolver, IsTheDenseIteration)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem;
  const ConstraintRows<Dim> alongX = problem.rows(0), alongY = problem.rows(1);
  for (const OscillationOptions& oscillation :
    { OscillationOptions{}, OscillationOptions{ 0.05, OscillationStep::Energy },
      OscillationOptions{ 0.01, OscillationStep::AsPrinted } })
  {
    // The second is halved.
    for (const double tau : { 0.05, 300.0 })
    {
      DenseIteration<Dim> dense(problem, oscillation);
      int done = 0;
      for (const int count : { 1, 10, tau < 1 ? 200 : 11 })
      {
        for (; done < count; ++done)
        {
          dense.step(tau);
        }
        for (const ConstraintRows<Dim>* rows : { &alongX, &alongY })
        {
          Vector c = Vector::Zero(problem.B.cols());
          const RationalResult result =
            solveRational(*rows, iterations(count, oscillation), { tau }, 1, c);
          EXPECT_EQ(result.Solver.Status, SolverStatus::Done);
          EXPECT_EQ(result.Solver.NumberOfIterations, count);
          EXPECT_LE(relativeDifference(c, dense.C), 1e-11) << count << " iterations, tau " << tau;
          EXPECT_LE(relativeDifference(result.Weights, dense.W), 1e-11)
            << count << " iterations, tau " << tau;
          EXPECT_NEAR(result.Solver.Energy, dense.energy(), 1e-11 * dense.energy());
          EXPECT_NEAR(result.Solver.StepSize, dense.StepSize, 1e-11 * dense.StepSize);
        }
      }
      // The weights have moved by far more than the bound above tells apart.
      EXPECT_GT((dense.W.array() - 1).abs().maxCoeff(), 1e-3);
    }
  }
}

TYPED_TEST(RationalSolver, WeightGradientAgreesWithCentralDifferences)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem;
  const ConstraintRows<Dim> rows = problem.rows();
  ipia::test::Random random(23);
  const std::int64_t n = problem.Grid.numberOfCoefficients();
  const Vector c = random.vector(n, -1, 1);
  Vector w = random.vector(n, 0.5, 2);
  CoefficientPairs pairs(2, n), sums = CoefficientPairs::Zero(2, n);
  RationalOperator<Dim> rational(rows, 1);
  const auto energy = [&]
  {
    pairs.row(0) = c.cwiseProduct(w);
    pairs.row(1) = w;
    return rational.energy(pairs);
  };
  const double middleEnergy = energy();
  EXPECT_DOUBLE_EQ(rational.coefficientSums(pairs, sums), middleEnergy);
  sums.setZero();
  EXPECT_DOUBLE_EQ(rational.weightSums(pairs, sums), middleEnergy);
  const Vector gradient =
    2 * (c.cwiseProduct(Vector(sums.row(0).transpose())) - Vector(sums.row(1).transpose()));
  const double step = 1e-4;
  for (std::int64_t i = 0; i < n; ++i)
  {
    const double middle = w[i];
    w[i] = middle + step;
    const double above = energy();
    w[i] = middle - step;
    const double below = energy();
    w[i] = middle;
    EXPECT_NEAR((above - below) / (2 * step), gradient[i], 1e-6);
  }
}

TYPED_TEST(RationalSolver, ATooLargeStepOfTheWeightsIsHalved)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem;
  const ConstraintRows<Dim> rows = problem.rows();
  for (const double tau : { 30.0, 1e6, 1e200 })
  {
    double before = problem.RowWeights.dot(problem.Targets.cwiseAbs2());
    for (const int count : { 1, 2, 3, 4, 5, 8, 16, 32, 64 })
    {
      Vector c = Vector::Zero(problem.B.cols());
      const RationalResult result = solveRational(rows, iterations(count), { tau }, 1, c);
      EXPECT_EQ(result.Solver.Status, SolverStatus::Done);
      EXPECT_EQ(result.Solver.NumberOfIterations, count);
      EXPECT_TRUE(c.allFinite());
      EXPECT_TRUE(result.Weights.allFinite());
      EXPECT_GE(result.Weights.minCoeff(), 0);
      EXPECT_TRUE(hasPositiveDenominators(problem.Grid, result.Weights));
      EXPECT_LE(result.Solver.Energy, before * (1 + 1e-12)) << "tau " << tau << ", " << count;
      before = result.Solver.Energy;
      if (count > 2 && tau > 100)
      {
        EXPECT_LT(result.WeightStepSize, tau);
      }
    }
  }
}

TYPED_TEST(RationalSolver, WithoutAStepOfTheWeightsItIsTheBSpline)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem;
  const ConstraintRows<Dim> rows = problem.rows();
  Vector c = Vector::Zero(problem.B.cols()), spline = c;
  const RationalResult result = solveRational(rows, iterations(50), { 0 }, 1, c);
  const SolverResult reference =
    solveLeastSquares(CollocationOperator<Dim>(rows, 1), iterations(50), spline);
  EXPECT_TRUE((result.Weights.array() == 1).all());
  EXPECT_EQ(result.WeightStepSize, 0);
  EXPECT_LE(relativeDifference(c, spline), 1e-12);
  EXPECT_NEAR(result.Solver.Energy, reference.Energy, 1e-12 * reference.Energy);
  ASSERT_EQ(result.Solver.ResidualHistory.size(), reference.ResidualHistory.size());
  for (std::size_t i = 0; i < reference.ResidualHistory.size(); ++i)
  {
    EXPECT_NEAR(result.Solver.ResidualHistory[i], reference.ResidualHistory[i], 1e-12);
  }
}

TYPED_TEST(RationalSolver, CoefficientsThatNoRowTouchesStay)
{
  constexpr int Dim = TypeParam::value;
  Problem<Dim> problem;
  problem.Grid.Size.fill(15);
  const ConstraintRows<Dim> rows = problem.rows();
  Vector c = Vector::Zero(problem.Grid.numberOfCoefficients());
  const RationalResult result = solveRational(rows, iterations(20), { 1 }, 1, c);
  const Vector sums =
    ipia::test::collocationMatrix(problem.Grid, problem.Positions).colwise().sum().transpose();
  int untouched = 0;
  for (std::int64_t i = 0; i < c.size(); ++i)
  {
    if (sums[i] == 0)
    {
      ++untouched;
      EXPECT_EQ(c[i], 0);
      EXPECT_EQ(result.Weights[i], 1);
    }
  }
  EXPECT_GT(untouched, 20);
}

/// A band in a lattice of many tasks.
template <int Dim>
ConstraintRows<Dim> manyRows()
{
  Lattice<Dim> lattice;
  lattice.Size.fill(Dim == 2 ? 230 : 40);
  lattice.Spacing.setConstant(1);
  const auto sphere = ipia::test::spherePoints<Dim>(
    Point<Dim>::Constant(lattice.extent(0) / 2), 0.4 * lattice.extent(0), 9000);
  Vector targets = ipia::test::Random(7).vector(9000, -0.5, 0.5);
  return { lattice, sphere.Positions + 0.3 * sphere.Normals * targets.asDiagonal(), targets, {},
    1 };
}

TYPED_TEST(RationalSolver, HasTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  const ConstraintRows<Dim> rows = manyRows<Dim>();
  for (const double lambda : { 0.0, 0.01 })
  {
    const SolverOptions options = iterations(12, { lambda, OscillationStep::Energy });
    Vector reference = Vector::Zero(rows.lattice().numberOfCoefficients());
    const RationalResult one = solveRational(rows, options, { 1 }, 1, reference);
    EXPECT_GT((one.Weights.array() - 1).abs().maxCoeff(), 1e-3);
    for (const int threads : { 2, 4, 4 })
    {
      Vector c = Vector::Zero(reference.size());
      const RationalResult result = solveRational(rows, options, { 1 }, threads, c);
      EXPECT_TRUE(ipia::test::sameBits(c, reference)) << threads << " threads";
      EXPECT_TRUE(ipia::test::sameBits(result.Weights, one.Weights)) << threads << " threads";
      EXPECT_EQ(result.Solver.ResidualHistory, one.Solver.ResidualHistory);
      EXPECT_EQ(result.Solver.Energy, one.Solver.Energy);
    }
  }
}

TYPED_TEST(RationalSolver, StopsWhereTheEnergyHardlyChanges)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem;
  const ConstraintRows<Dim> rows = problem.rows();
  for (const OscillationStep step : { OscillationStep::Energy, OscillationStep::AsPrinted })
  {
    const OscillationOptions oscillation = { 0.01, step };
    SolverOptions options = iterations(5000, oscillation);
    options.Rule = StoppingRule::EnergyChange;
    options.Tolerance = 1e-4;
    Vector c = Vector::Zero(problem.B.cols());
    const int count = solveRational(rows, options, { 0.05 }, 1, c).Solver.NumberOfIterations;
    ASSERT_GT(count, 5);
    ASSERT_LT(count, 5000);
    std::vector<double> energies;
    for (const int n : { count - 2, count - 1, count })
    {
      c.setZero();
      energies.push_back(
        solveRational(rows, iterations(n, oscillation), { 0.05 }, 1, c).Solver.Energy);
    }
    EXPECT_GE(std::abs(energies[1] - energies[0]), options.Tolerance);
    EXPECT_LT(std::abs(energies[2] - energies[1]), options.Tolerance);
  }
}

/// E + lambda R falls from iteration to iteration, and settles, for any lambda and either basis.
TYPED_TEST(RationalSolver, TheEnergyStepConvergesForAnyWeight)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem;
  const ConstraintRows<Dim> rows = problem.rows();
  const CollocationOperator<Dim> collocation(rows, 1);
  const Eigen::MatrixXd laplacian = laplacianMatrix(problem.Grid);
  const auto energies = [&](const SolverOptions& options)
  {
    Vector c = Vector::Zero(problem.B.cols()), rational = c;
    const SolverResult spline = solveLeastSquares(collocation, options, c);
    const RationalResult result = solveRational(rows, options, { 0.05 }, 1, rational);
    EXPECT_EQ(spline.Status, SolverStatus::Done);
    EXPECT_EQ(result.Solver.Status, SolverStatus::Done);
    return std::make_pair(spline.Energy, result.Solver.Energy);
  };
  for (const double lambda : { 1e-6, 1e-4, 1e-2, 1.0, 30.0, 1e3 })
  {
    const OscillationOptions oscillation = { lambda, OscillationStep::Energy };
    auto before = energies(iterations(1, oscillation));
    for (const int count : { 2, 3, 4, 5, 6, 8, 12, 20, 50, 51, 100, 101 })
    {
      const auto now = energies(iterations(count, oscillation));
      EXPECT_LE(now.first, before.first * (1 + 1e-12)) << "lambda " << lambda << ", " << count;
      EXPECT_LE(now.second, before.second * (1 + 1e-12)) << "lambda " << lambda << ", " << count;
      before = now;
    }
    SolverOptions options = iterations(100000, oscillation);
    options.Rule = StoppingRule::EnergyChange;
    options.Tolerance = 1e-5;
    Vector c = Vector::Zero(problem.B.cols());
    EXPECT_LT(solveRational(rows, options, { 0.05 }, 1, c).Solver.NumberOfIterations, 100000);

    // Conjugate gradients find the minimiser.
    options = iterations(20000, oscillation);
    options.Type = SolverType::ConjugateGradient;
    c.setZero();
    const SolverResult conjugate = solveLeastSquares(collocation, options, c);
    const Eigen::MatrixXd weighted = problem.B.transpose() * problem.RowWeights.asDiagonal();
    const Eigen::MatrixXd system = weighted * problem.B + 2 * lambda * laplacian;
    const Vector minimiser = system.ldlt().solve(weighted * problem.Targets);
    const auto energyOf = [&](const Vector& x)
    {
      return problem.RowWeights.dot((problem.Targets - problem.B * x).cwiseAbs2()) +
        2 * lambda * x.dot(laplacian * x);
    };
    EXPECT_LE(relativeDifference(c, minimiser), 1e-6) << "lambda " << lambda;
    EXPECT_NEAR(conjugate.Energy, energyOf(minimiser), 1e-10 * conjugate.Energy);
    EXPECT_LE(conjugate.Energy, before.first);
  }
}

/// The printed step tends to the minimiser of E + (2 lambda / mu) R.
TYPED_TEST(RationalSolver, ThePrintedStepMinimisesAnotherEnergy)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem;
  const ConstraintRows<Dim> rows = problem.rows();
  const OscillationOptions oscillation = { 0.02, OscillationStep::AsPrinted };
  Vector c = Vector::Zero(problem.B.cols());
  const SolverResult result =
    solveLeastSquares(CollocationOperator<Dim>(rows, 1), iterations(20000, oscillation), c);
  const Eigen::MatrixXd weighted = problem.B.transpose() * problem.RowWeights.asDiagonal();
  const Eigen::MatrixXd system =
    weighted * problem.B + 4 * oscillation.Weight / result.StepSize * laplacianMatrix(problem.Grid);
  EXPECT_LE(relativeDifference(c, system.ldlt().solve(weighted * problem.Targets)), 1e-9);
}

/// Rows at the knots, whose targets change sign from knot to knot as the fastest mode of L does.
TEST(RationalSolver, ThePrintedStepIsStoppedWhereItDiverges)
{
  const std::int64_t n = 43;
  const Lattice<2> lattice = ipia::test::makeLattice<2>({ n, n }, Point<2>::Constant(1.0));
  const std::int64_t knots = n - 2;
  Points<2> positions(2, knots * knots);
  Vector targets(knots * knots);
  for (std::int64_t k = 0; k < knots * knots; ++k)
  {
    positions.col(k) << static_cast<double>(k % knots), static_cast<double>(k / knots);
    targets[k] = (k % knots + k / knots) % 2 ? 1 : -1;
  }
  const ConstraintRows<2> rows(lattice, positions, targets, {});
  const CollocationOperator<2> collocation(rows, 1);
  const auto statuses = [&](double lambda)
  {
    const SolverOptions options = iterations(3000, { lambda, OscillationStep::AsPrinted });
    Vector c = Vector::Zero(n * n), rational = c;
    return std::make_pair(solveLeastSquares(collocation, options, c).Status,
      solveRational(rows, options, { 0.01 }, 1, rational).Solver.Status);
  };
  EXPECT_EQ(statuses(0.05), std::make_pair(SolverStatus::Done, SolverStatus::Done));
  EXPECT_EQ(statuses(0.0624), std::make_pair(SolverStatus::Diverged, SolverStatus::Diverged));
  EXPECT_EQ(statuses(0.5), std::make_pair(SolverStatus::Diverged, SolverStatus::Diverged));
}

TYPED_TEST(RationalSolver, ReportsADivergingStepSizeAndAnAbort)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem;
  const ConstraintRows<Dim> rows = problem.rows();
  SolverOptions options = iterations(200);
  options.StepSize = 100;
  Vector c = Vector::Zero(problem.B.cols());
  EXPECT_EQ(solveRational(rows, options, { 0.05 }, 1, c).Solver.Status, SolverStatus::Diverged);
  int calls = 0;
  c.setZero();
  const RationalResult aborted =
    solveRational<Dim>(rows, iterations(30), { 0.05 }, 1, c, [&](double) { return ++calls < 4; });
  EXPECT_EQ(aborted.Solver.Status, SolverStatus::Aborted);
  EXPECT_EQ(calls, 4);
}

TYPED_TEST(RationalSolver, DenominatorsArePositiveUnlessAKnotHasNoWeights)
{
  constexpr int Dim = TypeParam::value;
  Lattice<Dim> lattice;
  lattice.Size.fill(7);
  lattice.Spacing.setOnes();
  Vector weights = Vector::Zero(lattice.numberOfCoefficients());
  // Every third coefficient on each axis is within reach of every knot.
  for (std::int64_t i = 0; i < weights.size(); ++i)
  {
    std::int64_t rest = i;
    bool use = true;
    for (int a = 0; a < Dim; ++a, rest /= 7)
    {
      use = use && rest % 7 % 3 == 2;
    }
    weights[i] = use ? 1 : 0;
  }
  EXPECT_TRUE(hasPositiveDenominators(lattice, weights));
  for (std::int64_t i = 0; i < weights.size(); ++i)
  {
    if (weights[i] > 0)
    {
      Vector fewer = weights;
      fewer[i] = 0;
      EXPECT_FALSE(hasPositiveDenominators(lattice, fewer)) << i;
      fewer[i] = std::nan("");
      EXPECT_FALSE(hasPositiveDenominators(lattice, fewer)) << i;
    }
  }
}
}
