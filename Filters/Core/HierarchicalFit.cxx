// SPDX-License-Identifier: BSD-3-Clause
#include "HierarchicalFit.h"

#include "Parallel.h"
#include "SampleChecks.h"

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
/// The fit starts again without faulty samples as long as there are some, but not more often.
constexpr int MostRepetitions = 4;
/// Turned normals show fewer others that are flipped, at most this share of those turned before:
/// where noise mixes the sides of thin parts it does not end.
constexpr double MostNewFlips = 0.3;
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

/// What a level says of the points.
struct Verdict
{
  double Noise = 0; ///< root mean square distance of the points from the zero set
  std::vector<SampleCheck> Checks;
};

template <int Dim>
Verdict verdictOf(
  const Level<Dim>& level, const BrickLattice<Dim>& bricks, const Samples<Dim>& points, int threads)
{
  Verdict verdict;
  verdict.Checks.reserve(points.size());
  const double spacing = level.Grid.Spacing.mean();
  double sum = 0, count = 0;
  forValues(level, bricks, points, threads,
    [&](const Sample<Dim>& sample, double f, const Point<Dim>& gradient)
    {
      const double slope = gradient.norm();
      const double distance = f / std::max(slope, LeastSlope);
      SampleCheck check;
      check.Distance = static_cast<float>(distance / spacing);
      if (sample.HasNormal)
      {
        sum += distance * distance;
        ++count;
        check.Agreement = slope > 0 ? static_cast<float>(gradient.dot(sample.Normal) / slope) : 1.F;
      }
      verdict.Checks.push_back(check);
    });
  verdict.Noise = count > 0 ? std::sqrt(sum / count) : 0;
  return verdict;
}

/// The finest level that the points alone determine, or their number if they are too sparse for
/// any.
template <int Dim>
std::size_t determinedLevel(const std::vector<Level<Dim>>& levels)
{
  std::size_t found = levels.size();
  const auto n = static_cast<double>(levels.back().points().size());
  for (std::size_t l = 0; l < levels.size(); ++l)
  {
    if (n >= PointsPerDeterminedCell * occupiedCells(levels[l]))
    {
      found = l;
    }
  }
  return found;
}

/// The points of a fit with what was found wrong with them.
template <int Dim>
struct JudgedPoints
{
  Samples<Dim> Good;
  std::vector<char> Turned; ///< for each of Good, whether its normal was; empty: none
  Samples<Dim> Outliers;    ///< left out
  double Oriented = 0;      ///< number of points with normals at first
  double Flipped = 0;       ///< of them with the wrong sign
};

/// Takes outliers out, and turns the normals that are flipped: with the others right, those that
/// were turned by mistake are turned back in the next round.
template <int Dim>
void correct(const SampleFaults& faults, JudgedPoints<Dim>& points)
{
  points.Turned.resize(points.Good.size(), 0);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points.Good.size(); ++k)
  {
    Sample<Dim> sample = points.Good[k];
    char turned = points.Turned[k];
    if (faults.Faults[k] == SampleFault::Outlier)
    {
      points.Oriented -= sample.HasNormal;
      points.Flipped -= turned;
      points.Outliers.push_back(sample);
      continue;
    }
    if (faults.Faults[k] == SampleFault::Flipped)
    {
      turned = turned == 0;
      points.Flipped += turned ? 1 : -1;
      sample.Normal = -sample.Normal;
    }
    points.Turned[kept] = turned;
    points.Good[kept++] = sample;
  }
  points.Good.resize(kept);
  points.Turned.resize(kept);
}

/// Turns the normals back.
template <int Dim>
void turnBack(JudgedPoints<Dim>& points)
{
  for (std::size_t k = 0; k < points.Good.size(); ++k)
  {
    if (points.Turned[k] != 0)
    {
      points.Good[k].Normal = -points.Good[k].Normal;
    }
  }
  points.Turned.assign(points.Good.size(), 0);
  points.Flipped = 0;
}

