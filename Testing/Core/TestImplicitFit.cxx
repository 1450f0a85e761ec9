// SPDX-License-Identifier: BSD-3-Clause
#include "ImplicitFit.h"

#include "TestSupport.h"

namespace
{
using namespace ipia;
using ipia::test::OrientedPoints;
using ipia::test::relativeDifference;

enum class Offsets
{
  Outward,
  TwoSided
};

template <int Dim>
struct Problem
{
  Lattice<Dim> Grid;
  FitInput<Dim> Input;
};

/// 9 x 9 or 8 x 7 x 9 coefficients, uneven spacings, weights, extra rows, one offset row that
/// leaves the domain and one point without a normal.
template <int Dim>
Problem<Dim> makeProblem(Offsets offsets)
{
  Problem<Dim> problem;
  const std::array<std::int64_t, 3> sizes =
    Dim == 2 ? std::array<std::int64_t, 3>{ 9, 9, 0 } : std::array<std::int64_t, 3>{ 8, 7, 9 };
  const std::array<double, 3> spacings = { 0.5, 0.7, 0.4 };
  for (int a = 0; a < Dim; ++a)
  {
    problem.Grid.Size[a] = sizes[static_cast<std::size_t>(a)];
    problem.Grid.Spacing[a] = spacings[static_cast<std::size_t>(a)];
  }
  const Point<Dim> upper = ipia::test::extents(problem.Grid);
  const std::int64_t n = Dim == 2 ? 60 : 150;
  const OrientedPoints<Dim> sphere = ipia::test::spherePoints<Dim>(upper / 2, 0.8, n);
  ipia::test::Random random(61);
  FitInput<Dim>& input = problem.Input;
  input.Positions = sphere.Positions;
  input.Normals = sphere.Normals;
  input.Positions.col(4) = upper;
  input.Normals.col(4) = Point<Dim>::Unit(0);
  input.Normals.col(5).setZero();
  input.Weights = random.vector(n, 0.2, 2);
  input.OutwardDistance = random.vector(n, 0.1, 0.3);
  input.OutwardDistance[6] = 0;
  if (offsets == Offsets::TwoSided)
  {
    input.OutwardValue = 0.01;
    input.InwardDistance = random.vector(n, 0.1, 0.3);
    input.InwardValue = 0.02;
  }
  input.ExtraPositions = random.pointsIn(problem.Grid, 12);
  input.ExtraPositions.col(0).setZero();
  input.ExtraValues = random.vector(12, -0.5, 0.5);
  return problem;
}

/// D, b and W as the definition of the method has them.
template <int Dim>
struct DenseProblem
{
  Eigen::MatrixXd D;
  Vector Targets, Weights;

  explicit DenseProblem(const Problem<Dim>& problem)
  {
    const FitInput<Dim>& input = problem.Input;
    const Point<Dim> upper = ipia::test::extents(problem.Grid);
    std::vector<Point<Dim>> positions;
    std::vector<double> targets, weights;
    const auto append = [&](const Point<Dim>& x, double target, double weight)
    {
      if ((x.array() >= 0).all() && (x.array() <= upper.array()).all())
      {
        positions.push_back(x);
        targets.push_back(target);
        weights.push_back(weight);
      }
    };
    for (Eigen::Index k = 0; k < input.Positions.cols(); ++k)
    {
      const Point<Dim> p = input.Positions.col(k), normal = input.Normals.col(k);
      append(p, 0, input.Weights[k]);
      if (normal.norm() > 0 && input.OutwardDistance[k] > 0)
      {
        append(p + input.OutwardDistance[k] * normal,
          input.OutwardValue > 0 ? input.OutwardValue : input.OutwardDistance[k], input.Weights[k]);
      }
      if (normal.norm() > 0 && input.InwardDistance.size())
      {
        append(p - input.InwardDistance[k] * normal,
          -(input.InwardValue > 0 ? input.InwardValue : input.InwardDistance[k]), input.Weights[k]);
      }
    }
    for (Eigen::Index k = 0; k < input.ExtraPositions.cols(); ++k)
    {
      append(input.ExtraPositions.col(k), input.ExtraValues[k], 1);
    }
    const auto n = static_cast<Eigen::Index>(positions.size());
    Points<Dim> all(Dim, n);
    for (Eigen::Index k = 0; k < n; ++k)
    {
      all.col(k) = positions[static_cast<std::size_t>(k)];
    }
    this->D = ipia::test::collocationMatrix(problem.Grid, all);
    this->Targets = Eigen::Map<const Vector>(targets.data(), n);
    this->Weights = Eigen::Map<const Vector>(weights.data(), n);
  }

