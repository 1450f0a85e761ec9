// SPDX-License-Identifier: BSD-3-Clause
#include "RationalSolver.h"

#include "RationalOperator.h"
#include "SolverControl.h"

#include <algorithm>

namespace ipia
{
namespace
{
/// Denominators below this count as 0.
constexpr double SmallestDenominator = 1e-9;

/// A step of the weights that is halved so often is no step.
constexpr int MostHalvings = 60;

/// Growth of sqrt(E) that rounding may cause.
constexpr double RoundingOfEnergy = 1e-13;

/// The state of the iteration, and its two steps.
template <int Dim>
class RationalIteration
{
public:
  RationalIteration(const ConstraintRows<Dim>& rows, const SolverOptions& options,
    const RationalOptions& rationalOptions, int threads, Vector& coefficients)
    : Operator(rows, threads)
    , Options(options)
    , Tau(rationalOptions.WeightStepSize)
    , C(coefficients)
    , Vectors(Operator.threads())
    , Oscillation(rows.lattice(), options.Oscillation, Operator.threads())
    , WeightSum(Operator.sumOfRowWeights())
  {
    this->W = this->NewW = Vector::Ones(this->C.size());
    this->Pairs.resize(2, this->C.size());
    this->Pairs.row(0) = this->C;
    this->Pairs.row(1).setOnes();
    this->Operator.coefficientSums(this->Pairs, this->CoefficientSums);
    this->chooseStepSize();
    this->evaluate();
  }

  /// ||D^T V r - kappa L c||
  double gradientNorm() const
  {
    if (!this->Oscillation.isActive())
    {
      return std::sqrt(this->Operator.touched().reduce(
        this->Operator.threads(), 0.0,
        [&](std::int64_t begin, std::int64_t end, double& partial)
        {
          for (std::int64_t i = begin; i < end; ++i)
          {
            const double g = this->W[i] * this->WeightSums(0, i);
            partial += g * g;
          }
        },
        [](double a, double b) { return a + b; }));
    }
    const Vector& laplacian = this->Oscillation.laplacian();
    const double kappa = this->Oscillation.kappa();
    return std::sqrt(parallelSum(this->C.size(), this->Operator.threads(),
      [&](std::int64_t begin, std::int64_t end)
      {
        double sum = 0;
        for (std::int64_t i = begin; i < end; ++i)
        {
          const double g = this->W[i] * this->WeightSums(0, i) + kappa * laplacian[i];
          sum += g * g;
        }
        return sum;
      }));
  }

  /// E + lambda R
  double energy() const { return this->RowEnergy + this->Oscillation.energy(); }

  double stepSize() const { return this->Mu; }
  double smallestWeightStep() const { return this->SmallestTau; }
  Vector& weights() { return this->W; }

  /// Leaves the sums for the step of the coefficients with the new weights.
  void stepWeights()
  {
    double tau = this->Tau;
    for (int halvings = 0; halvings <= MostHalvings; ++halvings, tau /= 2)
    {
      if (this->tryWeights(halvings < MostHalvings ? tau : 0))
      {
        break;
      }
    }
    std::swap(this->W, this->NewW);
  }

