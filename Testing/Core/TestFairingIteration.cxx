// SPDX-License-Identifier: BSD-3-Clause
#include "FairingIteration.h"

#include "FairingReference.h"

namespace
{
using namespace ipia;
using ipia::test::curveProblem;
using ipia::test::DenseFairing;
using ipia::test::FairingProblem;
using ipia::test::randomWeights;
using ipia::test::surfaceProblem;

double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}

struct Named
{
  std::string Name;
  FairingProblem Problem;
};

/// Curves of all degrees and orders, open and closed, and surfaces, gridded and scattered.
std::vector<Named> problems()
{
  std::vector<Named> all;
  for (int degree = 2; degree <= 5; ++degree)
  {
    for (int order = 1; order <= std::min(degree, 3); ++order)
    {
      const std::string kind =
        " of degree " + std::to_string(degree) + ", order " + std::to_string(order);
      all.push_back({ "open curve" + kind, curveProblem(degree, order, false) });
      all.push_back({ "closed curve" + kind, curveProblem(degree, order, true) });
      if (degree == 3 || order == 2)
      {
        all.push_back({ "grid" + kind, surfaceProblem(degree, order, true) });
        all.push_back({ "scattered points" + kind, surfaceProblem(degree, order, false) });
      }
    }
  }
  return all;
}

/// The ways to the limit that are tested. N^T N of a surface of degree 5 is so badly conditioned
/// that the paper's step takes minutes for twelve digits; its first 1000 are compared below.
std::vector<FairingSolver> solversFor(const FairingProblem& problem)
{
  std::vector<FairingSolver> solvers = { FairingSolver::BiconjugateGradient,
    FairingSolver::SparseDirect };
  if (problem.Start.Axes[1].degree() < 4)
  {
    solvers.push_back(FairingSolver::ProgressiveIteration);
  }
  return solvers;
}

/// A number of iterations, without a tolerance.
FairingOptions count(int iterations)
{
  FairingOptions options;
  options.MaximumNumberOfIterations = iterations;
  options.Tolerance = 0;
  return options;
}

/// The weights are such that the energy neither vanishes nor rules: omega |D| is of the size of N^T
/// N.
double balancedWeight(const FairingProblem& problem)
{
  FairingProblem half = problem;
  half.Weights.setConstant(0.5);
  const DenseFairing dense(half);
  const double share = (dense.N.transpose() * dense.N).norm() / dense.D.norm();
  return share / (1 + share);
}

TEST(FairingIteration, IsTheDenseIteration)
{
  for (Named& named : problems())
  {
    FairingProblem& problem = named.Problem;
    const double weight = balancedWeight(problem);
    for (const bool equal : { true, false })
    {
      problem.Weights = equal ? Vector(Vector::Constant(problem.Start.size(), weight))
                              : randomWeights(problem.Start.size(), weight / 100, weight, 3);
      const DenseFairing dense(problem);
      for (const int iterations : { 1, 10, 1000 })
      {
        TensorSpline spline;
        const FairingResult result = problem.solve(count(iterations), spline);
        const Eigen::MatrixXd expected =
          dense.iterate(problem.Start.ControlPoints, dense.stepSizes(), iterations);
        EXPECT_EQ(result.Status, FairingStatus::AllDone);
        EXPECT_EQ(result.NumberOfIterations, iterations);
        EXPECT_LE(difference(spline.ControlPoints, expected), 1e-11)
          << named.Name << ", " << iterations << " iterations";
      }
    }
  }
}