  double stepSize() const { return 2 / (this->D.transpose() * this->Weights).maxCoeff(); }

  /// C <- C + mu D^T W (b - D C) from 0.
  Vector iterate(int iterations) const
  {
    Vector c = Vector::Zero(this->D.cols());
    for (int k = 0; k < iterations; ++k)
    {
      c += this->stepSize() * this->D.transpose() *
        this->Weights.cwiseProduct(this->Targets - this->D * c);
    }
    return c;
  }
};

FitOptions splineAlone(SolverType type, int iterations)
{
  FitOptions options;
  options.Solver.Type = type;
  options.Solver.MaximumNumberOfIterations = iterations;
  options.FarField.Threshold = 0;
  options.Threads = 1;
  return options;
}

template <typename T>
class ImplicitFit : public ::testing::Test
{
};
TYPED_TEST_SUITE(ImplicitFit, ipia::test::Dimensions);

TYPED_TEST(ImplicitFit, IsTheDenseIteration)
{
  constexpr int Dim = TypeParam::value;
  for (const Offsets offsets : { Offsets::Outward, Offsets::TwoSided })
  {
    const Problem<Dim> problem = makeProblem<Dim>(offsets);
    const DenseProblem<Dim> dense(problem);
    for (const int iterations : { 1, 10, 200 })
    {
      const FitResult<Dim> result = fitImplicit(
        problem.Grid, problem.Input, splineAlone(SolverType::ProgressiveIteration, iterations));
      EXPECT_EQ(result.Solver.NumberOfIterations, iterations);
      EXPECT_NEAR(result.Solver.StepSize, dense.stepSize(), 1e-13 * dense.stepSize());
      EXPECT_LE(
        relativeDifference(result.Function.coefficients(), dense.iterate(iterations)), 1e-12)
        << iterations << " iterations";
    }
  }
}

TYPED_TEST(ImplicitFit, ReportsTheFiguresOfTheFit)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem = makeProblem<Dim>(Offsets::TwoSided);
  const DenseProblem<Dim> dense(problem);
  const FitResult<Dim> result =
    fitImplicit(problem.Grid, problem.Input, splineAlone(SolverType::ProgressiveIteration, 10));
  const Vector c = dense.iterate(10);
  const Vector atData = ipia::test::collocationMatrix(problem.Grid, problem.Input.Positions) * c;
  EXPECT_NEAR(result.MaximumError, atData.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(
    result.AverageError, atData.squaredNorm() / static_cast<double>(atData.size()), 1e-13);
  const double energy = dense.Weights.dot((dense.Targets - dense.D * c).cwiseAbs2());
  EXPECT_NEAR(result.Solver.Energy, energy, 1e-12 * energy);

  const Vector support = dense.D.colwise().sum().transpose();
  const Vector supportAtData =
    ipia::test::collocationMatrix(problem.Grid, problem.Input.Positions) * support;
  std::vector<double> sorted(supportAtData.begin(), supportAtData.end());
  std::sort(sorted.begin(), sorted.end());
  EXPECT_LE(relativeDifference(result.Support, support / sorted[sorted.size() / 2]), 1e-12);
}

TYPED_TEST(ImplicitFit, OscillationIsTheDoubleSumOverNeighbours)
{
  constexpr int Dim = TypeParam::value;
  const Lattice<Dim> lattice = ipia::test::anisotropicLattice<Dim>();
  const Vector c = ipia::test::Random(71).vector(lattice.numberOfCoefficients(), -1, 1);
  double expected = 0;
  for (std::int64_t i = 0; i < c.size(); ++i)
  {
    for (std::int64_t j = 0; j < c.size(); ++j)
    {
      std::int64_t steps = 0, restI = i, restJ = j;
      for (int a = 0; a < Dim; ++a)
      {
        steps += std::abs(restI % lattice.Size[a] - restJ % lattice.Size[a]);
        restI /= lattice.Size[a];
        restJ /= lattice.Size[a];
      }
      expected += steps == 1 ? (c[i] - c[j]) * (c[i] - c[j]) : 0.0;
    }
  }
  EXPECT_NEAR(oscillation(lattice, c), expected, 1e-13 * expected);

  const Problem<Dim> problem = makeProblem<Dim>(Offsets::Outward);
  const FitResult<Dim> result =
    fitImplicit(problem.Grid, problem.Input, splineAlone(SolverType::ProgressiveIteration, 5));
  EXPECT_EQ(result.Oscillation, oscillation(problem.Grid, result.Function.coefficients()));
}

/// A sphere with a two-sided offset of one spacing, in units of @a scale.
template <int Dim>
FitResult<Dim> fitSphere(double scale, SolverType type, int threads)
{
  Lattice<Dim> lattice;
  lattice.Size.fill(Dim == 2 ? 123 : 27);
  lattice.Spacing.setConstant(4 * scale / static_cast<double>(lattice.cells(0)));
  const OrientedPoints<Dim> sphere =
    ipia::test::spherePoints<Dim>(Point<Dim>::Constant(2.01), 1.4, Dim == 2 ? 700 : 2500);
  FitInput<Dim> input;
  input.Positions = scale * sphere.Positions;
  input.Normals = sphere.Normals;
  input.OutwardDistance = Vector::Constant(sphere.Positions.cols(), lattice.Spacing[0]);
  input.InwardDistance = input.OutwardDistance;
  FitOptions options;
  options.Solver.Type = type;
  options.Solver.MaximumNumberOfIterations = 20;
  options.FarField.Magnitude = lattice.Spacing[0];
  options.Threads = threads;
  return fitImplicit(lattice, input, options);
}

template <int Dim>
std::vector<double> samplesOf(const ImplicitSpline<Dim>& function, int threads)
{
  AxisPositions<Dim> positions;
  std::size_t size = 1;
  for (int a = 0; a < Dim; ++a)
  {
    for (int k = 0; k < 50; ++k)
    {
      positions[a].push_back(function.lattice().extent(a) * (k + 0.37) / 50);
    }
    size *= positions[a].size();
  }
  std::vector<double> samples(size);
  function.sample(positions, samples.data(), threads);
  return samples;
}

TYPED_TEST(ImplicitFit, HasTheSameBitsOnAnyNumberOfThreads)
{
  constexpr int Dim = TypeParam::value;
  for (const SolverType type : { SolverType::ProgressiveIteration, SolverType::ConjugateGradient })
  {
    const FitResult<Dim> reference = fitSphere<Dim>(1, type, 1);
    const std::vector<double> samples = samplesOf(reference.Function, 1);
    for (const int threads : { 1, 2, 4, 4 })
    {
      const FitResult<Dim> result = fitSphere<Dim>(1, type, threads);
      EXPECT_TRUE(
        ipia::test::sameBits(result.Function.coefficients(), reference.Function.coefficients()))
        << threads << " threads";
      EXPECT_TRUE(ipia::test::sameBits(result.Support, reference.Support));
      EXPECT_EQ(result.Function.farField().Sign, reference.Function.farField().Sign);
      EXPECT_EQ(result.Solver.ResidualHistory, reference.Solver.ResidualHistory);
      EXPECT_EQ(result.MaximumError, reference.MaximumError);
      EXPECT_EQ(result.AverageError, reference.AverageError);
      EXPECT_EQ(result.Oscillation, reference.Oscillation);
      EXPECT_EQ(samplesOf(result.Function, threads), samples);
    }
  }
}

TYPED_TEST(ImplicitFit, ScalesWithTheUnitOfLength)
{
  constexpr int Dim = TypeParam::value;
  for (const SolverType type : { SolverType::ProgressiveIteration, SolverType::ConjugateGradient })
  {
    const FitResult<Dim> reference = fitSphere<Dim>(1, type, 2);
    const std::vector<double> samples = samplesOf(reference.Function, 2);
    for (const double scale : { 1e-6, 1e6 })
    {
      const FitResult<Dim> result = fitSphere<Dim>(scale, type, 2);
      EXPECT_EQ(result.Solver.Status, SolverStatus::Done);
      EXPECT_EQ(result.Solver.NumberOfIterations, reference.Solver.NumberOfIterations);
      EXPECT_LE(relativeDifference(
                  result.Function.coefficients(), scale * reference.Function.coefficients()),
        1e-9);
      EXPECT_EQ(result.Function.farField().Sign, reference.Function.farField().Sign);
      std::vector<double> scaled = samplesOf(result.Function, 2);
      double largest = 0;
      for (std::size_t k = 0; k < scaled.size(); ++k)
      {
        largest = std::max(largest, std::abs(scaled[k] / scale - samples[k]));
      }
      EXPECT_LE(largest, 1e-9);
      EXPECT_NEAR(result.MaximumError, scale * reference.MaximumError, 1e-9 * scale);
      EXPECT_NEAR(result.AverageError / (scale * scale), reference.AverageError, 1e-9);
    }
  }
}

/// A domain far larger than the data moves them by whole cells: the function moves along.
TYPED_TEST(ImplicitFit, MovesWithThePoints)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem = makeProblem<Dim>(Offsets::TwoSided);
  Problem<Dim> moved = problem;
  constexpr std::int64_t shift = 5;
  Point<Dim> distance;
  for (int a = 0; a < Dim; ++a)
  {
    moved.Grid.Size[a] += shift;
    distance[a] = shift * problem.Grid.Spacing[a];
  }
  moved.Input.Positions.colwise() += distance;
  moved.Input.ExtraPositions.colwise() += distance;
  const FitOptions options = splineAlone(SolverType::ProgressiveIteration, 50);
  const ImplicitSpline<Dim> there = fitImplicit(problem.Grid, problem.Input, options).Function;
  const ImplicitSpline<Dim> here = fitImplicit(moved.Grid, moved.Input, options).Function;
  const Points<Dim> x = ipia::test::Random(81).pointsIn(problem.Grid, 300);
  for (Eigen::Index k = 0; k < x.cols(); ++k)
  {
    EXPECT_NEAR(here.value(x.col(k) + distance), there.value(x.col(k)), 1e-12);
  }
}