/// Takes the normals out that were turned.
template <int Dim>
void leaveOutTurned(JudgedPoints<Dim>& points)
{
  for (std::size_t k = 0; k < points.Good.size(); ++k)
  {
    if (points.Turned[k] != 0)
    {
      points.Good[k].Normal.setZero();
      points.Good[k].HasNormal = false;
    }
  }
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

/// Adds samples that were left out to the errors of others.
template <int Dim>
void addErrors(
  const BrickSpline<Dim>& function, const Samples<Dim>& samples, double others, LevelReport& report)
{
  double sum = report.AverageError * others;
  for (const Sample<Dim>& sample : samples)
  {
    const double f = function.value(sample.Position.cwiseProduct(function.lattice().Spacing));
    sum += f * f;
    report.MaximumError = std::max(report.MaximumError, std::abs(f));
  }
  report.AverageError = sum / (others + static_cast<double>(samples.size()));
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
  JudgedPoints<Dim> points;
  points.Good = sortedSamples(lattice, input, threads);
  input = {};
  for (const Sample<Dim>& sample : points.Good)
  {
    points.Oriented += sample.HasNormal;
  }

  std::vector<Level<Dim>> levels;
  std::vector<BrickLattice<Dim>> bricks;
  std::size_t next = 0;
  const auto start = [&]
  {
    levels = makeLevels(lattice, std::move(points.Good), options, threads);
    bricks = makeBricks(levels);
    result.Reports.clear();
    next = 0;
  };
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

  // The finest level that the points alone determine tells how noisy they are, and which of them
  // contradict the others; without these the fit starts again.
  result.SmoothingLength = std::max(options.SmoothingLength, 0.0);
  start();
  std::size_t gate = determinedLevel(levels);
  const auto takePointsBack = [&]
  {
    Level<Dim>& finest = levels.back();
    points.Good = std::move(finest.Unclustered.empty() ? finest.Data : finest.Unclustered);
  };
  EarlierFaults earlier;
  bool judged = false;
  double turned = 0; // in the round with most of them
  for (int round = 0; gate < levels.size(); ++round)
  {
    for (; next <= gate; ++next)
    {
      if (!solveAndReport(next))
      {
        return result;
      }
    }
    const Verdict verdict = verdictOf(levels[gate], bricks[gate], levels.back().points(), threads);
    result.Noise = verdict.Noise;
    if (judged)
    {
      break;
    }
    const SampleFaults faults =
      findFaults(levels.back().points(), verdict.Checks, earlier, threads);
    earlier.NoFlips =
      earlier.NoFlips || (earlier.Flipped && faults.Flipped > MostNewFlips * turned);
    earlier.Flipped = !earlier.NoFlips && (earlier.Flipped || faults.Flipped > 0);
    earlier.Outliers = earlier.Outliers || faults.Outliers > 0;
    turned = std::max(turned, faults.Flipped);
    judged = faults.Outliers + faults.Flipped == 0 || round >= MostRepetitions;
    if (judged && points.Flipped == 0)
    {
      break;
    }
    takePointsBack();
    if (judged)
    {
      leaveOutTurned(points);
    }
    else
    {
      correct(faults, points);
      if (earlier.NoFlips)
      {
        turnBack(points);
      }
    }
    start();
    gate = determinedLevel(levels);
  }
  result.FlippedNormals = points.Oriented > 0 ? points.Flipped / points.Oriented : 0;
  if (gate < levels.size() && options.SmoothingLength < 0)
  {
    if (result.Noise > NoiseGate * levels[gate].Grid.Spacing.mean())
    {
      const double before = gate > 0
        ? verdictOf(levels[gate - 1], bricks[gate - 1], levels.back().points(), threads).Noise
        : 0;
      if (result.Noise > NoiseFall * before)
      {
        result.SmoothingLength = validatedSmoothing(levels, bricks, options, threads);
      }
    }
    if (result.SmoothingLength > 0)
    {
      // Start again, with smoothing on all levels.
      result.Reports.clear();
      next = 0;
    }
  }
  else
  {
    result.Noise = 0;
  }
  for (; next < levels.size(); ++next)
  {
    if (!solveAndReport(next))
    {
      return result;
    }
  }
  LevelReport& finest = result.Reports.back();
  reportErrors(levels.back(), bricks.back(), threads, finest);
  result.Function = std::make_shared<const BrickSpline<Dim>>(std::move(bricks));
  if (!points.Outliers.empty())
  {
    const auto kept = static_cast<double>(levels.back().points().size()),
               left = static_cast<double>(points.Outliers.size());
    result.Outliers = left / (kept + left);
    addErrors(*result.Function, points.Outliers, kept, finest);
  }
  return result;
}

template HierarchicalResult<2> fitHierarchical<2>(
  const Lattice<2>&, HermiteInput<2>, const HierarchicalOptions&, const ProgressCallback&);
template HierarchicalResult<3> fitHierarchical<3>(
  const Lattice<3>&, HermiteInput<3>, const HierarchicalOptions&, const ProgressCallback&);
}
