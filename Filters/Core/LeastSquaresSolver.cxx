// SPDX-License-Identifier: BSD-3-Clause
#include "LeastSquaresSolver.h"

#include "Parallel.h"

#include <cmath>
#include <limits>

namespace ipia
{
namespace
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
 * Whether the energy rose by more than rounding, which a converging step never does. Near 0, where
 * all rows are met, the energy is rounding alone and goes up and down.
 *
 * @param weightSum  sum_k w_k
 */
bool energyRose(double before, double after, double weightSum, const Vector& coefficients)
{
  if (after <= before)
  {
    return false;
  }
  // By the triangle inequality for sqrt(E), the weighted norm of the residuals.
  const double rounding =
    std::sqrt(weightSum) * RoundingOfValues * coefficients.cwiseAbs().maxCoeff();
  return !(std::sqrt(after) <= std::sqrt(before) * (1 + 1e-6) + rounding);
}

template <int Dim>
void progressiveIteration(const CollocationOperator<Dim>& collocation, const SolverOptions& options,
  Vector& c, IterationControl& control, SolverResult& result)
{
  const ChunkedVectors vectors(collocation.threads());
  Vector gradient;
  collocation.columnSums(gradient);
  const double largest = gradient.size() ? gradient.maxCoeff() : 0.0;
  const double weightSum = gradient.sum(); // the basis is a partition of unity
  result.StepSize = options.StepSize > 0 ? options.StepSize : largest > 0 ? 2 / largest : 0.0;

  double before = Infinity;
  result.Energy = collocation.residual(c, gradient);
  while (
    control.proceed(std::sqrt(vectors.dot(gradient, gradient)), std::abs(before - result.Energy)))
  {
    vectors.add(result.StepSize, gradient, c);
    before = result.Energy;
    result.Energy = collocation.residual(c, gradient);
    if (energyRose(before, result.Energy, weightSum, c))
    {
      control.record(std::sqrt(vectors.dot(gradient, gradient)));
      result.Status = SolverStatus::Diverged;
      return;
    }
  }
}

/// Where the residual of conjugate gradients ends as rounding, in units of the largest it had.
constexpr double RoundingOfResidual = 32 * std::numeric_limits<double>::epsilon();

template <int Dim>
void conjugateGradient(const CollocationOperator<Dim>& collocation, Vector& c,
  IterationControl& control, SolverResult& result)
{
  const ChunkedVectors vectors(collocation.threads());
  Vector residual, product;
  result.Energy = collocation.residual(c, residual);
  Vector direction = residual;
  double squaredNorm = vectors.dot(residual, residual);
  double largestSquaredNorm = squaredNorm;
  double energyChange = Infinity;
  while (control.proceed(std::sqrt(squaredNorm), energyChange))
  {
    // Rounding leaves a part in the null space of B that no step reduces. Once it is all that is
    // left, the curvature along it is nearly 0, and a step would throw the coefficients far away.
    largestSquaredNorm = std::max(largestSquaredNorm, squaredNorm);
    const bool exhausted =
      squaredNorm <= RoundingOfResidual * RoundingOfResidual * largestSquaredNorm;
    double curvature = 0;
    if (!exhausted)
    {
      collocation.normalProduct(direction, product);
      curvature = vectors.dot(direction, product);
    }
    if (!(curvature > 0))
    {
      --result.NumberOfIterations; // that step is not made
      break;
    }
    const double step = squaredNorm / curvature;
    vectors.add(step, direction, c);
    vectors.add(-step, product, residual);
    energyChange = step * squaredNorm;
    const double next = vectors.dot(residual, residual);
    vectors.scaleAndAdd(next / squaredNorm, residual, direction);
    squaredNorm = next;
  }
  if (result.NumberOfIterations > 0)
  {
    result.Energy = collocation.residual(c, residual);
  }
}
}

template <int Dim>
SolverResult solveLeastSquares(const CollocationOperator<Dim>& collocation,
  const SolverOptions& options, Vector& coefficients, const ProgressCallback& progress)
{
  SolverResult result;
  IterationControl control(options, progress, result);
  if (options.Type == SolverType::ProgressiveIteration)
  {
    progressiveIteration(collocation, options, coefficients, control, result);
  }
  else
  {
    conjugateGradient(collocation, coefficients, control, result);
  }
  return result;
}

template SolverResult solveLeastSquares<2>(
  const CollocationOperator<2>&, const SolverOptions&, Vector&, const ProgressCallback&);
template SolverResult solveLeastSquares<3>(
  const CollocationOperator<3>&, const SolverOptions&, Vector&, const ProgressCallback&);
}
