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

/// The number of levels, from the coarsest, up to the finest that the points alone determine.
template <int Dim>
std::size_t determinedLevels(const std::vector<Level<Dim>>& levels, int threads)
{
  const auto n = static_cast<double>(levels.back().points().size());
  std::size_t found = levels.size();
  while (found > 0 && n < PointsPerDeterminedCell * occupiedCells(levels[found - 1], threads))
  {
    --found;
  }
  return found;
}
}

template <int Dim>
Misses missesOf(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Samples<Dim>& points, int threads, std::vector<SampleCheck>* checks)
{
  if (checks)
  {
    checks->resize(points.size());
  }
  const double spacing = level.Grid.Spacing.mean();
  return sumOverValues<Misses>(level, bricks, points, threads,
    [&](const Sample<Dim>& sample, double f, const Point<Dim>& gradient)
    {
      Misses one;
      const double slope = gradient.norm();
      const double distance = f / std::max(slope, LeastSlope);
      if (sample.HasNormal)
      {
        one.Distances = distance * distance;
        one.Oriented = 1;
      }
      if (checks)
      {
        SampleCheck& check = (*checks)[static_cast<std::size_t>(&sample - points.data())];
        check.Distance = static_cast<float>(distance / spacing);
        check.Agreement = sample.HasNormal && slope > 0
          ? static_cast<float>(gradient.dot(sample.Normal) / slope)
          : 1.F;
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

template <int Dim>
Misses missesOf(const BrickSpline<Dim>& function, const Samples<Dim>& samples)
{
  Misses misses;
  for (const Sample<Dim>& sample : samples)
  {
    const double f = function.value(sample.Position.cwiseProduct(function.lattice().Spacing));
    misses.Values += f * f;
    misses.Largest = std::max(misses.Largest, std::abs(f));
  }
  misses.Points = static_cast<double>(samples.size());
  return misses;
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
  const HierarchicalOptions& options, const ProgressCallback& progress, FittedData<Dim>* fitted)
{
  const int threads = resolveThreads(options.Threads);
  HierarchicalResult<Dim> result;
  std::vector<Level<Dim>> levels;
  std::vector<BrickLattice<Dim>> bricks;
  std::size_t next = 0;
  const auto startWith = [&](Samples<Dim> samples)
  {
    levels = makeLevels(lattice, std::move(samples), options, threads);
    bricks = makeBricks(levels, threads);
    result.Reports.clear();
    result.DeterminedLevels = determinedLevels(levels, threads);
    next = 0;
  };
  const auto solveUpTo = [&](std::size_t end)
  {
    for (; next < end && !result.Aborted; ++next)
    {
      const auto share = [&](double ofLevel)
      {
        return !progress ||
          progress((static_cast<double>(next) + ofLevel) / static_cast<double>(levels.size()));
      };
      result.Reports.push_back(
        solveLevel(levels, bricks, next, result.SmoothingLength, options, threads, share));
      result.Aborted = result.Reports.back().Aborted;
    }
    return !result.Aborted;
  };

  result.SmoothingLength = std::max(options.SmoothingLength, 0.0);
  std::vector<std::int64_t> rows;
  Samples<Dim> samples = sortedSamples(lattice, input, threads, &rows);
  input = {};
  SampleJudge<Dim> judge(samples, std::move(rows));
  startWith(std::move(samples));

  // The finest level that the points alone determine tells how noisy they are, and which of them
  // contradict the others; without these the fit starts again.
  Misses misses;
  const auto correct = [&]
  {
    std::vector<SampleCheck> checks;
    const std::size_t last = result.DeterminedLevels - 1;
    misses = missesOf(levels[last], bricks[last], levels.back().points(), threads,
      judge.isDone() ? nullptr : &checks);
    return judge.correct(levels.back().points(), checks, threads);
  };
  while (result.DeterminedLevels > 0)
  {
    if (!solveUpTo(result.DeterminedLevels))
    {
      return result;
    }
    if (!correct())
    {
      break;
    }
    startWith(std::move(levels.back().points()));
  }
  result.Faults = judge.counts();
  result.Outliers = judge.outlierRows();

  if (result.DeterminedLevels > 0 && options.SmoothingLength < 0)
  {
    const std::size_t last = result.DeterminedLevels - 1;
    result.Noise = misses.noise();
    const auto before = [&]
    {
      return last > 0
        ? missesOf(levels[last - 1], bricks[last - 1], levels.back().points(), threads).noise()
        : 0;
    };
    if (isNoise(result.Noise, levels[last].Grid.Spacing.mean(), before))
    {
      result.SmoothingLength = validatedSmoothing(levels, bricks, options, threads);
      // Start again, with smoothing on all levels.
      result.Reports.clear();
      next = 0;
    }
  }
  if (next < levels.size())
  {
    if (!solveUpTo(levels.size()))
    {
      return result;
    }
    misses = missesOf(levels.back(), bricks.back(), levels.back().points(), threads);
  }
  result.Function = std::make_shared<const BrickSpline<Dim>>(std::move(bricks));
  misses += missesOf(*result.Function, judge.outliers());
  result.reportErrors(misses);
  if (fitted)
  {
    *fitted = { std::move(levels), std::move(judge.outliers()) };
  }
  return result;
}

template Misses missesOf<2>(
  const Level<2>&, const BrickLattice<2>&, const Samples<2>&, int, std::vector<SampleCheck>*);
template Misses missesOf<2>(const BrickSpline<2>&, const Samples<2>&);
template HierarchicalResult<2> fitHierarchical<2>(const Lattice<2>&, HermiteInput<2>,
  const HierarchicalOptions&, const ProgressCallback&, FittedData<2>*);
template Misses missesOf<3>(
  const Level<3>&, const BrickLattice<3>&, const Samples<3>&, int, std::vector<SampleCheck>*);
template Misses missesOf<3>(const BrickSpline<3>&, const Samples<3>&);
template HierarchicalResult<3> fitHierarchical<3>(const Lattice<3>&, HermiteInput<3>,
  const HierarchicalOptions&, const ProgressCallback&, FittedData<3>*);
}
