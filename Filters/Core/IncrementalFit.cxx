// SPDX-License-Identifier: BSD-3-Clause
#include "IncrementalFit.h"

#include "MortonOrder.h"
#include "Parallel.h"

#include <chrono>
#include <cmath>
#include <iterator>
#include <tuple>

namespace ipia
{
namespace
{
/// A smoothing length is found anew when there are so many times the points.
constexpr std::int64_t GrowthOfPoints = 2;
/// All is fitted again when the fairing of bands would be that of so many times the spacing.
constexpr double ChangeOfSpacing = 1.5;
/// BrickWidth as a power of two.
constexpr int BrickBits = 2;

/// Halvings of the finest sub-cells to those that a level sees clusters of.
template <int Dim>
int halvingsOf(const Level<Dim>& level)
{
  return level.Coarsening == 0 ? 0 : level.Coarsening + SubCellBits - ClusterBits;
}

template <typename Matrix>
bool beginsWith(const Matrix& all, const Matrix& first)
{
  return all.size() >= first.size() &&
    std::equal(first.data(), first.data() + first.size(), all.data());
}

/// Whether one of the two is without values where the other has some, or the values differ.
bool beginsWithOptional(const Vector& all, const Vector& first)
{
  return (all.size() == 0) == (first.size() == 0) && beginsWith(all, first);
}

template <typename Matrix>
bool isSame(const Matrix& a, const Matrix& b)
{
  return a.size() == b.size() && beginsWith(a, b);
}

bool isSameMethod(const HierarchicalOptions& a, const HierarchicalOptions& b)
{
  // By structured bindings, which do not compile if a member is forgotten.
  const auto valuesOf = [](const HierarchicalOptions& options)
  {
    const auto& [numberOfLevels, denseCells, denseGradient, bandGradient, finestGradient,
      denseMembrane, denseThinPlate, bandMembrane, bandThinPlate, dataSpacing, denseIterations,
      denseTolerance, bandIterations, finestIterations, bandTolerance, finestTolerance, rule,
      robustFactor, smoothingLength, threads] = options;
    static_cast<void>(dataSpacing); // stays that of the last fit
    static_cast<void>(threads);     // makes no difference
    return std::make_tuple(numberOfLevels, denseCells, denseGradient, bandGradient, finestGradient,
      denseMembrane, denseThinPlate, bandMembrane, bandThinPlate, denseIterations, denseTolerance,
      bandIterations, finestIterations, bandTolerance, finestTolerance, rule, robustFactor,
      smoothingLength);
  };
  return valuesOf(a) == valuesOf(b);
}

/// Whether an input begins with the points of another one and has its extra rows, bit for bit.
template <int Dim>
bool continues(const HermiteInput<Dim>& input, const HermiteInput<Dim>& last)
{
  const auto& [positions, normals, weights, fairing, extraPositions, extraValues, extraWeights] =
    input;
  return beginsWith(positions, last.Positions) && beginsWith(normals, last.Normals) &&
    beginsWithOptional(weights, last.Weights) && beginsWithOptional(fairing, last.LocalFairing) &&
    isSame(extraPositions, last.ExtraPositions) && isSame(extraValues, last.ExtraValues) &&
    isSame(extraWeights, last.ExtraWeights);
}

template <int Dim>
HermiteInput<Dim> withoutFirst(const HermiteInput<Dim>& input, Eigen::Index n)
{
  const Eigen::Index rest = input.Positions.cols() - n;
  HermiteInput<Dim> added;
  added.Positions = input.Positions.rightCols(rest);
  added.Normals = input.Normals.rightCols(rest);
  added.Weights = input.Weights.tail(std::min(rest, input.Weights.size()));
  added.LocalFairing = input.LocalFairing.tail(std::min(rest, input.LocalFairing.size()));
  return added;
}

/// Runs of clusters as one.
template <int Dim>
Samples<Dim> merged(std::vector<Samples<Dim>> runs, int halvings, int threads)
{
  Samples<Dim> all;
  for (Samples<Dim>& run : runs)
  {
    Samples<Dim> next;
    next.reserve(all.size() + run.size());
    std::merge(all.begin(), all.end(), run.begin(), run.end(), std::back_inserter(next),
      [](const Sample<Dim>& a, const Sample<Dim>& b) { return a.Key < b.Key; });
    all.swap(next);
  }
  return runs.size() > 1 ? cluster(all, halvings, threads) : all;
}

/// The level with the data whose rows have a part in the active coefficients of a zone.
template <int Dim>
Level<Dim> partOf(const Level<Dim>& level, const std::vector<Samples<Dim>>& runs,
  std::size_t numberOfRuns, const BrickLattice<Dim>& zone, int threads)
{
  // A brick is a run of keys.
  const int shift = Dim * (level.Coarsening + SubCellBits + BrickBits);
  std::vector<std::uint64_t> keys(static_cast<std::size_t>(zone.numberOfBricks()));
  for (std::size_t z = 0; z < keys.size(); ++z)
  {
    keys[z] = mortonKey<Dim>(zone.position(static_cast<std::int32_t>(z)));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Samples<Dim>> parts;
  for (std::size_t r = 0; r < numberOfRuns; ++r)
  {
    const Samples<Dim>& run = runs[r];
    parts.emplace_back();
    auto from = run.begin();
    for (const std::uint64_t key : keys)
    {
      const auto below = [shift](const Sample<Dim>& sample, std::uint64_t k)
      { return sample.Key >> shift < k; };
      from = std::lower_bound(from, run.end(), key, below);
      Index<Dim> last;
      last.fill(-1);
      bool touches = false;
      for (; from != run.end() && from->Key >> shift == key; ++from)
      {
        const Index<Dim> cell = level.cellOf(*from);
        if (cell != last)
        {
          touches = zone.countActive(cell) > 0;
          last = cell;
        }
        if (touches)
        {
          parts.back().push_back(*from);
        }
      }
    }
  }
  return { level.Coarsening, level.Grid, level.Dense,
    merged(std::move(parts), halvingsOf(level), threads), {} };
}

/// The samples that f, by the finest level, does not follow yet.
template <int Dim>
Samples<Dim> newsAmong(const Samples<Dim>& samples, const Level<Dim>& finest,
  const BrickLattice<Dim>& bricks, int threads)
{
  const auto n = static_cast<std::int64_t>(samples.size());
  std::vector<char> isNews(samples.size(), 1);
  const double most = IncrementalFit<Dim>::KnownInSpacings * finest.Grid.Spacing.mean();
  parallelChunks(n, threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      Samples<Dim> inBand;
      std::vector<std::int64_t> index;
      for (std::int64_t k = begin; k < end; ++k)
      {
        const Sample<Dim>& sample = samples[static_cast<std::size_t>(k)];
        if (bricks.countActive(finest.cellOf(sample)) == BrickSize<Dim>)
        {
          inBand.push_back(sample);
          index.push_back(k);
        }
      }
      BrickValues values;
      evaluateLevel(finest, bricks, inBand.data(), inBand.data() + inBand.size(), values);
      const float* v = values.data();
      for (std::size_t i = 0; i < inBand.size(); ++i, v += 1 + Dim)
      {
        const Sample<Dim>& sample = inBand[i];
        const Point<Dim> gradient =
          Eigen::Map<const Eigen::Matrix<float, Dim, 1>>(v + 1).template cast<double>();
        const double turn = sample.HasNormal ? (gradient - sample.Normal).norm() : 0.0;
        isNews[static_cast<std::size_t>(index[i])] =
          std::abs(static_cast<double>(v[0] - sample.Value)) > most ||
          turn > IncrementalFit<Dim>::KnownSlope;
      }
    });
  Samples<Dim> news;
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    if (isNews[k] != 0)
    {
      news.push_back(samples[k]);
    }
  }
  return news;
}

bool isActive(std::uint64_t mask, int k)
{
  return (mask >> k & 1) != 0;
}

/// Coefficients of the bricks that both lattices store; others stay.
template <int Dim>
void copyStored(
  const BrickLattice<Dim>& from, const BrickLattice<Dim>& to, BrickValues& values, int threads)
{
  parallelChunks(to.numberOfBricks(), threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t b = begin; b < end; ++b)
      {
        const std::int64_t id = from.brickAt(to.position(static_cast<std::int32_t>(b)));
        if (id != BrickLattice<Dim>::Absent)
        {
          std::copy_n(from.coefficients().begin() + id * BrickSize<Dim>, BrickSize<Dim>,
            values.begin() + b * BrickSize<Dim>);
        }
      }
    });
}

