// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAFitSolution.h"

#include "Core/Parallel.h"
#include "IPIAFaultyInput.h"
#include "IPIAText.h"
#include "vtkIPIAImplicitFitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ipia
{
namespace
{
/// Distance of the automatic offset rows, in knot spacings.
constexpr double OffsetInSpacings = 1.5;
/// Iterations of the classic method that fit well without following the noise; conjugate gradients
/// converge much faster.
constexpr int AutomaticProgressiveIterations = 100, AutomaticConjugateIterations = 15;

template <int Dim>
Points<Dim> toLocal(const Placement<Dim>& place, const SpacePoints& positions)
{
  Points<Dim> local(Dim, static_cast<Eigen::Index>(positions.size()));
  parallelChunks(local.cols(), resolveThreads(0),
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t k = begin; k < end; ++k)
      {
        local.col(k) = place.toLocal(positions[static_cast<std::size_t>(k)].data());
      }
    });
  return local;
}

Vector toVector(const std::vector<double>& values)
{
  return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// The given distance for all points, or the automatic one, drawn in where other points are near.
Vector offsetDistances(const PointCloud& cloud, double given, double automatic, double side)
{
  return given > 0 ? Vector::Constant(static_cast<Eigen::Index>(cloud.Positions.size()), given)
                   : toVector(cloud.offsetDistances(automatic, side));
}

/// What the user can do about an iteration that diverged.
std::string whyDiverged(const SolverResult& solved, const FitParameters& parameters)
{
  const std::string rose =
    text(": the energy rose in iteration ", solved.NumberOfIterations, ". Reduce ");
  const bool printed = parameters.OscillationWeight > 0 &&
    parameters.OscillationStep == vtkIPIAImplicitFitter::AsPrinted;
  if (parameters.StepSize > 0)
  {
    return text("The iteration diverges with StepSize ", solved.StepSize, rose,
      "StepSize, or leave it 0 for 2 / max_i sum_k w_k B_i(x_k)",
      printed ? ", or set OscillationStep to Energy." : ".");
  }
  if (!printed)
  {
    return text("The iteration diverges", rose,
      "the row weights or values of extra rows, which are too large for double precision.");
  }
  return text("The iteration diverges with OscillationWeight ", parameters.OscillationWeight,
    " and OscillationStep AsPrinted", rose, "OscillationWeight, or set OscillationStep to Energy.");
}

StoppingRule stoppingRule(const FitParameters& parameters)
{
  return parameters.StoppingRule == vtkIPIAImplicitFitter::EnergyChange
    ? StoppingRule::EnergyChange
    : StoppingRule::RelativeResidual;
}

template <int Dim>
Points<Dim> normalsOf(const FitProblem& problem, const Placement<Dim>& place)
{
  const auto& normals = problem.Cloud.Normals;
  Points<Dim> local(Dim, static_cast<Eigen::Index>(normals.size()));
  parallelChunks(local.cols(), resolveThreads(0),
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t k = begin; k < end; ++k)
      {
        local.col(k) = place.toLocalVector(normals[static_cast<std::size_t>(k)].data());
      }
    });
  return local;
}

/// Offset rows as the parameters ask for them.
struct OffsetRows
{
  Vector OutwardDistance, InwardDistance; ///< empty: none
  double OutwardValue = 0, InwardValue = 0;
};

OffsetRows offsetRowsOf(
  const FitProblem& problem, const FitParameters& parameters, double automaticDistance)
{
  const PointCloud& cloud = problem.Cloud;
  OffsetRows rows;
  if (parameters.NormalConstraint == vtkIPIAImplicitFitter::Gradient)
  {
    return rows;
  }
  rows.OutwardDistance = offsetDistances(cloud, parameters.OffsetDistance, automaticDistance, 1);
  rows.OutwardValue = parameters.OffsetValue;
  if (parameters.NormalConstraint == vtkIPIAImplicitFitter::TwoSidedOffset)
  {
    const double inward = parameters.InwardOffsetDistance > 0 ? parameters.InwardOffsetDistance
                                                              : parameters.OffsetDistance;
    rows.InwardDistance = offsetDistances(cloud, inward, automaticDistance, -1);
    rows.InwardValue =
      parameters.InwardOffsetValue > 0 ? parameters.InwardOffsetValue : parameters.OffsetValue;
  }
  return rows;
}

