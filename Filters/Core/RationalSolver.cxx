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

/// hasPositiveDenominators() of the knots that the coefficients [begin, end) are centred at.
template <int Dim>
bool hasPositiveDenominators(
  const Lattice<Dim>& lattice, const Vector& weights, std::int64_t begin, std::int64_t end)
{
  constexpr std::array<double, 3> basis = { 1. / 6, 4. / 6, 1. / 6 };
  constexpr int count = Dim == 2 ? 9 : 27;
  constexpr double middle = Dim == 2 ? 16. / 36 : 64. / 216;
  std::array<std::int64_t, count> offsets{};
  std::array<double, count> products{};
  for (std::size_t i = 0; i < count; ++i)
  {
    std::int64_t stride = 1;
    products[i] = 1;
    for (std::size_t a = 0, rest = i; a < Dim; ++a, rest /= 3)
    {
      offsets[i] += (static_cast<std::int64_t>(rest % 3) - 1) * stride;
      products[i] *= basis[rest % 3];
      stride *= lattice.Size[a];
    }
  }
  for (std::int64_t k = begin; k < end; ++k)
  {
    // Where its own coefficient does, the others of a knot need not be looked at.
    if (weights[k] * middle >= SmallestDenominator)
    {
      continue;
    }
    bool isKnot = true;
    for (std::int64_t a = 0, rest = k; a < Dim; rest /= lattice.Size[a], ++a)
    {
      const std::int64_t at = rest % lattice.Size[a];
      isKnot = isKnot && at > 0 && at + 1 < lattice.Size[a];
    }
    double denominator = 0;
    for (std::size_t i = 0; isKnot && i < count; ++i)
    {
      denominator += products[i] * weights[k + offsets[i]];
    }
    if (isKnot && !(denominator >= SmallestDenominator))
    {
      return false;
    }
  }
  return true;
}

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
    this->LargestCoefficient = this->C.cwiseAbs().maxCoeff();
    this->CoefficientSums.setZero(2, this->C.size());
    this->WeightSums.setZero(2, this->C.size());
    this->Operator.coefficientSums(this->Pairs, this->CoefficientSums);
    this->chooseStepSize();
    this->evaluate();
  }

  /// ||D^T V r - kappa L c||
  double gradientNorm() const
  {
    if (!this->Oscillation.isActive())
    {
      return std::sqrt(this->Proposed.SquaredNorm);
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
    const double bound =
      energyBound(this->RowEnergy, this->WeightSum, this->LargestCoefficient, RoundingOfEnergy);
    double tau = this->Tau;
    int halvings = 0;
    while (!this->acceptWeights(tau, bound, halvings < this->Halvings))
    {
      ++halvings;
      tau = halvings < MostHalvings ? tau / 2 : 0;
      this->proposeWeights(tau);
    }
    this->Halvings = halvings;
    this->SmallestTau = std::min(this->SmallestTau, tau);
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
    this->LargestCoefficient = this->Operator.touched().reduce(
      this->Operator.threads(), 0.0,
      [&](std::int64_t begin, std::int64_t end, double& partial)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          this->C[i] += this->Mu * (this->W[i] * this->CoefficientSums(0, i));
          this->Pairs(0, i) = this->W[i] * this->C[i];
          this->WeightSums(0, i) = this->WeightSums(1, i) = 0;
          partial = std::max(partial, std::abs(this->C[i]));
        }
      },
      [](double a, double b) { return std::max(a, b); });
    this->evaluate();
    return !energyRose(before, this->RowEnergy + this->Oscillation.descendedEnergy(),
      this->WeightSum + this->Oscillation.sumOfWeights(), this->C);
  }

private:
  /// New weights of a step, and what is found on the way.
  struct Proposal
  {
    double SquaredNorm = 0; ///< ||D^T V r||^2, of the old weights
    double SmallestWeight = Infinity;
  };

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

  /// Of new coefficients, with the first step of the weights that will be tried.
  void evaluate()
  {
    this->RowEnergy = this->Operator.weightSums(this->Pairs, this->WeightSums);
    this->Oscillation.update(this->C);
    this->proposeWeights(this->Tau);
  }

  /// The step tau from W to NewW, with its pairs and room for its sums.
  void proposeWeights(double tau)
  {
    this->Proposed = this->Operator.touched().reduce(
      this->Operator.threads(), Proposal{},
      [&](std::int64_t begin, std::int64_t end, Proposal& partial)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          const double c = this->C[i], before = this->W[i], sum = this->WeightSums(0, i);
          const double gradient = 2 * (c * sum - this->WeightSums(1, i));
          const double w = tau > 0 ? std::max(before - tau * gradient, 0.0) : before;
          this->NewW[i] = w;
          this->Pairs(0, i) = w * c;
          this->Pairs(1, i) = w;
          this->CoefficientSums(0, i) = this->CoefficientSums(1, i) = 0;
          partial.SquaredNorm += (before * sum) * (before * sum);
          partial.SmallestWeight = std::min(partial.SmallestWeight, w);
        }
      },
      [](const Proposal& a, const Proposal& b)
      {
        return Proposal{ a.SquaredNorm + b.SquaredNorm,
          std::min(a.SmallestWeight, b.SmallestWeight) };
      });
  }

  /**
   * Returns whether with the proposed weights no denominator becomes 0 and E does not pass the
   * bound, which a step of 0 does not have; then sums and energy are those of the new weights.
   *
   * @param isDoubtful  finds the energy first, since the sums are probably of no use
   */
  bool acceptWeights(double tau, double bound, bool isDoubtful)
  {
    if (tau > 0 && this->Proposed.SmallestWeight < SmallestDenominator &&
      !this->hasPositiveDenominatorsOfNewWeights())
    {
      return false;
    }
    if (tau > 0 && isDoubtful && !(this->Operator.energy(this->Pairs, bound) <= bound))
    {
      return false;
    }
    const double energy = this->Operator.coefficientSums(
      this->Pairs, this->CoefficientSums, tau > 0 ? bound : Infinity);
    if (tau > 0 && !(energy <= bound))
    {
      return false;
    }
    this->RowEnergy = energy;
    return true;
  }

  bool hasPositiveDenominatorsOfNewWeights() const
  {
    return this->Operator.touched().reduce(
             this->Operator.threads(), 0,
             [&](std::int64_t begin, std::int64_t end, int& failures) {
               failures +=
                 hasPositiveDenominators(this->Operator.lattice(), this->NewW, begin, end) ? 0 : 1;
             },
             [](int a, int b) { return a + b; }) == 0;
  }

  RationalOperator<Dim> Operator;
  const SolverOptions& Options;
  const double Tau;
  Vector& C;
  const ChunkedVectors Vectors;
  OscillationTerm<Dim> Oscillation;
  const double WeightSum;
  double RowEnergy = 0, Mu = 0, SmallestTau = Infinity, LargestCoefficient = 0;
  int Halvings = 0; // of tau, in the last step
  Proposal Proposed;
  Vector W, NewW;
  CoefficientPairs Pairs;           // w_i c_i and w_i
  CoefficientPairs CoefficientSums; // RationalOperator::coefficientSums
  CoefficientPairs WeightSums;      // RationalOperator::weightSums
};
}

template <int Dim>
bool hasPositiveDenominators(const Lattice<Dim>& lattice, const Vector& weights)
{
  return hasPositiveDenominators(lattice, weights, 0, lattice.numberOfCoefficients());
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
