// SPDX-License-Identifier: BSD-3-Clause
#include "LeastSquaresSolver.h"

#include "Parallel.h"
#include "SolverControl.h"

#include <cmath>
#include <limits>

namespace ipia
{
namespace
{
template <int Dim>
void progressiveIteration(const CollocationOperator<Dim>& collocation, const SolverOptions& options,
  Vector& c, IterationControl& control, SolverResult& result)
{
  const ChunkedVectors vectors(collocation.threads());
  OscillationTerm<Dim> oscillation(
    collocation.lattice(), options.Oscillation, collocation.threads());
  Vector gradient;
  collocation.columnSums(gradient);
  const double largest = gradient.size() ? gradient.maxCoeff() : 0.0;
  result.StepSize = oscillation.chooseStepSize(largest, options.StepSize);
  const double weightSum = gradient.sum() // the basis is a partition of unity
    + oscillation.sumOfWeights();

  // Of the rows, and what the steps descend.
  double energy = 0, descended = 0;
  const auto evaluate = [&]
  {
    energy = collocation.residual(c, gradient);
    oscillation.update(c);
    if (oscillation.isActive())
    {
      vectors.add(-oscillation.kappa(), oscillation.laplacian(), gradient);
    }
    result.Energy = energy + oscillation.energy();
    descended = energy + oscillation.descendedEnergy();
  };
  double before = Infinity;
  evaluate();
  while (
    control.proceed(std::sqrt(vectors.dot(gradient, gradient)), std::abs(before - result.Energy)))
  {
    vectors.add(result.StepSize, gradient, c);
    before = result.Energy;
    const double descendedBefore = descended;
    evaluate();
    if (energyRose(descendedBefore, descended, weightSum, c))
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
void conjugateGradient(const CollocationOperator<Dim>& collocation, const SolverOptions& options,
  Vector& c, IterationControl& control, SolverResult& result)
{
  const ChunkedVectors vectors(collocation.threads());
  OscillationTerm<Dim> oscillation(
    collocation.lattice(), options.Oscillation, collocation.threads());
  // Subtracts sign kappa L x; returns lambda R(x).
  const auto addOscillation = [&](const Vector& x, double sign, Vector& to)
  {
    oscillation.update(x);
    if (oscillation.isActive())
    {
      vectors.add(-sign * oscillation.kappa(), oscillation.laplacian(), to);
    }
    return oscillation.energy();
  };
  Vector residual, product;
  result.Energy = collocation.residual(c, residual);
  result.Energy += addOscillation(c, 1, residual);
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
      addOscillation(direction, -1, product);
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
    result.Energy += addOscillation(c, 1, residual);
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
    conjugateGradient(collocation, options, coefficients, control, result);
  }
  return result;
}

template SolverResult solveLeastSquares<2>(
  const CollocationOperator<2>&, const SolverOptions&, Vector&, const ProgressCallback&);
template SolverResult solveLeastSquares<3>(
  const CollocationOperator<3>&, const SolverOptions&, Vector&, const ProgressCallback&);
}