template <int Dim>
void solveClassic(const Lattice<Dim>& lattice, const FitProblem& problem,
  const FitParameters& parameters, const OffsetRows& offsets, const ProgressCallback& progress,
  FitSolution<Dim>& solution)
{
  FitInput<Dim> input;
  input.Positions = toLocal(solution.Place, problem.Cloud.Positions);
  input.Normals = normalsOf(problem, solution.Place);
  input.Weights = toVector(problem.Cloud.Weights);
  input.ExtraPositions = toLocal(solution.Place, problem.Cloud.ExtraPositions);
  input.ExtraValues = toVector(problem.Cloud.ExtraValues);
  input.OutwardDistance = offsets.OutwardDistance;
  input.OutwardValue = offsets.OutwardValue;
  input.InwardDistance = offsets.InwardDistance;
  input.InwardValue = offsets.InwardValue;

  FitOptions options;
  const bool conjugate = parameters.Solver == vtkIPIAImplicitFitter::ConjugateGradient;
  options.Solver.Type =
    conjugate ? SolverType::ConjugateGradient : SolverType::ProgressiveIteration;
  options.Solver.MaximumNumberOfIterations = parameters.MaximumNumberOfIterations > 0
    ? parameters.MaximumNumberOfIterations
    : conjugate ? AutomaticConjugateIterations
                : AutomaticProgressiveIterations;
  options.Solver.Tolerance = parameters.Tolerance;
  options.Solver.Rule = stoppingRule(parameters);
  options.Solver.StepSize = parameters.StepSize;
  options.Type = parameters.isRational() ? Basis::UniformRational : Basis::BSpline;
  options.Rational.WeightStepSize = parameters.WeightStepSize;
  options.Solver.Oscillation.Weight = parameters.OscillationWeight;
  options.Solver.Oscillation.Step = parameters.OscillationStep == vtkIPIAImplicitFitter::AsPrinted
    ? OscillationStep::AsPrinted
    : OscillationStep::Energy;
  options.FarField.Magnitude =
    parameters.OffsetValue > 0 ? parameters.OffsetValue : solution.OffsetDistance;

  FitResult<Dim> fitted = fitImplicit<Dim>(lattice, input, options, progress);
  const SolverResult& solved = fitted.Solver;
  solution.Aborted = solved.Status == SolverStatus::Aborted;
  if (solved.Status == SolverStatus::Diverged)
  {
    solution.Error = whyDiverged(solved, parameters);
  }
  const int mixed = fitted.Function.farField().NumberOfMixedRegions;
  if (mixed > 0)
  {
    solution.Warning = text(mixed,
      " region(s) without data border on both sides of the surface, which is open there or has "
      "wide "
      "holes; f takes the sign of the larger share of the border.");
  }
  solution.Function = std::make_shared<const ImplicitSpline<Dim>>(std::move(fitted.Function));
  solution.Support = std::move(fitted.Support);
  solution.Solver = std::move(fitted.Solver);
  solution.AverageError = fitted.AverageError;
  solution.MaximumError = fitted.MaximumError;
  solution.Oscillation = fitted.Oscillation;
  solution.WeightStepSize = fitted.WeightStepSize;
  solution.NumberOfCoefficientsSolved = lattice.numberOfCoefficients();
}