/// A level of an addition: its band with the values before and after it, and what is solved for.
template <int Dim>
class ChangingLevel
{
public:
  /// @param after  a band; its values do not count
  ChangingLevel(const Level<Dim>& grid, BrickLattice<Dim>& after, int threads)
    : Grid(grid)
    , After(after)
    , Zone(grid.Grid)
    , Threads(threads)
  {
  }

  BrickLattice<Dim>& zone() { return this->Zone; }
  const BrickValues& start() const { return this->Start; }

  /// Gives the band its values before, moved by the coarser level where they are solved for or
  /// inherited, and the zone the prediction of the coarser level.
  void begin(const BrickLattice<Dim>& old, const ChangingLevel* coarser, const Samples<Dim>& news)
  {
    // Other bricks have the values of the old ones.
    this->Touched = coarser ? this->After.readers(coarser->After, coarser->Touched)
                            : std::vector<char>(this->numberOfBricks(), 0);
    for (std::size_t b = 0; b < this->Touched.size(); ++b)
    {
      this->Touched[b] |=
        static_cast<char>(old.brickAt(this->After.position(static_cast<std::int32_t>(b))) ==
          BrickLattice<Dim>::Absent);
    }
    BrickValues& after = this->After.coefficients();
    copyStored(old, this->After, after, this->Threads);
    this->Before.resize(after.size());
    BrickValues move(after.size()); // by the coarser level, of touched bricks
    if (coarser)
    {
      this->After.refine(
        coarser->After, coarser->Before, this->Touched, this->Threads, this->Before);
      this->After.refine(
        coarser->After, coarser->After.coefficients(), this->Touched, this->Threads, after);
      this->forTouched([&](std::size_t i) { move[i] = after[i] - this->Before[i]; });
    }
    copyStored(old, this->After, this->Before, this->Threads);
    this->markZone(move, news);
    if (coarser)
    {
      this->Zone.refineFrom(coarser->After, this->Threads);
    }
    this->forTouched(
      [&](std::size_t i)
      {
        const auto b = static_cast<std::int32_t>(i / BrickSize<Dim>);
        const int k = static_cast<int>(i % BrickSize<Dim>);
        if (b < this->After.numberOfActiveBricks() && isActive(this->After.activeMask(b), k))
        {
          after[i] = this->Before[i] + (isActive(this->zoneMask(b), k) ? move[i] : 0.F);
        }
      });
    this->Start.resize(this->Zone.coefficients().size());
    copyStored(this->After, this->Zone, this->Start, this->Threads);
  }