TYPED_TEST(ImplicitFit, IsTheSignedDistanceNearASphere)
{
  constexpr int Dim = TypeParam::value;
  const FitResult<Dim> result = fitSphere<Dim>(1, SolverType::ConjugateGradient, 0);
  const OrientedPoints<Dim> probes =
    ipia::test::spherePoints<Dim>(Point<Dim>::Constant(2.01), 1.4, 333);
  const double h = result.Function.lattice().Spacing[0];
  for (Eigen::Index k = 0; k < probes.Positions.cols(); ++k)
  {
    for (const double distance : { -1.0, 0.0, 1.0 })
    {
      EXPECT_NEAR(
        result.Function.value(probes.Positions.col(k) + distance * h * probes.Normals.col(k)),
        distance * h, 0.05 * h);
    }
    EXPECT_GT(
      result.Function.gradient(probes.Positions.col(k)).normalized().dot(probes.Normals.col(k)),
      0.99);
  }
}

TYPED_TEST(ImplicitFit, ReportsAnAbort)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem = makeProblem<Dim>(Offsets::Outward);
  FitOptions options = splineAlone(SolverType::ConjugateGradient, 30);
  int calls = 0;
  const FitResult<Dim> result =
    fitImplicit<Dim>(problem.Grid, problem.Input, options, [&](double) { return ++calls < 4; });
  EXPECT_EQ(result.Solver.Status, SolverStatus::Aborted);
  EXPECT_EQ(calls, 4);
}

TYPED_TEST(ImplicitFit, ReportsDivergence)
{
  constexpr int Dim = TypeParam::value;
  const Problem<Dim> problem = makeProblem<Dim>(Offsets::Outward);
  FitOptions options = splineAlone(SolverType::ProgressiveIteration, 500);
  options.Solver.StepSize = 50 * DenseProblem<Dim>(problem).stepSize();
  const FitResult<Dim> result = fitImplicit(problem.Grid, problem.Input, options);
  EXPECT_EQ(result.Solver.Status, SolverStatus::Diverged);
  EXPECT_LT(result.Solver.NumberOfIterations, 500);
}
}
