// SPDX-License-Identifier: BSD-3-Clause
#include "ImplicitFit.h"

#include "CubicBasis.h"
#include "Parallel.h"

namespace ipia
{
namespace
{
template <int Dim>
ConstraintRows<Dim> makeRows(const Lattice<Dim>& lattice, const FitInput<Dim>& input, int barAxis)
{
  const std::int64_t n = input.Positions.cols();
  const std::int64_t most = n * (input.InwardDistance.size() ? 3 : 2) + input.ExtraPositions.cols();
  Points<Dim> positions(Dim, most);
  Vector targets(most), weights(most);
  std::int64_t used = 0;
  const auto append = [&](const Point<Dim>& position, double target, double weight)
  {
    positions.col(used) = position;
    targets[used] = target;
    weights[used] = weight;
    ++used;
  };
  const auto weightOf = [&](std::int64_t k)
  { return input.Weights.size() ? input.Weights[k] : 1.0; };
  const auto appendOffsets = [&](const Vector& distance, double value, double side)
  {
    for (std::int64_t k = 0; k < distance.size(); ++k)
    {
      const Point<Dim> position =
        input.Positions.col(k) + side * distance[k] * input.Normals.col(k);
      if (distance[k] > 0 && !input.Normals.col(k).isZero(0) && lattice.contains(position))
      {
        append(position, side * (value > 0 ? value : distance[k]), weightOf(k));
      }
    }
  };
  for (std::int64_t k = 0; k < n; ++k)
  {
    append(input.Positions.col(k), 0, weightOf(k));
  }
  appendOffsets(input.OutwardDistance, input.OutwardValue, 1);
  appendOffsets(input.InwardDistance, input.InwardValue, -1);
  for (std::int64_t k = 0; k < input.ExtraPositions.cols(); ++k)
  {
    append(input.ExtraPositions.col(k), input.ExtraValues[k], 1);
  }
  return ConstraintRows<Dim>(
    lattice, positions.leftCols(used), targets.head(used), weights.head(used), barAxis);
}

/// How far beside its point a normal tells the sign of f, in knot spacings.
constexpr double WitnessDistance = 0.5;

/// The positions, and those extra rows whose value has the given sign.
template <int Dim>
Points<Dim> withExtra(const FitInput<Dim>& input, Points<Dim> positions, int sign)
{
  for (std::int64_t k = 0; k < input.ExtraValues.size(); ++k)
  {
    if (input.ExtraValues[k] * sign > 0)
    {
      positions.conservativeResize(Dim, positions.cols() + 1);
      positions.col(positions.cols() - 1) = input.ExtraPositions.col(k);
    }
  }
  return positions;
}

/// The support that every knot cell with rows gives, however many they are: sum over these cells of
/// B_i at their centre. Where points lie thinly beside dense ones they count as data all the same.
template <int Dim>
Vector cellSupport(const ConstraintRows<Dim>& rows)
{
  const Lattice<Dim>& lattice = rows.lattice();
  const BasisValues basis = cubicBasis(0.5);
  Vector support = Vector::Zero(lattice.numberOfCoefficients());
  const std::int64_t occupied = rows.tileBegin(rows.numberOfTiles());
  for (std::int64_t c = 0; c < occupied; ++c)
  {
    for (int k = 0; k < (Dim == 2 ? 16 : 64); ++k)
    {
      std::int64_t index = rows.cells()[c].Coefficient, stride = 1;
      double product = 1;
      for (int a = 0, rest = k; a < Dim; ++a, rest /= Order)
      {
        index += rest % Order * stride;
        stride *= lattice.Size[a];
        product *= basis[static_cast<std::size_t>(rest % Order)];
      }
      support[index] += product;
    }
  }
  return support;
}

/// Scales support so that its median at the points is 1.
template <int Dim>
void scaleToMedian(
  const Lattice<Dim>& lattice, const Points<Dim>& dataPoints, int threads, Vector& support)
{
  const double typical = medianSupport(lattice, support, dataPoints, threads);
  if (typical > 0)
  {
    support /= typical;
  }
}

template <int Dim>
Vector valuesAt(const ImplicitSpline<Dim>& function, const Points<Dim>& positions, int threads)
{
  Vector values(positions.cols());
  parallelChunks(positions.cols(), resolveThreads(threads),
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t k = begin; k < end; ++k)
      {
        values[k] = function.value(positions.col(k));
      }
    });
  return values;
}
}