  /// Takes over what was solved for.
  void end()
  {
    BrickValues& after = this->After.coefficients();
    const double least =
      this->Grid.Dense ? IncrementalFit<Dim>::KeptInSpacings * this->Grid.Grid.Spacing.mean() : 0.;
    for (std::int32_t z = 0; z < this->Zone.numberOfActiveBricks(); ++z)
    {
      const std::uint64_t mask = this->Zone.activeMask(z);
      const std::int32_t b = this->After.brickAt(this->Zone.position(z));
      const float* solved = this->Zone.coefficients().data() + std::int64_t{ z } * BrickSize<Dim>;
      this->Touched[static_cast<std::size_t>(b)] = 1;
      for (int k = 0; k < BrickSize<Dim>; ++k)
      {
        const std::size_t i = firstOf(b) + static_cast<std::size_t>(k);
        if (isActive(mask, k))
        {
          after[i] = std::abs(solved[k] - this->Before[i]) > least ? solved[k] : this->Before[i];
        }
      }
    }
    for (std::size_t b = 0; b < this->Touched.size(); ++b)
    {
      const auto first = static_cast<std::ptrdiff_t>(firstOf(static_cast<std::int32_t>(b)));
      this->Touched[b] = static_cast<char>(this->Touched[b] != 0 &&
        !std::equal(after.begin() + first, after.begin() + first + BrickSize<Dim>,
          this->Before.begin() + first));
    }
  }

private:
  static std::size_t firstOf(std::int32_t brick)
  {
    return static_cast<std::size_t>(brick) * BrickSize<Dim>;
  }