TEST(FairingIteration, RecordsTheHistories)
{
  for (Named& named : problems())
  {
    FairingProblem& problem = named.Problem;
    problem.Weights.setConstant(balancedWeight(problem));
    const DenseFairing dense(problem);
    TensorSpline spline;
    const FairingHistory history = problem.solve(count(20), spline).History;
    ASSERT_EQ(history.IterationError.size(), 21u);
    ASSERT_EQ(history.FittingError.size(), 21u);
    ASSERT_EQ(history.Energy.size(), 21u);
    Eigen::MatrixXd p = problem.Start.ControlPoints;
    const double first = dense.error(p);
    for (std::size_t k = 0; k <= 20; ++k)
    {
      const double fit = rootMeanSquare(problem.Data.Points - dense.N * p);
      const double energy = p.cwiseProduct(dense.D * p).sum();
      EXPECT_NEAR(history.IterationError[k], dense.error(p) / first, 1e-11) << named.Name;
      EXPECT_NEAR(history.FittingError[k], fit, 1e-9 * history.FittingError[0]) << named.Name;
      EXPECT_NEAR(history.Energy[k], energy, 1e-10 * energy) << named.Name;
      p = dense.iterate(p, dense.stepSizes(), 1);
    }
  }
}

/// The minimiser of (1 - omega) |Q - N P|^2 + omega P^T D P as a dense least-squares problem of its
/// own: the root of D from its eigenvalues, then a QR factorisation.
Eigen::MatrixXd energyMinimiser(const DenseFairing& dense, const FairingProblem& problem)
{
  const double weight = problem.Weights[0];
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense.D);
  const Eigen::MatrixXd root =
    eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
  Eigen::MatrixXd rows(dense.N.rows() + root.rows(), dense.N.cols());
  rows << std::sqrt(1 - weight) * dense.N, std::sqrt(weight) * root;
  Eigen::MatrixXd targets = Eigen::MatrixXd::Zero(rows.rows(), 3);
  targets.topRows(dense.N.rows()) = std::sqrt(1 - weight) * problem.Data.Points;
  return rows.colPivHouseholderQr().solve(targets);
}

/// To rounding, all but.
void expectAllSolversReach(const Eigen::MatrixXd& controlPoints, const Named& named)
{
  for (const FairingSolver solver : solversFor(named.Problem))
  {
    FairingOptions options;
    options.Solver = solver;
    options.Tolerance = 1e-12;
    options.MaximumNumberOfIterations = 1000000;
    TensorSpline spline;
    EXPECT_EQ(named.Problem.solve(options, spline).Status, FairingStatus::Converged) << named.Name;
    EXPECT_LE(difference(spline.ControlPoints, controlPoints), 1e-8)
      << named.Name << ", solver " << static_cast<int>(solver);
  }
}

TEST(FairingIteration, EqualWeightsGiveTheMinimiserOfTheEnergy)
{
  for (Named& named : problems())
  {
    FairingProblem& problem = named.Problem;
    problem.Weights.setConstant(balancedWeight(problem));
    const DenseFairing dense(problem);
    const Eigen::MatrixXd expected = energyMinimiser(dense, problem);
    expectAllSolversReach(expected, named);
  }
}

TEST(FairingIteration, UnequalWeightsSolveTheirEquations)
{
  for (Named& named : problems())
  {
    FairingProblem& problem = named.Problem;
    const double weight = balancedWeight(problem);
    problem.Weights = randomWeights(problem.Start.size(), weight / 30, weight, 37);
    const DenseFairing dense(problem);
    const Eigen::MatrixXd expected = dense.A.fullPivLu().solve(dense.B);
    expectAllSolversReach(expected, named);
  }
}

/// Convergence is proven for diagonally dominant A only. Weights that jump by a factor of a
/// thousand between neighbours of degree 5 give I - M A a spectral radius above 1; that is told.
TEST(FairingIteration, OfWildWeightsCanDivergeAndSaysSo)
{
  FairingProblem problem = surfaceProblem(5, 2, true);
  const double weight = balancedWeight(problem);
  problem.Weights = randomWeights(problem.Start.size(), weight / 1000, weight, 37);
  const DenseFairing dense(problem);
  const Eigen::MatrixXd step =
    Eigen::MatrixXd::Identity(72, 72) - Eigen::MatrixXd(dense.stepSizes().asDiagonal() * dense.A);
  EXPECT_GT(
    Eigen::EigenSolver<Eigen::MatrixXd>(step, false).eigenvalues().cwiseAbs().maxCoeff(), 1);
  FairingOptions options;
  options.MaximumNumberOfIterations = 1000000;
  TensorSpline spline;
  EXPECT_EQ(problem.solve(options, spline).Status, FairingStatus::Diverged);
  options.Solver = FairingSolver::SparseDirect;
  EXPECT_EQ(problem.solve(options, spline).Status, FairingStatus::Converged);
  EXPECT_LE(difference(spline.ControlPoints, dense.A.fullPivLu().solve(dense.B)), 1e-8);
}

