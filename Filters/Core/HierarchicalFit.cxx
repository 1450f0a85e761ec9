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
/// Samples that f is evaluated at in one go: what is known of them stays in the cache.
constexpr std::int64_t SamplesAtATime = 2048;

/// Sum of term(sample, f, gradient) over sorted samples, by a level that covers them.
template <typename Sum, int Dim, typename Term>
Sum sumOverValues(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Samples<Dim>& samples, int threads, const Term& term)
{
  return parallelSum<Sum>(static_cast<std::int64_t>(samples.size()), threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      Sum sum{};
      BrickValues values;
      for (std::int64_t first = begin; first < end; first += SamplesAtATime)
      {
        const Sample<Dim>* const from = samples.data() + first;
        const Sample<Dim>* const to = samples.data() + std::min(first + SamplesAtATime, end);
        evaluateLevel(level, bricks, from, to, values);
        const float* v = values.data();
        for (const Sample<Dim>* s = from; s != to; ++s, v += 1 + Dim)
        {
          sum += term(*s, static_cast<double>(v[0]),
            Point<Dim>(
              Eigen::Map<const Eigen::Matrix<float, Dim, 1>>(v + 1).template cast<double>()));
        }
      }
      return sum;
    });
}

}

template <int Dim>
Misses missesOf(
  const Level<Dim>& level, const BrickLattice<Dim>& bricks, const Samples<Dim>& points, int threads)
{
  return sumOverValues<Misses>(level, bricks, points, threads,
    [](const Sample<Dim>& sample, double f, const Point<Dim>& gradient)
    {
      Misses one;
      if (sample.HasNormal)
      {
        const double distance = f / std::max(gradient.norm(), LeastSlope);
        one.Distances = distance * distance;
        one.Oriented = 1;
      }
      if (!sample.IsExtra)
      {
        one.Values = f * f;
        one.Points = 1;
        one.Largest = std::abs(f);
      }
      return one;
    });
}

bool isNoise(double noise, double spacing, const std::function<double()>& noiseBefore)
{
  return noise > NoiseGate * spacing && noise > NoiseFall * noiseBefore();
}

namespace
{
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
      : coarserData(training[l + 1].Data, levels[l].Coarsening, threads);
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
    const auto sum = sumOverValues<double>(training[last], scratch[last], heldOut, threads,
      [](const Sample<Dim>& sample, double, const Point<Dim>& gradient)
      { return std::min((gradient - sample.Normal).squaredNorm(), MostNormalError); });
    return std::sqrt(sum / static_cast<double>(heldOut.size()));
  };
  const double spacing = levels[last].Grid.Spacing.mean() *
    std::pow(
      static_cast<double>(levels.back().points().size()) / occupiedCells(levels[last], threads),
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
  const HierarchicalOptions& options, const ProgressCallback& progress,
  std::vector<Level<Dim>>* usedLevels)
{
  const int threads = resolveThreads(options.Threads);
  HierarchicalResult<Dim> result;
  Samples<Dim> samples = sortedSamples(lattice, input, threads);
  input = {};
  std::vector<Level<Dim>> levels = makeLevels(lattice, std::move(samples), options, threads);
  std::vector<BrickLattice<Dim>> bricks = makeBricks(levels, threads);

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
  const Samples<Dim>& points = levels.back().points();
  const auto n = static_cast<double>(points.size());
  std::size_t gate = options.SmoothingLength < 0 ? levels.size() : 0; // counted from 1, 0: none
  while (gate > 0 && n < PointsPerDeterminedCell * occupiedCells(levels[gate - 1], threads))
  {
    --gate;
  }
  result.DeterminedLevels = gate;
  std::size_t next = 0;
  Misses misses;
  result.SmoothingLength = std::max(options.SmoothingLength, 0.0);
  if (gate > 0)
  {
    for (; next < gate; ++next)
    {
      if (!solveAndReport(next))
      {
        return result;
      }
    }
    const std::size_t last = gate - 1;
    misses = missesOf(levels[last], bricks[last], points, threads);
    result.Noise = misses.noise();
    const auto before = [&] {
      return last > 0 ? missesOf(levels[last - 1], bricks[last - 1], points, threads).noise() : 0;
    };
    if (isNoise(result.Noise, levels[last].Grid.Spacing.mean(), before))
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
  if (next < levels.size())
  {
    for (; next < levels.size(); ++next)
    {
      if (!solveAndReport(next))
      {
        return result;
      }
    }
    misses = missesOf(levels.back(), bricks.back(), points, threads);
  }
  LevelReport& finest = result.Reports.back();
  finest.AverageError = misses.Points > 0 ? misses.Values / misses.Points : 0;
  finest.MaximumError = misses.Largest;
  result.Function = std::make_shared<const BrickSpline<Dim>>(std::move(bricks));
  if (usedLevels)
  {
    *usedLevels = std::move(levels);
  }
  return result;
}

template Misses missesOf<2>(const Level<2>&, const BrickLattice<2>&, const Samples<2>&, int);
template HierarchicalResult<2> fitHierarchical<2>(const Lattice<2>&, HermiteInput<2>,
  const HierarchicalOptions&, const ProgressCallback&, std::vector<Level<2>>*);
template Misses missesOf<3>(const Level<3>&, const BrickLattice<3>&, const Samples<3>&, int);
template HierarchicalResult<3> fitHierarchical<3>(const Lattice<3>&, HermiteInput<3>,
  const HierarchicalOptions&, const ProgressCallback&, std::vector<Level<3>>*);
}