  std::size_t numberOfBricks() const
  {
    return static_cast<std::size_t>(this->After.numberOfBricks());
  }

  /// Calls action with the index of every coefficient of a touched brick.
  template <typename Action>
  void forTouched(const Action& action) const
  {
    parallelChunks(static_cast<std::int64_t>(this->Touched.size()), this->Threads,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t b = begin; b < end; ++b)
        {
          if (this->Touched[static_cast<std::size_t>(b)] != 0)
          {
            for (std::size_t k = 0; k < BrickSize<Dim>; ++k)
            {
              action(static_cast<std::size_t>(b) * BrickSize<Dim> + k);
            }
          }
        }
      });
  }

  void markZone(const BrickValues& move, const Samples<Dim>& news)
  {
    if (this->Grid.Dense)
    {
      this->Zone.activateAll();
      this->Zone.allocate(this->Threads);
      return;
    }
    Index<Dim> last;
    last.fill(-1);
    for (const Sample<Dim>& sample : news)
    {
      const Index<Dim> cell = this->Grid.cellOf(sample);
      if (cell != last)
      {
        this->Zone.activateAround(cell);
        last = cell;
      }
    }
    const double most = IncrementalFit<Dim>::MovedInSpacings * this->Grid.Grid.Spacing.mean();
    for (std::int32_t b = 0; b < this->After.numberOfActiveBricks(); ++b)
    {
      if (this->Touched[static_cast<std::size_t>(b)] == 0)
      {
        continue;
      }
      std::uint64_t mask = 0;
      for (int k = 0; k < BrickSize<Dim>; ++k)
      {
        const std::size_t i = firstOf(b) + static_cast<std::size_t>(k);
        mask |= std::uint64_t{ std::abs(move[i]) > most } << k;
      }
      mask &= this->After.activeMask(b);
      if (mask != 0)
      {
        this->Zone.activate(this->After.position(b), mask);
      }
    }
    this->Zone.storeAroundActive();
    this->Zone.allocate(this->Threads);
  }

  std::uint64_t zoneMask(std::int32_t brick) const
  {
    const std::int32_t z = this->Zone.brickAt(this->After.position(brick));
    return z == BrickLattice<Dim>::Absent ? 0 : this->Zone.activeMask(z);
  }

  const Level<Dim>& Grid;
  BrickLattice<Dim>& After;
  BrickValues Before;
  std::vector<char> Touched; ///< per brick: whether its values change, or may
  BrickLattice<Dim> Zone;    ///< what is solved for
  BrickValues Start;         ///< of the zone
  int Threads;
};

/// The bands of the last fit with those of new samples, zero.
template <int Dim>
std::vector<BrickLattice<Dim>> widenedBands(const std::vector<Level<Dim>>& levels,
  const std::vector<BrickLattice<Dim>>& old, const Samples<Dim>& added, int threads)
{
  std::vector<BrickLattice<Dim>> bricks;
  for (std::size_t l = 0; l < levels.size(); ++l)
  {
    bricks.emplace_back(levels[l].Grid);
    for (std::int32_t b = 0; b < old[l].numberOfActiveBricks(); ++b)
    {
      bricks[l].activate(old[l].position(b), old[l].activeMask(b));
    }
    Index<Dim> last;
    last.fill(-1);
    for (const Sample<Dim>& sample : added)
    {
      const Index<Dim> cell = levels[l].cellOf(sample);
      if (!levels[l].Dense && cell != last)
      {
        bricks[l].activateAround(cell);
        last = cell;
      }
    }
  }
  finishBricks(levels, bricks, threads);
  return bricks;
}
}