/// The theorem of the appendix: equal weights, singular A, one mu below 2 / lambda_max. The limit
/// is A^+ (1 - omega) N^T Q + (I - A^+ A) P^0.
TEST(FairingIteration, SingularSystemsKeepWhatTheyDoNotSee)
{
  for (const bool closed : { false, true })
  {
    for (const double weight : { 0.0, 1.0 })
    {
      // Without energy: no data beyond a third of the domain. With energy alone: lines are free.
      FairingProblem problem = curveProblem(3, 2, closed);
      problem.Data.Parameters[0] /= 3;
      problem.Start.Axes[0] = uniformKnots(3, 12, closed);
      problem.Start.ControlPoints = ipia::test::wavyPoints(12, false, 11);
      problem.Weights = Vector::Constant(12, weight);
      const DenseFairing dense(problem);
      const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(dense.A);
      ASSERT_LT(decomposition.rank(), 12);
      const Eigen::MatrixXd inverse = decomposition.pseudoInverse();
      const Eigen::MatrixXd& start = problem.Start.ControlPoints;
      const Eigen::MatrixXd expected = inverse * dense.B + start - inverse * dense.A * start;

      FairingOptions options;
      const double largest =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense.A).eigenvalues().maxCoeff();
      options.StepSize = 1.9 / largest;
      options.Tolerance = 1e-14;
      options.MaximumNumberOfIterations = 3000000;
      TensorSpline spline;
      const FairingResult result = problem.solve(options, spline);
      EXPECT_EQ(result.Status, FairingStatus::Converged);
      EXPECT_LE(difference(spline.ControlPoints, expected), 1e-8)
        << "closed " << closed << ", weight " << weight << ", " << result.NumberOfIterations;
    }
  }
}

/// A direct solution of singular or nearly singular equations is told from one that is determined.
TEST(FairingIteration, DirectSolutionsThatAreNotDeterminedAreSingular)
{
  FairingOptions options;
  options.Solver = FairingSolver::SparseDirect;
  for (const int order : { 1, 2, 3 })
  {
    for (const bool closed : { false, true })
    {
      FairingProblem problem = curveProblem(3, order, closed);
      TensorSpline spline;
      problem.Weights.setConstant(1);
      EXPECT_EQ(problem.solve(options, spline).Status, FairingStatus::Singular);
      problem.Weights.setConstant(balancedWeight(problem));
      EXPECT_EQ(problem.solve(options, spline).Status, FairingStatus::Converged);
      // Its own solution once more: only rounding is left to solve for.
      problem.Start = spline;
      options.Tolerance = 0;
      TensorSpline again;
      EXPECT_EQ(problem.solve(options, again).Status, FairingStatus::Converged);
      EXPECT_LE(difference(again.ControlPoints, spline.ControlPoints), 1e-9);
      options.Tolerance = 1e-6;
    }
  }
}