template <int Dim>
Vector scaledSupport(const Lattice<Dim>& lattice, const Points<Dim>& positions, int threads)
{
  const Vector none = Vector::Zero(positions.cols());
  const ConstraintRows<Dim> rows(lattice, positions, none, {});
  Vector support;
  CollocationOperator<Dim>(rows, threads).support(support);
  scaleToMedian(lattice, positions, resolveThreads(threads), support);
  return support;
}

template <int Dim>
FitResult<Dim> fitImplicit(const Lattice<Dim>& lattice, const FitInput<Dim>& input,
  const FitOptions& options, const ProgressCallback& progress)
{
  const bool isRational = options.Type == Basis::UniformRational;
  const ConstraintRows<Dim> rows = makeRows(lattice, input, isRational ? 1 : 0);
  const CollocationOperator<Dim> collocation(rows, options.Threads);

  Vector coefficients = Vector::Zero(lattice.numberOfCoefficients());
  RationalResult solution; // without weights where the basis has none
  if (isRational)
  {
    solution = solveRational(
      rows, options.Solver, options.Rational, options.Threads, coefficients, progress);
  }
  else
  {
    solution.Solver = solveLeastSquares(collocation, options.Solver, coefficients, progress);
  }
  const SolverResult& solved = solution.Solver;

  Vector support;
  collocation.support(support);
  scaleToMedian(lattice, input.Positions, resolveThreads(options.Threads), support);
  FarFieldOptions farOptions = options.FarField;
  farOptions.Threads = options.Threads;
  FarField far;
  if (farOptions.Threshold > 0 && solved.Status == SolverStatus::Done)
  {
    Vector occupancy = cellSupport(rows);
    scaleToMedian(lattice, input.Positions, resolveThreads(options.Threads), occupancy);
    const double probe = WitnessDistance * lattice.Spacing.maxCoeff();
    const Points<Dim> outside = withExtra<Dim>(input, input.Positions + probe * input.Normals, 1);
    const Points<Dim> inside = withExtra<Dim>(input, input.Positions - probe * input.Normals, -1);
    // It depends on signs alone, and a quotient has that of its numerator.
    const Vector numerator =
      solution.Weights.size() ? solution.Weights.cwiseProduct(coefficients).eval() : coefficients;
    far =
      computeFarField(lattice, occupancy, numerator, outside, inside, input.Positions, farOptions);
  }

  FitResult<Dim> result;
  result.Solver = solved;
  result.Support = std::move(support);
  result.WeightStepSize = solution.WeightStepSize;
  result.Function = solution.Weights.size()
    ? ImplicitSpline<Dim>(
        lattice, std::move(coefficients), std::move(solution.Weights), std::move(far))
    : ImplicitSpline<Dim>(lattice, std::move(coefficients), std::move(far));
  const Vector atPoints = valuesAt(result.Function, input.Positions, options.Threads);
  if (atPoints.size())
  {
    result.AverageError = atPoints.squaredNorm() / static_cast<double>(atPoints.size());
    result.MaximumError = atPoints.cwiseAbs().maxCoeff();
  }
  result.Oscillation = oscillation(lattice, result.Function.coefficients());
  return result;
}

template struct FitResult<2>;
template struct FitResult<3>;
template Vector scaledSupport<2>(const Lattice<2>&, const Points<2>&, int);
template Vector scaledSupport<3>(const Lattice<3>&, const Points<3>&, int);
template FitResult<2> fitImplicit<2>(
  const Lattice<2>&, const FitInput<2>&, const FitOptions&, const ProgressCallback&);
template FitResult<3> fitImplicit<3>(
  const Lattice<3>&, const FitInput<3>&, const FitOptions&, const ProgressCallback&);
}