template <int Dim>
bool IncrementalFit<Dim>::canAdd(const Lattice<Dim>& lattice, const HermiteInput<Dim>& input,
  const HierarchicalOptions& options) const
{
  const bool kept = this->Last.Function && lattice.Size == this->Grid.Size &&
    lattice.Spacing == this->Grid.Spacing && isSameMethod(options, this->Options) &&
    continues(input, this->Input);
  const bool noiseIsKnown = this->Last.SmoothingLength == 0 && this->Last.DeterminedLevels > 0;
  const bool lengthIsOld = options.SmoothingLength < 0 && !noiseIsKnown &&
    input.Positions.cols() >= GrowthOfPoints * this->PointsOfLength;
  // Of the spacings that suit the points those count that are wider than the lattice's.
  const auto widest = [&](const HierarchicalOptions& of)
  { return std::max(of.DataSpacing, lattice.Spacing.mean()); };
  const bool fairingIsOld = widest(this->Options) > ChangeOfSpacing * widest(options) ||
    widest(options) > ChangeOfSpacing * widest(this->Options);
  return kept && !lengthIsOld && !fairingIsOld;
}

template <int Dim>
HierarchicalResult<Dim> IncrementalFit<Dim>::fit(const Lattice<Dim>& lattice,
  HermiteInput<Dim> input, const HierarchicalOptions& options, const ProgressCallback& progress)
{
  HierarchicalResult<Dim> result;
  double dataSpacing = this->Options.DataSpacing;
  if (!this->canAdd(lattice, input, options) ||
    !this->add(withoutFirst(input, this->Input.Positions.cols()), progress, result))
  {
    this->Last = {};
    dataSpacing = options.DataSpacing;
    FittedData<Dim> fitted;
    result = fitHierarchical(lattice, input, options, progress, &fitted);
    this->Levels = std::move(fitted.Levels);
    this->Outliers = std::move(fitted.Outliers);
    this->PointsOfLength = input.Positions.cols();
    this->Data.clear();
    this->Points.assign(1, {});
    for (Level<Dim>& level : this->Levels)
    {
      if (level.Coarsening == 0)
      {
        this->Points.front() = level.points();
        level.Unclustered = {};
      }
      this->Data.emplace_back();
      this->Data.back().push_back(std::move(level.Data));
      level.Data = {};
    }
  }
  this->Grid = lattice;
  this->Options = options;
  this->Options.DataSpacing = dataSpacing;
  this->Input = std::move(input);
  this->Last = result;
  return result;
}

template <int Dim>
Misses IncrementalFit<Dim>::missesOfAll(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Samples<Dim>& added, int threads) const
{
  Misses misses = missesOf(level, bricks, added, threads);
  for (const Samples<Dim>& run : this->Points)
  {
    misses += missesOf(level, bricks, run, threads);
  }
  return misses;
}

/// The largest spread of the points of the last fit and those of each addition.
template <int Dim>
double IncrementalFit<Dim>::noiseOfAll(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Samples<Dim>& added, int threads) const
{
  std::vector<SampleCheck> checks;
  const auto noiseOf = [&](const Samples<Dim>& run)
  {
    missesOf(level, bricks, run, threads, &checks);
    return spreadOf(run, checks) * level.Grid.Spacing.mean();
  };
  double noise = noiseOf(added);
  for (const Samples<Dim>& run : this->Points)
  {
    noise = std::max(noise, noiseOf(run));
  }
  return noise;
}