/// Points and gradient rows, or offset rows in their place as extra rows.
template <int Dim>
HermiteInput<Dim> hermiteInput(const Lattice<Dim>& lattice, const FitProblem& problem,
  const OffsetRows& offsets, const Placement<Dim>& place)
{
  const PointCloud& cloud = problem.Cloud;
  HermiteInput<Dim> rows;
  rows.Positions = toLocal(place, cloud.Positions);
  rows.Normals = normalsOf(problem, place);
  rows.Weights = toVector(cloud.Weights);
  rows.LocalFairing = toVector(cloud.LocalFairing);
  const auto extra = static_cast<std::int64_t>(cloud.ExtraPositions.size());
  const std::int64_t most = offsets.OutwardDistance.size() + offsets.InwardDistance.size() + extra;
  rows.ExtraPositions.resize(Dim, most);
  rows.ExtraValues.resize(most);
  rows.ExtraWeights.resize(most);
  std::int64_t used = 0;
  const auto append = [&](const Point<Dim>& position, double value, double weight)
  {
    rows.ExtraPositions.col(used) = position;
    rows.ExtraValues[used] = value;
    rows.ExtraWeights[used++] = weight;
  };
  const auto appendOffsets = [&](const Vector& distance, double value, double side)
  {
    for (std::int64_t k = 0; k < distance.size(); ++k)
    {
      const Point<Dim> position = rows.Positions.col(k) + side * distance[k] * rows.Normals.col(k);
      if (distance[k] > 0 && lattice.contains(position))
      {
        append(position, side * (value > 0 ? value : distance[k]),
          rows.Weights.size() ? rows.Weights[k] : 1.0);
      }
    }
  };
  appendOffsets(offsets.OutwardDistance, offsets.OutwardValue, 1);
  appendOffsets(offsets.InwardDistance, offsets.InwardValue, -1);
  for (std::size_t k = 0; k < cloud.ExtraPositions.size(); ++k)
  {
    append(place.toLocal(cloud.ExtraPositions[k].data()), cloud.ExtraValues[k], 1);
  }
  if (offsets.OutwardDistance.size() > 0)
  {
    rows.Normals.setZero();
  }
  rows.ExtraPositions.conservativeResize(Dim, used);
  rows.ExtraValues.conservativeResize(used);
  rows.ExtraWeights.conservativeResize(used);

  // Only ratios of weights count. A power of two brings the largest near 1, as the hierarchy
  // computes in single precision.
  const double largest = std::max(rows.Weights.size() ? rows.Weights.maxCoeff() : 1.0,
    used > 0 ? rows.ExtraWeights.maxCoeff() : 0.0);
  if (rows.Weights.size() && largest > 0)
  {
    const int exponent = std::ilogb(largest);
    const auto scaled = [exponent](double w) { return std::ldexp(w, -exponent); };
    rows.Weights = rows.Weights.unaryExpr(scaled).eval();
    rows.ExtraWeights = rows.ExtraWeights.unaryExpr(scaled).eval();
  }
  return rows;
}

template <int Dim>
void solveHierarchical(const Lattice<Dim>& lattice, const FitProblem& problem,
  const FitParameters& parameters, const OffsetRows& offsets, const ProgressCallback& progress,
  IncrementalFit<Dim>* incremental, FitSolution<Dim>& solution)
{
  HierarchicalOptions options;
  options.NumberOfLevels = parameters.NumberOfLevels;
  if (parameters.MaximumNumberOfIterations > 0)
  {
    options.FinestIterations = parameters.MaximumNumberOfIterations;
    options.FinestTolerance = parameters.Tolerance;
  }
  else if (parameters.Tolerance > 0)
  {
    options.FinestTolerance = parameters.Tolerance;
  }
  options.Rule = stoppingRule(parameters);
  options.DataSpacing = problem.DataSpacing;
  if (parameters.FairingWeight >= 0)
  {
    const bool membrane = parameters.FairingOrder == 1;
    options.BandMembrane = membrane ? parameters.FairingWeight : 0;
    options.BandThinPlate = membrane ? 0 : parameters.FairingWeight;
    options.SmoothingLength = 0;
  }
  HermiteInput<Dim> rows = hermiteInput(lattice, problem, offsets, solution.Place);
  const HierarchicalResult<Dim> fitted = incremental
    ? incremental->fit(lattice, std::move(rows), options, progress)
    : fitHierarchical(lattice, std::move(rows), options, progress);
  solution.Aborted = fitted.Aborted;
  if (fitted.Aborted)
  {
    return;
  }
  solution.Bricks = fitted.Function;
  solution.NumberOfLevels = static_cast<int>(fitted.Reports.size());
  solution.Noise = fitted.Noise;
  solution.SmoothingLength = fitted.SmoothingLength;
  solution.FlippedNormals = fitted.Faults.shareOfFlippedNormals();
  solution.ShareOfOutliers = fitted.Faults.shareOfOutliers();
  solution.Outliers = fitted.Outliers;
  solution.NumberOfPointsAdded = fitted.NumberOfPointsAdded;
  solution.NumberOfCoefficientsSolved = fitted.numberOfCoefficientsSolved();
  const LevelReport& finest = fitted.Reports.back();
  solution.Solver.NumberOfIterations = finest.NumberOfIterations;
  solution.Solver.Energy = finest.Energy;
  solution.Solver.ResidualHistory = finest.ResidualHistory;
  solution.AverageError = finest.AverageError;
  solution.MaximumError = finest.MaximumError;
  if (problem.staysInBricks(parameters))
  {
    return;
  }
  solution.Function =
    std::make_shared<const ImplicitSpline<Dim>>(lattice, solution.Bricks->coefficients());
  if (parameters.GenerateSupport)
  {
    const auto others = withoutPoints(problem.Cloud, fitted.Outliers);
    const PointCloud& cloud = others ? *others : problem.Cloud;
    solution.Support =
      scaledSupport(lattice, toLocal(solution.Place, cloud.Positions), options.Threads);
  }
}