  /// Returns whether the energy that the step descends did not grow.
  bool stepCoefficients()
  {
    this->chooseStepSize();
    const double before = this->RowEnergy + this->Oscillation.descendedEnergy();
    if (this->Oscillation.isActive())
    {
      this->Vectors.add(
        -this->Mu * this->Oscillation.kappa(), this->Oscillation.laplacian(), this->C);
    }
    this->Operator.touched().forEach(this->Operator.threads(),
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          this->C[i] += this->Mu * (this->W[i] * this->CoefficientSums(0, i));
          this->Pairs(0, i) = this->W[i] * this->C[i];
        }
      });
    this->evaluate();
    return !energyRose(before, this->RowEnergy + this->Oscillation.descendedEnergy(),
      this->WeightSum + this->Oscillation.sumOfWeights(), this->C);
  }

private:
  void chooseStepSize()
  {
    const double largest = this->Operator.touched().reduce(
      this->Operator.threads(), 0.0,
      [&](std::int64_t begin, std::int64_t end, double& partial)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          partial = std::max(partial, this->Pairs(1, i) * this->CoefficientSums(1, i));
        }
      },
      [](double a, double b) { return std::max(a, b); });
    this->Mu = this->Oscillation.chooseStepSize(largest, this->Options.StepSize);
  }

  void evaluate()
  {
    this->RowEnergy = this->Operator.weightSums(this->Pairs, this->WeightSums);
    this->Oscillation.update(this->C);
  }

  /// Takes the step tau from W to NewW. Returns whether no denominator becomes 0 and E does not
  /// grow; then the sums, the pairs and the energy are those of the new weights.
  bool tryWeights(double tau)
  {
    const double smallest = this->Operator.touched().reduce(
      this->Operator.threads(), Infinity,
      [&](std::int64_t begin, std::int64_t end, double& partial)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          const double gradient =
            2 * (this->C[i] * this->WeightSums(0, i) - this->WeightSums(1, i));
          const double w = tau > 0 ? std::max(this->W[i] - tau * gradient, 0.0) : this->W[i];
          this->NewW[i] = w;
          this->Pairs(0, i) = w * this->C[i];
          this->Pairs(1, i) = w;
          partial = std::min(partial, w);
        }
      },
      [](double a, double b) { return std::min(a, b); });
    if (tau > 0 && smallest < SmallestDenominator &&
      !hasPositiveDenominators(this->Operator.lattice(), this->NewW))
    {
      return false;
    }
    const double energy = this->Operator.coefficientSums(this->Pairs, this->CoefficientSums);
    if (tau > 0 && energyRose(this->RowEnergy, energy, this->WeightSum, this->C, RoundingOfEnergy))
    {
      return false;
    }
    this->RowEnergy = energy;
    this->SmallestTau = std::min(this->SmallestTau, tau);
    return true;
  }

  const RationalOperator<Dim> Operator;
  const SolverOptions& Options;
  const double Tau;
  Vector& C;
  const ChunkedVectors Vectors;
  OscillationTerm<Dim> Oscillation;
  const double WeightSum;
  double RowEnergy = 0, Mu = 0, SmallestTau = Infinity;
  Vector W, NewW;
  CoefficientPairs Pairs;           // w_i c_i and w_i
  CoefficientPairs CoefficientSums; // RationalOperator::coefficientSums
  CoefficientPairs WeightSums;      // RationalOperator::weightSums
};
}

template <int Dim>
bool hasPositiveDenominators(const Lattice<Dim>& lattice, const Vector& weights)
{
  constexpr std::array<double, 3> basis = { 1. / 6, 4. / 6, 1. / 6 };
  constexpr int count = Dim == 2 ? 9 : 27;
  Index<Dim> knots, at;
  std::int64_t total = 1;
  for (int a = 0; a < Dim; ++a)
  {
    knots[a] = lattice.cells(a) + 1;
    total *= knots[a];
  }
  for (std::int64_t k = 0; k < total; ++k)
  {
    for (std::int64_t a = 0, rest = k; a < Dim; rest /= knots[a], ++a)
    {
      at[static_cast<std::size_t>(a)] = rest % knots[static_cast<std::size_t>(a)];
    }
    const std::int64_t first = lattice.coefficientIndex(at);
    double denominator = 0;
    for (int i = 0; i < count; ++i)
    {
      std::int64_t index = first, stride = 1;
      double product = 1;
      for (int a = 0, rest = i; a < Dim; ++a, rest /= 3)
      {
        index += rest % 3 * stride;
        stride *= lattice.Size[a];
        product *= basis[static_cast<std::size_t>(rest % 3)];
      }
      denominator += product * weights[index];
    }
    if (!(denominator >= SmallestDenominator))
    {
      return false;
    }
  }
  return true;
}

template <int Dim>
RationalResult solveRational(const ConstraintRows<Dim>& rows, const SolverOptions& options,
  const RationalOptions& rationalOptions, int threads, Vector& coefficients,
  const ProgressCallback& progress)
{
  RationalResult result;
  IterationControl control(options, progress, result.Solver);
  RationalIteration<Dim> iteration(rows, options, rationalOptions, threads, coefficients);
  double before = Infinity;
  bool descends = true;
  while (
    descends && control.proceed(iteration.gradientNorm(), std::abs(before - iteration.energy())))
  {
    before = iteration.energy();
    iteration.stepWeights();
    descends = iteration.stepCoefficients();
  }
  if (!descends)
  {
    control.record(iteration.gradientNorm());
    result.Solver.Status = SolverStatus::Diverged;
  }
  result.Solver.StepSize = iteration.stepSize();
  result.Solver.Energy = iteration.energy();
  result.WeightStepSize = result.Solver.NumberOfIterations > 0 ? iteration.smallestWeightStep() : 0;
  result.Weights = std::move(iteration.weights());
  return result;
}

template bool hasPositiveDenominators<2>(const Lattice<2>&, const Vector&);
template bool hasPositiveDenominators<3>(const Lattice<3>&, const Vector&);
template RationalResult solveRational<2>(const ConstraintRows<2>&, const SolverOptions&,
  const RationalOptions&, int, Vector&, const ProgressCallback&);
template RationalResult solveRational<3>(const ConstraintRows<3>&, const SolverOptions&,
  const RationalOptions&, int, Vector&, const ProgressCallback&);
}