/// False if all is to be fitted again.
template <int Dim>
bool IncrementalFit<Dim>::add(
  HermiteInput<Dim> added, const ProgressCallback& progress, HierarchicalResult<Dim>& result)
{
  result = this->Last;
  result.NumberOfPointsAdded = added.Positions.cols();
  if (result.NumberOfPointsAdded == 0)
  {
    for (LevelReport& report : result.Reports)
    {
      report.NumberOfActiveCoefficients = 0;
    }
    return true;
  }
  const int threads = resolveThreads(this->Options.Threads);
  Samples<Dim> samples = sortedSamples(this->Grid, added, threads);
  added = {};
  const std::vector<Level<Dim>>& levels = this->Levels;
  std::vector<BrickLattice<Dim>> bricks =
    widenedBands(levels, this->Last.Function->levels(), samples, threads);
  for (std::size_t l = levels.size(); l-- > 0;)
  {
    this->Data[l].push_back(l + 1 == levels.size()
        ? cluster(samples, 0, threads)
        : coarserData(this->Data[l + 1].back(), levels[l].Coarsening, threads));
  }
  const Samples<Dim> news =
    newsAmong(samples, levels.back(), this->Last.Function->levels().back(), threads);
  const bool gated = this->Options.SmoothingLength < 0 && this->Last.SmoothingLength == 0;

  std::unique_ptr<ChangingLevel<Dim>> coarser;
  for (std::size_t l = 0; l < levels.size(); ++l)
  {
    const auto start = std::chrono::steady_clock::now();
    const Level<Dim>& level = levels[l];
    auto changing = std::make_unique<ChangingLevel<Dim>>(level, bricks[l], threads);
    changing->begin(this->Last.Function->levels()[l], coarser.get(), news);

    LevelTask<Dim> task;
    task.Predicted = l > 0;
    task.Finest = l + 1 == levels.size();
    task.SmoothingLength = this->Last.SmoothingLength;
    task.Start = &changing->start();
    // As well as the fit of all points was solved, which takes fewer iterations from here.
    task.ResidualPerRow = this->Last.Reports[l].ResidualPerRow;
    const Level<Dim> part = level.Dense
      ? Level<Dim>{ level.Coarsening, level.Grid, true,
          merged(this->Data[l], halvingsOf(level), threads), {} }
      : partOf(level, this->Data[l], this->Data[l].size(), changing->zone(), threads);
    if (!level.Dense)
    {
      const RowScales& all = this->Last.Reports[l].Scales;
      const RowScales replaced =
        scalesOf(partOf(level, this->Data[l], this->Data[l].size() - 1, changing->zone(), threads),
          changing->zone(), threads);
      task.Elsewhere.Weight = all.Weight - replaced.Weight;
      task.Elsewhere.Logarithms = all.Logarithms - replaced.Logarithms;
      task.Elsewhere.Rows = all.Rows - replaced.Rows;
      task.Elsewhere.MedianMiss = all.MedianMiss;
    }
    const auto share = [&](double ofLevel)
    {
      return !progress ||
        progress((static_cast<double>(l) + ofLevel) / static_cast<double>(levels.size()));
    };
    LevelReport& report = result.Reports[l];
    report = solveRows(part, changing->zone(), task, this->Options, threads, share);
    report.ResidualPerRow = task.ResidualPerRow;
    if (report.Aborted)
    {
      result.Aborted = true;
      result.Function.reset();
      return true;
    }
    changing->end();
    report.Seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    coarser = std::move(changing);
    if (l + 1 == this->Last.DeterminedLevels)
    {
      std::vector<SampleCheck> checks;
      missesOf(level, bricks[l], samples, threads, &checks);
      const SampleFaults faults = findFaults(samples, checks, {}, threads);
      if (faults.Outliers + faults.Flipped > 0)
      {
        return false;
      }
      result.Faults.Samples += static_cast<double>(samples.size());
      result.Faults.Normals += numberOfNormals(samples);
      if (gated)
      {
        const auto n = static_cast<double>(samples.size());
        const auto kept = static_cast<double>(this->Input.Positions.cols());
        const double noise = spreadOf(samples, checks) * level.Grid.Spacing.mean();
        result.Noise =
          std::sqrt((n * noise * noise + kept * this->Last.Noise * this->Last.Noise) / (n + kept));
        const auto before = [&]
        { return l > 0 ? this->noiseOfAll(levels[l - 1], bricks[l - 1], samples, threads) : 0.0; };
        if (isNoise(result.Noise, level.Grid.Spacing.mean(), before))
        {
          return false;
        }
      }
    }
  }
  Misses misses = this->missesOfAll(levels.back(), bricks.back(), samples, threads);
  this->Points.push_back(std::move(samples));
  result.Function = std::make_shared<const BrickSpline<Dim>>(std::move(bricks));
  misses += missesOf(*result.Function, this->Outliers);
  result.reportErrors(misses);
  return true;
}

template class IncrementalFit<2>;
template class IncrementalFit<3>;
}