TEST(FairingIteration, WhatIsNotFiniteIsNotConverged)
{
  for (const FairingSolver solver : { FairingSolver::ProgressiveIteration,
         FairingSolver::BiconjugateGradient, FairingSolver::SparseDirect })
  {
    FairingOptions options;
    options.Solver = solver;
    FairingProblem problem = curveProblem(3, 2, false);
    TensorSpline spline;
    problem.Start.ControlPoints(3, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(problem.solve(options, spline).Status, FairingStatus::NotFinite);
  }
}

TEST(FairingIteration, ConjugateGradientsWithoutToleranceEndAtTheSolution)
{
  FairingProblem problem = curveProblem(3, 2, false);
  problem.Weights.setConstant(balancedWeight(problem));
  FairingOptions options = count(100000);
  options.Solver = FairingSolver::BiconjugateGradient;
  TensorSpline spline;
  const FairingResult result = problem.solve(options, spline);
  EXPECT_EQ(result.Status, FairingStatus::AllDone);
  EXPECT_LE(result.History.IterationError.back(), 1e-12);
}

TEST(FairingIteration, AChangeOfMovableControlPointsStaysInTheirSupport)
{
  FairingProblem problem = curveProblem(3, 2, false, 200, 60);
  FairingOptions options;
  options.Tolerance = 1e-9;
  options.MaximumNumberOfIterations = 100000;
  TensorSpline before;
  ASSERT_EQ(problem.solve(options, before).Status, FairingStatus::Converged);

  problem.Start = before;
  options.Movable.assign(60, 0);
  for (Eigen::Index j = 20; j < 28; ++j)
  {
    problem.Weights[j] = 1e-2;
    options.Movable[static_cast<std::size_t>(j)] = 1;
  }
  const DenseFairing dense(problem);
  Eigen::MatrixXd expected = before.ControlPoints;
  const Eigen::MatrixXd block = dense.A.block(20, 20, 8, 8);
  expected.middleRows(20, 8) +=
    block.fullPivLu().solve((dense.B - dense.A * expected).middleRows(20, 8));
  const std::vector<double>& knots = before.Axes[0].knots();
  for (const FairingSolver solver : { FairingSolver::ProgressiveIteration,
         FairingSolver::BiconjugateGradient, FairingSolver::SparseDirect })
  {
    options.Solver = solver;
    TensorSpline after;
    const FairingResult result = problem.solve(options, after);
    EXPECT_EQ(result.Status, FairingStatus::Converged);
    EXPECT_LE(difference(after.ControlPoints, expected), 1e-8);
    double outside = 0, inside = 0;
    for (int k = 0; k <= 5000; ++k)
    {
      const double t = k / 5000.0;
      double& largest = t > knots[20] && t < knots[27 + 4] ? inside : outside;
      largest = std::max(largest, (after.value(t) - before.value(t)).norm());
    }
    EXPECT_EQ(outside, 0);
    EXPECT_GT(inside, 1e-4);
    EXPECT_EQ(result.History.IterationError.front(), 1);
    EXPECT_LE(result.History.IterationError.back(), 1e-9);
  }
}

TEST(FairingIteration, RaisedWeightsFadeAwayFromTheirSegmentWhereAllMayMove)
{
  FairingProblem problem = curveProblem(3, 2, false, 600, 200);
  FairingOptions options;
  options.Solver = FairingSolver::SparseDirect;
  TensorSpline before, after;
  problem.solve(options, before);
  problem.Weights.segment(90, 10).setConstant(1e-3);
  problem.solve(options, after);
  // The inverse of a well-conditioned band matrix decays exponentially off its diagonal.
  const Eigen::MatrixXd change = after.ControlPoints - before.ControlPoints;
  EXPECT_GT(change.row(95).norm(), 1e-4);
  EXPECT_GT(change.row(85).norm(), 1e-10);
  EXPECT_LT(change.topRows(30).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT(change.bottomRows(30).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(FairingIteration, HasTheSameBitsOnAnyNumberOfThreads)
{
  std::vector<FairingProblem> large = { curveProblem(3, 2, true, 20000, 6000) };
  for (const bool gridded : { true, false })
  {
    FairingProblem problem = surfaceProblem(3, 2, gridded);
    problem.Start.Axes = { uniformKnots(3, 80, false), uniformKnots(3, 70, false) };
    problem.Start.ControlPoints = ipia::test::wavyPoints(5600, false, 41);
    problem.Weights = Vector::Constant(5600, 1e-4);
    large.push_back(problem);
  }
  for (FairingProblem& problem : large)
  {
    problem.Weights = randomWeights(problem.Start.size(), 1e-9, 1e-5, 43);
    for (const FairingSolver solver :
      { FairingSolver::ProgressiveIteration, FairingSolver::BiconjugateGradient })
    {
      FairingOptions options = count(7);
      options.Solver = solver;
      TensorSpline reference;
      const FairingResult first = problem.solve(options, reference, 1);
      for (const int threads : { 1, 2, 4 })
      {
        TensorSpline spline;
        const FairingResult result = problem.solve(options, spline, threads);
        EXPECT_EQ(spline.ControlPoints, reference.ControlPoints) << threads;
        EXPECT_EQ(result.History.IterationError, first.History.IterationError);
        EXPECT_EQ(result.History.FittingError, first.History.FittingError);
        EXPECT_EQ(result.History.Energy, first.History.Energy);
      }
    }
  }
}

TEST(FairingIteration, ReportsHowItEnded)
{
  const FairingProblem problem = curveProblem(3, 2, false);
  TensorSpline spline;
  FairingOptions options;
  options.MaximumNumberOfIterations = 3;
  EXPECT_EQ(problem.solve(options, spline).Status, FairingStatus::NotConverged);

  // Far above 2 / lambda_max.
  options.MaximumNumberOfIterations = 1000;
  options.StepSize = 50 / DenseFairing(problem).A.norm();
  const FairingResult diverged = problem.solve(options, spline);
  EXPECT_EQ(diverged.Status, FairingStatus::Diverged);
  EXPECT_LT(diverged.NumberOfIterations, 1000);

  FairingProblem singular = problem;
  singular.Weights.setZero();
  singular.Data.Parameters[0] /= 3;
  singular.Start.Axes[0] = uniformKnots(3, 20, false);
  options = {};
  options.Solver = FairingSolver::SparseDirect;
  EXPECT_EQ(singular.solve(options, spline).Status, FairingStatus::Singular);

  int calls = 0;
  double last = 0;
  spline = problem.Start;
  const FairingResult aborted = iterateFairing(problem.system(),
    fittingResiduals(spline, problem.Data, 1), FairingOptions(), spline,
    [&](double share)
    {
      EXPECT_GE(share, last);
      EXPECT_LE(share, 1);
      last = share;
      return ++calls < 5;
    });
  EXPECT_EQ(aborted.Status, FairingStatus::Aborted);
  EXPECT_EQ(aborted.NumberOfIterations, 4);
  EXPECT_EQ(calls, 5);
}

/// Begun where it ended, with the same weights, there is nothing left but rounding.
TEST(FairingIteration, OfItsOwnLimitEndsAtOnce)
{
  FairingProblem problem = curveProblem(3, 2, true);
  FairingOptions direct;
  direct.Solver = FairingSolver::SparseDirect;
  TensorSpline limit, spline;
  problem.solve(direct, limit);
  problem.Start = limit;
  const FairingResult result = problem.solve(FairingOptions(), spline);
  EXPECT_EQ(result.Status, FairingStatus::Converged);
  EXPECT_EQ(result.NumberOfIterations, 0);
}

/// Moved and scaled data give moved and scaled control points.
TEST(FairingIteration, MovesAndScalesWithTheData)
{
  const FairingProblem problem = curveProblem(3, 2, false);
  TensorSpline here, there;
  problem.solve(count(300), here);
  FairingProblem moved = problem;
  const Eigen::RowVector3d offset(3, -2, 5);
  moved.Data.Points = (1e3 * moved.Data.Points).rowwise() + offset;
  moved.Start.ControlPoints = (1e3 * moved.Start.ControlPoints).rowwise() + offset;
  moved.solve(count(300), there);
  EXPECT_LE(difference(there.ControlPoints, (1e3 * here.ControlPoints).rowwise() + offset), 1e-8);
}
}