/// Number of offset rows in the domain; the others are left out.
template <int Dim>
std::int64_t offsetRowsInside(
  const Lattice<Dim>& lattice, const FitProblem& problem, const OffsetRows& offsets)
{
  const auto place = placementOf<Dim>(problem);
  const Points<Dim> positions = toLocal(place, problem.Cloud.Positions);
  const Points<Dim> normals = normalsOf(problem, place);
  std::int64_t count = 0;
  const auto add = [&](const Vector& distance, double side)
  {
    for (Eigen::Index k = 0; k < distance.size(); ++k)
    {
      count += distance[k] > 0 && !normals.col(k).isZero(0) &&
        lattice.contains(positions.col(k) + side * distance[k] * normals.col(k));
    }
  };
  add(offsets.OutwardDistance, 1);
  add(offsets.InwardDistance, -1);
  return count;
}
}

template <int Dim>
Placement<Dim> placementOf(const FitProblem& problem)
{
  auto place = Placement<Dim>::withFlatAxis(problem.FlatAxis);
  place.Turn = problem.Frame;
  std::copy_n(problem.Origin, 3, place.Origin.begin());
  return place;
}

template <int Dim>
Lattice<Dim> latticeOf(const FitProblem& problem, const Placement<Dim>& place)
{
  Lattice<Dim> lattice;
  for (int a = 0; a < Dim; ++a)
  {
    const auto i = static_cast<std::size_t>(a);
    lattice.Size[i] = problem.GridSize[place.Axis[i]];
    lattice.Spacing[a] = problem.Spacing[place.Axis[i]];
  }
  return lattice;
}

template <int Dim>
FitSolution<Dim> solve(const FitProblem& problem, const FitParameters& parameters,
  const ProgressCallback& progress, IncrementalFit<Dim>* incremental)
{
  FitSolution<Dim> solution;
  solution.Place = placementOf<Dim>(problem);
  const Lattice<Dim> lattice = latticeOf(problem, solution.Place);
  const double automatic = OffsetInSpacings * lattice.Spacing.maxCoeff();
  if (parameters.NormalConstraint != vtkIPIAImplicitFitter::Gradient)
  {
    solution.OffsetDistance = parameters.OffsetDistance > 0 ? parameters.OffsetDistance : automatic;
  }
  const OffsetRows offsets = offsetRowsOf(problem, parameters, automatic);
  // With extra rows the offsets may be left out on purpose.
  if (parameters.NormalConstraint != vtkIPIAImplicitFitter::Gradient &&
    problem.Cloud.ExtraPositions.empty() && offsetRowsInside(lattice, problem, offsets) == 0)
  {
    solution.Error = text("No offset row lies in the domain: their distance from the points is ",
      solution.OffsetDistance, ". Reduce OffsetDistance, or enlarge ModelBounds or Padding.");
    return solution;
  }
  if (parameters.isClassic())
  {
    solveClassic(lattice, problem, parameters, offsets, progress, solution);
  }
  else
  {
    solveHierarchical(lattice, problem, parameters, offsets, progress, incremental, solution);
  }
  if (solution.isValid())
  {
    const std::string faults = faultyInputWarning(
      problem, *solution.placed(), solution.ShareOfOutliers, solution.FlippedNormals);
    solution.Warning += text(solution.Warning.empty() || faults.empty() ? "" : " ", faults);
  }
  // Arrays of float hold f, whose far field is as large as an offset.
  const double largest = std::max({ solution.Solver.Energy, solution.MaximumError,
    solution.OffsetDistance, parameters.OffsetValue });
  if (solution.isValid() && !(largest <= std::numeric_limits<float>::max()))
  {
    solution.Error =
      text("f would reach beyond the range of numbers (energy ", solution.Solver.Energy,
        ", offset ", std::max(solution.OffsetDistance, parameters.OffsetValue),
        "): a parameter, weight or extra row is too large. Reduce it.");
  }
  return solution;
}

template Placement<2> placementOf<2>(const FitProblem&);
template Lattice<2> latticeOf<2>(const FitProblem&, const Placement<2>&);
template Placement<3> placementOf<3>(const FitProblem&);
template Lattice<3> latticeOf<3>(const FitProblem&, const Placement<3>&);
template FitSolution<2> solve<2>(
  const FitProblem&, const FitParameters&, const ProgressCallback&, IncrementalFit<2>*);
template FitSolution<3> solve<3>(
  const FitProblem&, const FitParameters&, const ProgressCallback&, IncrementalFit<3>*);
}
