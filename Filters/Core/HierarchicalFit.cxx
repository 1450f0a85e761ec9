// SPDX-License-Identifier: BSD-3-Clause
#include "HierarchicalFit.h"

#include "Parallel.h"

#include <deque>

namespace ipia
{
namespace
{
/// Occupied cells hold at least this many points where the data alone determine f.
constexpr double PointsPerDeterminedCell = 3;
/// Data are noisy if on such a level the points miss the surface by more than this many knot
/// spacings, and the level before did not miss it by much more: detail that a coarse lattice cannot
/// follow falls by the power of its order from level to level, noise stays.
constexpr double NoiseGate = 0.05, NoiseFall = 0.5;
/// Slopes of f below this do not count as slopes when distances are estimated.
constexpr double LeastSlope = 0.2;
/// Cross-validation: every so many'th point is held out and levels up to so many cells are fitted,
/// in fewer iterations. It starts from this many point spacings and goes in factors of the square
/// root of two; the shortest length is taken that predicts within a percent of the best.
constexpr std::int64_t HeldOutPeriod = 8;
constexpr std::int64_t ValidationCells = 64;
constexpr int ValidationIterations = 8, MostValidations = 5;
constexpr double FirstSmoothing = 2.4, ValidationStep = 1.41421356, ValidationSlack = 1.01;
/// Squared errors of predicted normals are cut here, so that outliers do not decide.
constexpr double MostNormalError = 2;
/// Samples that f is evaluated at in one go: a bound on memory.
constexpr std::size_t SamplesAtATime = 1 << 20;

/// Calls action(sample, f, gradient) for the given samples, by a level that covers them.
template <int Dim, typename Action>
void forValues(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Samples<Dim>& samples, int threads, const Action& action)
{
  for (std::size_t begin = 0; begin < samples.size(); begin += SamplesAtATime)
  {
    const auto first = samples.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = samples.begin() +
      static_cast<std::ptrdiff_t>(std::min(begin + SamplesAtATime, samples.size()));
    const std::vector<float> values =
      evaluateLevel(level, bricks, Samples<Dim>(first, last), threads);
    for (auto s = first; s != last; ++s)
    {
      const float* v = &values[static_cast<std::size_t>(s - first) * (1 + Dim)];
      action(*s, static_cast<double>(v[0]),
        Point<Dim>(Eigen::Map<const Eigen::Matrix<float, Dim, 1>>(v + 1).template cast<double>()));
    }
  }
}

/// The root mean square distance of the points from the zero set.
template <int Dim>
double noiseOf(
  const Level<Dim>& level, const BrickLattice<Dim>& bricks, const Samples<Dim>& points, int threads)
{
  double sum = 0, count = 0;
  forValues(level, bricks, points, threads,
    [&](const Sample<Dim>& sample, double f, const Point<Dim>& gradient)
    {
      if (sample.HasNormal)
      {
        const double distance = f / std::max(gradient.norm(), LeastSlope);
        sum += distance * distance;
        ++count;
      }
    });
  return count > 0 ? std::sqrt(sum / count) : 0;
}

template <int Dim>
void reportErrors(
  const Level<Dim>& level, const BrickLattice<Dim>& bricks, int threads, LevelReport& report)
{
  double sum = 0, count = 0;
  forValues(level, bricks, level.points(), threads,
    [&](const Sample<Dim>& sample, double f, const Point<Dim>&)
    {
      if (!sample.IsExtra)
      {
        sum += f * f;
        ++count;
        report.MaximumError = std::max(report.MaximumError, std::abs(f));
      }
    });
  report.AverageError = count > 0 ? sum / count : 0;
}

/// The smoothing length that predicts the normals of held-out points best.
template <int Dim>
double validatedSmoothing(const std::vector<Level<Dim>>& levels,
  const std::vector<BrickLattice<Dim>>& bricks, const HierarchicalOptions& options, int threads)
{
  Samples<Dim> kept, heldOut;
  std::int64_t index = 0;
  for (const Sample<Dim>& sample : levels.back().Data)
  {
    (++index % HeldOutPeriod == 0 && sample.HasNormal ? heldOut : kept).push_back(sample);
  }
  std::size_t last = 0;
  while (last + 1 < levels.size() && longestAxis(levels[last + 1].Grid) <= ValidationCells)
  {
    ++last;
  }
  std::vector<Level<Dim>> training(levels.size());
  for (std::size_t l = levels.size(); l-- > 0;)
  {
    training[l] = { levels[l].Coarsening, levels[l].Grid, levels[l].Dense, {}, {} };
    training[l].Data = l + 1 == levels.size()
      ? std::move(kept)
      : coarserData(training[l + 1].Data, levels[l].Coarsening);
  }
  std::vector<BrickLattice<Dim>> scratch(
    bricks.begin(), bricks.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  HierarchicalOptions quick = options;
  quick.DenseIterations = std::min(options.DenseIterations, ValidationIterations);
  quick.BandIterations = std::min(options.BandIterations, ValidationIterations);
  const auto errorOf = [&](double length)
  {
    for (std::size_t l = 0; l <= last; ++l)
    {
      solveLevel(training, scratch, l, length, quick, threads);
    }
    double sum = 0;
    forValues(training[last], scratch[last], heldOut, threads,
      [&](const Sample<Dim>& sample, double, const Point<Dim>& gradient)
      { sum += std::min((gradient - sample.Normal).squaredNorm(), MostNormalError); });
    return std::sqrt(sum / static_cast<double>(heldOut.size()));
  };
  const double spacing = levels[last].Grid.Spacing.mean() *
    std::pow(static_cast<double>(levels.back().points().size()) / occupiedCells(levels[last]),
      -1. / (Dim - 1));
  double first = FirstSmoothing * spacing;
  std::deque<double> errors{ errorOf(first), errorOf(first * ValidationStep) };
  while (errors.size() < MostValidations)
  {
    const auto best = std::min_element(errors.begin(), errors.end());
    if (best == errors.begin())
    {
      first /= ValidationStep;
      errors.push_front(errorOf(first));
    }
    else if (best + 1 == errors.end())
    {
      errors.push_back(
        errorOf(first * std::pow(ValidationStep, static_cast<double>(errors.size()))));
    }
    else
    {
      break;
    }
  }
  const double enough = ValidationSlack * *std::min_element(errors.begin(), errors.end());
  for (const double error : errors)
  {
    if (error <= enough)
    {
      break;
    }
    first *= ValidationStep;
  }
  return first;
}
}

template <int Dim>
HierarchicalResult<Dim> fitHierarchical(const Lattice<Dim>& lattice, HermiteInput<Dim> input,
  const HierarchicalOptions& options, const ProgressCallback& progress)
{
  const int threads = resolveThreads(options.Threads);
  HierarchicalResult<Dim> result;
  Samples<Dim> samples = sortedSamples(lattice, input);
  input = {};
  const std::vector<Level<Dim>> levels = makeLevels(lattice, std::move(samples), options);
  std::vector<BrickLattice<Dim>> bricks = makeBricks(levels);

  const auto solveAndReport = [&](std::size_t l)
  {
    const auto share = [&](double ofLevel)
    {
      return !progress ||
        progress((static_cast<double>(l) + ofLevel) / static_cast<double>(levels.size()));
    };
    result.Reports.push_back(
      solveLevel(levels, bricks, l, result.SmoothingLength, options, threads, share));
    result.Aborted = result.Reports.back().Aborted;
    return !result.Aborted;
  };

  // The finest level that the points alone determine tells how noisy they are.
  std::size_t gate = levels.size(), next = 0;
  const auto n = static_cast<double>(levels.back().points().size());
  for (std::size_t l = 0; l < levels.size() && options.SmoothingLength < 0; ++l)
  {
    if (n >= PointsPerDeterminedCell * occupiedCells(levels[l]))
    {
      gate = l;
    }
  }
  result.SmoothingLength = std::max(options.SmoothingLength, 0.0);
  if (gate < levels.size())
  {
    double missBefore = 0;
    for (; next <= gate; ++next)
    {
      if (!solveAndReport(next))
      {
        return result;
      }
      if (next + 1 >= gate)
      {
        missBefore = result.Noise;
        result.Noise = noiseOf(levels[next], bricks[next], levels.back().points(), threads);
      }
    }
    if (result.Noise > NoiseGate * levels[gate].Grid.Spacing.mean() &&
      result.Noise > NoiseFall * missBefore)
    {
      result.SmoothingLength = validatedSmoothing(levels, bricks, options, threads);
    }
    if (result.SmoothingLength > 0)
    {
      // Start again, with smoothing on all levels.
      result.Reports.clear();
      next = 0;
    }
  }
  for (; next < levels.size(); ++next)
  {
    if (!solveAndReport(next))
    {
      return result;
    }
  }
  reportErrors(levels.back(), bricks.back(), threads, result.Reports.back());
  result.Function = std::make_shared<const BrickSpline<Dim>>(std::move(bricks));
  return result;
}

template HierarchicalResult<2> fitHierarchical<2>(
  const Lattice<2>&, HermiteInput<2>, const HierarchicalOptions&, const ProgressCallback&);
template HierarchicalResult<3> fitHierarchical<3>(
  const Lattice<3>&, HermiteInput<3>, const HierarchicalOptions&, const ProgressCallback&);
}
