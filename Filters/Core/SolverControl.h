// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the solvers share: vector operations, when to stop, and when a step has failed.
 */
#ifndef ipia_SolverControl_h
#define ipia_SolverControl_h

#include "LeastSquaresSolver.h"
#include "Parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ipia
{
/// Vector operations in fixed chunks, so that they give the same bits on any number of threads.
class ChunkedVectors
{
public:
  explicit ChunkedVectors(int threads)
    : Threads(threads)
  {
  }

  double dot(const Vector& a, const Vector& b) const
  {
    return parallelSum(a.size(), this->Threads,
      [&](std::int64_t begin, std::int64_t end)
      { return a.segment(begin, end - begin).dot(b.segment(begin, end - begin)); });
  }

  /// y += a x
  void add(double a, const Vector& x, Vector& y) const
  {
    parallelChunks(y.size(), this->Threads,
      [&](std::int64_t begin, std::int64_t end)
      { y.segment(begin, end - begin) += a * x.segment(begin, end - begin); });
  }

  /// y = x + a y
  void scaleAndAdd(double a, const Vector& x, Vector& y) const
  {
    parallelChunks(y.size(), this->Threads,
      [&](std::int64_t begin, std::int64_t end)
      {
        y.segment(begin, end - begin) =
          x.segment(begin, end - begin) + a * y.segment(begin, end - begin);
      });
  }

private:
  int Threads;
};

/// What both solvers ask before each iteration.
class IterationControl
{
public:
  IterationControl(
    const SolverOptions& options, const ProgressCallback& progress, SolverResult& result)
    : Options(options)
    , Progress(progress)
    , Result(result)
  {
  }

  /// Appends to the history; called once for each state of the coefficients.
  double record(double gradientNorm)
  {
    if (this->Result.NumberOfIterations == 0)
    {
      this->FirstNorm = gradientNorm;
    }
    const double relative = this->FirstNorm > 0 ? gradientNorm / this->FirstNorm : 0.0;
    this->Result.ResidualHistory.push_back(relative);
    return relative;
  }

  /// Records the state of the current coefficients; true to iterate on.
  bool proceed(double gradientNorm, double energyChange)
  {
    const double relative = this->record(gradientNorm);
    const double measure =
      this->Options.Rule == StoppingRule::RelativeResidual ? relative : energyChange;
    if (gradientNorm == 0 || measure < this->Options.Tolerance ||
      this->Result.NumberOfIterations >= this->Options.MaximumNumberOfIterations)
    {
      return false;
    }
    if (this->Progress &&
      !this->Progress(
        double(this->Result.NumberOfIterations) / this->Options.MaximumNumberOfIterations))
    {
      this->Result.Status = SolverStatus::Aborted;
      return false;
    }
    ++this->Result.NumberOfIterations;
    return true;
  }

private:
  const SolverOptions& Options;
  const ProgressCallback& Progress;
  SolverResult& Result;
  double FirstNorm = 0;
};

constexpr double Infinity = std::numeric_limits<double>::infinity();

/// Rounding of a value f(x), a sum of up to 64 products, in units of the largest coefficient.
constexpr double RoundingOfValues = 64 * std::numeric_limits<double>::epsilon();

/**
 * The largest energy that is no rise from @a before but rounding. Near 0, where all rows are met,
 * the energy is rounding alone and goes up and down.
 *
 * @param weightSum           sum_k w_k
 * @param largestCoefficient  the largest |c_i|
 * @param slack               relative growth of sqrt(E) that does not count
 */
inline double energyBound(double before, double weightSum, double largestCoefficient, double slack)
{
  // By the triangle inequality for sqrt(E), the weighted norm of the residuals.
  const double norm =
    std::sqrt(before) * (1 + slack) + std::sqrt(weightSum) * RoundingOfValues * largestCoefficient;
  return std::max(before, norm * norm);
}

/// Whether the energy rose by more than rounding, which a converging step never does.
inline bool energyRose(
  double before, double after, double weightSum, const Vector& coefficients, double slack = 1e-6)
{
  return !(after <= before) &&
    !(after <= energyBound(before, weightSum, coefficients.cwiseAbs().maxCoeff(), slack));
}
}

#endif
