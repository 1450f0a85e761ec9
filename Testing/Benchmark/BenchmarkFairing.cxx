// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What fairing-PIA costs on large data, against the sparse factorisation of the same equations.
 *
 *   BenchmarkFairing [grid side] [control points per side]     (default 1000 300)
 */
#include "FairingIteration.h"
#include "Parametrization.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

namespace
{
using namespace ipia;

class Clock
{
public:
  double seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  }

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
};

constexpr double Noise = 0.002;
constexpr double Tolerance = 1e-6;

struct Job
{
  FairingData Data;
  TensorSpline Start;
  double Weight = 0;
};

void startFromData(Job& job)
{
  const auto u = initialPoints(job.Start.Axes[0], job.Data.Parameters[0].size());
  const auto v = job.Start.Axes[1].degree() == 0
    ? std::vector<std::int64_t>{ 0 }
    : initialPoints(job.Start.Axes[1], job.Data.Parameters[1].size());
  job.Start.ControlPoints.resize(job.Start.size(), 3);
  for (std::size_t l = 0; l < v.size(); ++l)
  {
    for (std::size_t j = 0; j < u.size(); ++j)
    {
      job.Start.ControlPoints.row(static_cast<Eigen::Index>(j + u.size() * l)) =
        job.Data.Points.row(u[j] + job.Data.Parameters[0].size() * v[l]);
    }
  }
}

/// m points of a wavy closed curve in space, n control points.
Job curveJob(std::int64_t m, std::int64_t n, double weight)
{
  Job job;
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, Noise);
  job.Data.Points.resize(m, 3);
  for (std::int64_t k = 0; k < m; ++k)
  {
    const double a = 6.283185307179586 * static_cast<double>(k) / static_cast<double>(m);
    job.Data.Points.row(k) << std::cos(a) * (1 + 0.3 * std::cos(9 * a)) + noise(random),
      std::sin(a) * (1 + 0.3 * std::cos(9 * a)) + noise(random),
      0.2 * std::sin(30 * a) + noise(random);
  }
  job.Data.Parameters = { parametrize(job.Data.Points, ParametrizationType::Uniform, true),
    Vector::Zero(1) };
  job.Start.Axes[0] = averagedKnots(job.Data.Parameters[0], 3, n, true);
  job.Weight = weight;
  startFromData(job);
  return job;
}

/// A height field on side x side points.
Job surfaceJob(std::int64_t side, std::int64_t n, double weight, bool gridded)
{
  Job job;
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise(0, Noise);
  std::uniform_real_distribution<double> anywhere(0, 1);
  job.Data.Gridded = gridded;
  const std::int64_t m = side * side;
  for (Vector& t : job.Data.Parameters)
  {
    t = Vector::LinSpaced(gridded ? side : m, 0, 1);
    for (std::int64_t k = 0; !gridded && k < m; ++k)
    {
      t[k] = anywhere(random);
    }
  }
  job.Data.Points.resize(m, 3);
  for (std::int64_t k = 0; k < m; ++k)
  {
    const double u = job.Data.Parameters[0][gridded ? k % side : k];
    const double v = job.Data.Parameters[1][gridded ? k / side : k];
    job.Data.Points.row(k) << u, v, 0.1 * std::sin(20 * u) * std::cos(15 * v) + noise(random);
  }
  for (BSplineBasis& axis : job.Start.Axes)
  {
    axis = uniformKnots(3, n, false);
  }
  job.Weight = weight;
  if (gridded)
  {
    startFromData(job);
  }
  else
  {
    job.Start.ControlPoints.resize(n * n, 3);
    for (Eigen::Index c = 0; c < 3; ++c)
    {
      job.Start.ControlPoints.col(c) =
        carryToControlPoints(job.Start.Axes, job.Data, job.Data.Points.col(c), 0);
    }
  }
  return job;
}

const char* const SolverNames[] = { "fairing-PIA", "biconjugate gradients", "sparse direct" };

void run(const Job& job, FairingSolver solver, int iterations)
{
  TensorSpline spline = job.Start;
  const Clock setUp;
  const FairingSystem system(
    job.Start.Axes, job.Data, Vector::Constant(job.Start.size(), job.Weight), 2, 0);
  const Eigen::MatrixXd residuals = fittingResiduals(spline, job.Data, 0);
  const double setUpSeconds = setUp.seconds();
  FairingOptions options;
  options.Solver = solver;
  options.Tolerance = Tolerance;
  options.MaximumNumberOfIterations = iterations;
  const Clock clock;
  const FairingResult result = iterateFairing(system, residuals, options, spline);
  const double seconds = clock.seconds();
  std::printf(
    "  %-22s set-up %6.2f s, %5d iterations %7.2f s (%.2f ms each), iteration error %.1e, "
    "fitting error %.6f, energy %.5g\n",
    SolverNames[static_cast<int>(solver)], setUpSeconds, result.NumberOfIterations, seconds,
    1e3 * seconds / std::max(result.NumberOfIterations, 1), result.History.IterationError.back(),
    result.History.FittingError.back(), result.History.Energy.back());
  std::fflush(stdout);
}

void compare(const char* title, const Job& job, int iterations)
{
  std::printf("%s, weight %g\n", title, job.Weight);
  for (const FairingSolver solver : { FairingSolver::ProgressiveIteration,
         FairingSolver::BiconjugateGradient, FairingSolver::SparseDirect })
  {
    run(job, solver, iterations);
  }
}
}

int main(int argc, char* argv[])
{
  const std::int64_t side = argc > 1 ? std::atoll(argv[1]) : 1000;
  const std::int64_t controls = argc > 2 ? std::atoll(argv[2]) : 300;
  std::printf("iteration error asked for: %g\n\nset-up and iteration against the number of points, "
              "curves with 10 000 control points\n",
    Tolerance);
  for (const std::int64_t m : { 250000, 500000, 1000000, 2000000 })
  {
    std::printf("%9lld points\n", static_cast<long long>(m));
    run(curveJob(m, 10000, 1e-12), FairingSolver::ProgressiveIteration, 100);
  }
  std::printf("\n");
  compare(
    "curve of 1 000 000 points, 10 000 control points", curveJob(1000000, 10000, 1e-12), 1000);
  compare("curve of 1 000 000 points, 10 000 control points", curveJob(1000000, 10000, 1e-8), 1000);
  std::printf("\nsurface of %lld x %lld points, %lld x %lld control points\n",
    static_cast<long long>(side), static_cast<long long>(side), static_cast<long long>(controls),
    static_cast<long long>(controls));
  compare("grid", surfaceJob(side, controls, 1e-9, true), 1000);
  compare("grid", surfaceJob(side, controls, 1e-5, true), 1000);
  compare("scattered points", surfaceJob(side, controls, 1e-9, false), 1000);
  return 0;
}
