// SPDX-License-Identifier: BSD-3-Clause
#include "HierarchyLevel.h"

#include "Parallel.h"

#include <chrono>
#include <cstring>
#include <functional>

namespace ipia
{
namespace
{
/// Cells along the longest side up to which a level may be the coarsest.
constexpr std::int64_t CoarsestCells = 16;
/// Iterations of a coarsest level of more cells than that, per cell along its longest side: they
/// have to carry the data to the border of the domain.
constexpr int CoarsestIterationsPerCell = 4;
/// sum_i B_i(x)^2 on average: the density that one row per occupied cell of a surface has.
constexpr double UnitDensity = 151. / 315;
/// With fewer rows one thread is as fast as several that wait for each other ten times an
/// iteration.
constexpr std::size_t LeastRowsForThreads = 1 << 16;
/// The scale of residuals is at least this many knot spacings.
constexpr double LeastScale = 0.1;
/// Where bands are finer than the points their fairing grows up to this ratio of the spacings.
constexpr double MostFinerThanData = 4;
/// Effect of a smoothing length of n knot spacings: tau_2 >= 0.02 n^3, g >= n up to a limit.
constexpr double SmoothingThinPlate = 0.02, MostSmoothingGradient = 20;
}

template <int Dim>
HermiteRows<Dim> makeRows(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Sample<Dim>* samples, std::int64_t count, double gradient, int threads)
{
  HermiteRows<Dim> rows;
  rows.Rows.resize(static_cast<std::size_t>(count));
  BulkVector<std::int32_t> brickOf(rows.Rows.size());
  const Point<Dim> spacing = level.Grid.Spacing;
  parallelChunks(count, threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t k = begin; k < end; ++k)
      {
        const Sample<Dim>& sample = samples[k];
        const Point<Dim> position = level.positionOf(sample);
        const Index<Dim> cell = level.cellAt(position);
        Index<Dim> brick;
        HermiteRow<Dim>& row = rows.Rows[static_cast<std::size_t>(k)];
        row.Cell = 0;
        for (int a = 0; a < Dim; ++a)
        {
          brick[a] = cell[a] / BrickWidth;
          row.Cell |= static_cast<std::int32_t>(cell[a] % BrickWidth) << (2 * a);
          row.T[a] = static_cast<float>(position[a] - static_cast<double>(cell[a]));
          row.Slope[a] = static_cast<float>(spacing[a] * sample.Normal[a]);
        }
        row.Value = sample.Value;
        row.Weight = sample.Weight;
        row.GradientWeight =
          sample.HasNormal ? static_cast<float>(sample.Weight * gradient * gradient) : 0.F;
        row.Source = static_cast<std::int32_t>(k);
        brickOf[static_cast<std::size_t>(k)] = bricks.brickAt(brick);
      }
    });
  std::array<std::vector<typename HermiteRows<Dim>::Brick>, HermiteRows<Dim>::NumberOfColours>
    coloured;
  for (std::size_t k = 0; k < brickOf.size();)
  {
    std::size_t end = k, colour = 0;
    while (end < brickOf.size() && brickOf[end] == brickOf[k])
    {
      ++end;
    }
    for (int a = 0; a < Dim; ++a)
    {
      colour |= static_cast<std::size_t>(bricks.position(brickOf[k])[a] & 1) << a;
    }
    coloured[colour].push_back(
      { brickOf[k], static_cast<std::int64_t>(k), static_cast<std::int64_t>(end) });
    k = end;
  }
  for (std::size_t k = 0; k < coloured.size(); ++k)
  {
    rows.ColourBegin[k] = rows.Bricks.size();
    rows.Bricks.insert(rows.Bricks.end(), coloured[k].begin(), coloured[k].end());
  }
  rows.ColourBegin[coloured.size()] = rows.Bricks.size();
  return rows;
}

namespace
{
/// The sums of the scales of rows.
template <int Dim>
RowScales densityScales(
  const BrickOperator<Dim>& collocation, const HermiteRows<Dim>& rows, int threads)
{
  BrickValues sums, density;
  collocation.density(sums);
  collocation.evaluate(sums, density);
  const auto n = static_cast<std::int64_t>(rows.Rows.size());
  const auto sumOver = [&](const auto& term)
  {
    return parallelSum(n, threads,
      [&](std::int64_t begin, std::int64_t end)
      {
        double sum = 0;
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
        {
          const HermiteRow<Dim>& row = rows.Rows[k];
          const double relative = density[static_cast<std::size_t>(row.Source)] / UnitDensity;
          sum += row.Weight > 0 && relative > 0 ? term(row, relative) : 0.0;
        }
        return sum;
      });
  };
  RowScales scales;
  scales.Weight = sumOver([](const HermiteRow<Dim>& row, double) { return row.Weight; });
  scales.Logarithms = sumOver(
    [](const HermiteRow<Dim>& row, double relative) { return row.Weight * std::log(relative); });
  scales.Rows = static_cast<double>(n);
  return scales;
}

/// The density of rows that weighs about 1 in all, their weighted geometric mean.
double typicalOf(const RowScales& scales)
{
  return scales.Weight > 0 ? std::exp(scales.Logarithms / scales.Weight) : 1.0;
}
}

template <int Dim>
double typicalDensity(const BrickLattice<Dim>& bricks, const HermiteRows<Dim>& rows, int threads)
{
  return typicalOf(densityScales(BrickOperator<Dim>(bricks, rows, {}, threads), rows, threads));
}

namespace
{
/// The value that size / 2 others precede, of values >= 0.
float median(const BulkVector<float>& values, int threads)
{
  // The bits of positive floats are ordered as the floats are: half of them at a time, by counting.
  constexpr std::size_t halves = 1 << 16;
  const auto n = static_cast<std::int64_t>(values.size());
  const auto bitsOf = [&values](std::int64_t k)
  {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &values[static_cast<std::size_t>(k)], sizeof(bits));
    return bits;
  };
  std::int64_t rank = n / 2;
  std::uint32_t found = 0;
  for (const int shift : { 16, 0 })
  {
    std::vector<std::int64_t> count(halves, 0);
#pragma omp parallel num_threads(threads)
    {
      std::vector<std::int64_t> own(halves, 0);
#pragma omp for schedule(static)
      for (std::int64_t k = 0; k < n; ++k)
      {
        const std::uint32_t bits = bitsOf(k);
        if (shift == 16 || bits >> 16 == found >> 16)
        {
          ++own[bits >> shift & (halves - 1)];
        }
      }
#pragma omp critical
      std::transform(own.begin(), own.end(), count.begin(), count.begin(), std::plus<>());
    }
    std::uint32_t half = 0;
    for (; half + 1 < halves && rank >= count[half]; ++half)
    {
      rank -= count[half];
    }
    found |= half << shift;
  }
  float value = 0;
  std::memcpy(&value, &found, sizeof(value));
  return value;
}

/// Scales the weights so that the rows of an occupied cell weigh about 1 in all, and takes weight
/// from rows that the coarser prediction misses by far, from those of parts too thin for the
/// lattice, which the fairing is to hold together, and where the fairing is to count more.
///
/// @return the scales of these and the rows elsewhere
template <int Dim>
RowScales weighRows(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  HermiteRows<Dim>& rows, const LevelTask<Dim>& task, const HierarchicalOptions& options,
  int threads)
{
  const bool predicted = task.Predicted;
  const BrickOperator<Dim> collocation(bricks, rows, {}, threads);
  const auto n = static_cast<std::int64_t>(rows.Rows.size());
  RowScales scales = densityScales(collocation, rows, threads);
  scales.Weight += task.Elsewhere.Weight;
  scales.Logarithms += task.Elsewhere.Logarithms;
  const double typical = typicalOf(scales);

  // f and its gradient, in knot spacings, by the coarser level.
  constexpr std::size_t stride = 1 + Dim;
  BrickValues prediction;
  const double spacing = level.Grid.Spacing.mean();
  double scale = 0;
  if (predicted)
  {
    collocation.evaluateWithGradient(bricks.coefficients(), prediction);
  }
  if (predicted && options.RobustFactor > 0)
  {
    BulkVector<float> misses(rows.Rows.size());
    parallelChunks(n, threads,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
        {
          const HermiteRow<Dim>& row = rows.Rows[i];
          const auto k = static_cast<std::size_t>(row.Source);
          misses[k] = std::abs(prediction[k * stride] - row.Value);
        }
      });
    scales.MedianMiss = n > 0 ? median(misses, threads) : 0.0;
    if (task.Elsewhere.Rows > 0)
    {
      // Not the median of all, which would need all of them, but near it.
      scales.MedianMiss =
        (scales.Rows * scales.MedianMiss + task.Elsewhere.Rows * task.Elsewhere.MedianMiss) /
        (scales.Rows + task.Elsewhere.Rows);
    }
    scale = options.RobustFactor * std::max(1.4826 * scales.MedianMiss, LeastScale * spacing);
  }
  scales.Rows += task.Elsewhere.Rows;
  // On coarse levels every part is thin, and the finer ones need what these know of it.
  const bool mayBeThin = predicted && longestAxis(level.Grid) > 2 * options.DenseCells;
  const auto weigh = [&](HermiteRow<Dim>& row)
  {
    double factor = 1 / typical;
    const float* const at =
      predicted ? &prediction[static_cast<std::size_t>(row.Source) * stride] : nullptr;
    if (scale > 0)
    {
      const double miss = (at[0] - row.Value) / scale;
      const double trust = 1 / (1 + miss * miss);
      factor *= trust * trust;
    }
    if (mayBeThin && row.GradientWeight > 0)
    {
      factor *= trustInSlope<Dim>(row, at + 1);
    }
    factor /= level.Data[static_cast<std::size_t>(row.Source)].Fairing;
    row.Weight *= static_cast<float>(factor);
    row.GradientWeight *= static_cast<float>(factor);
  };
  parallelChunks(n, threads,
    [&](std::int64_t begin, std::int64_t end)
    { std::for_each(rows.Rows.begin() + begin, rows.Rows.begin() + end, weigh); });
  return scales;
}

/// Marks what a level solves for: the coefficients around the cells with data.
template <int Dim>
void activateBand(const Level<Dim>& level, BrickLattice<Dim>& bricks)
{
  Index<Dim> last;
  last.fill(-1);
  for (const Sample<Dim>& sample : level.Data)
  {
    const Index<Dim> cell = level.cellOf(sample);
    if (cell != last)
    {
      bricks.activateAround(cell);
      last = cell;
    }
  }
}
}

template <int Dim>
void solveSystem(const BrickOperator<Dim>& system, BrickLattice<Dim>& bricks, int iterations,
  double tolerance, StoppingRule rule, double enough, int threads, const ProgressCallback& progress,
  LevelReport& report)
{
  BrickValues r, p, q, inverse;
  system.diagonal(inverse);
  system.residual(r);
  const auto n = static_cast<std::int64_t>(r.size());
  parallelChunks(n, threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        const auto b = static_cast<std::int32_t>(i / BrickSize<Dim>);
        const bool active = (bricks.activeMask(b) >> (i % BrickSize<Dim>)&1) != 0;
        float& d = inverse[static_cast<std::size_t>(i)];
        d = active && d > 0 ? 1 / d : 0.F;
      }
    });
  p.resize(r.size());
  double rz = parallelSum(n, threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      double sum = 0;
      for (std::int64_t i = begin; i < end; ++i)
      {
        const auto k = static_cast<std::size_t>(i);
        p[k] = inverse[k] * r[k];
        sum += static_cast<double>(p[k]) * r[k];
      }
      return sum;
    });
  const double first = rz;
  report.ResidualHistory.assign(1, first > 0 ? 1. : 0.);
  double measure = report.ResidualHistory.front();
  float* c = bricks.coefficients().data();
  while (report.NumberOfIterations < iterations && rz > enough && !(measure < tolerance))
  {
    if (progress && !progress(static_cast<double>(report.NumberOfIterations) / iterations))
    {
      report.Aborted = true;
      return;
    }
    system.product(p, q);
    const double curvature = parallelSum(n, threads,
      [&](std::int64_t begin, std::int64_t end)
      {
        double sum = 0;
        for (std::int64_t i = begin; i < end; ++i)
        {
          const auto k = static_cast<std::size_t>(i);
          sum += static_cast<double>(p[k]) * q[k];
        }
        return sum;
      });
    if (!(curvature > 0))
    {
      break;
    }
    const auto step = static_cast<float>(rz / curvature);
    const double next = parallelSum(n, threads,
      [&](std::int64_t begin, std::int64_t end)
      {
        double sum = 0;
        for (std::int64_t i = begin; i < end; ++i)
        {
          const auto k = static_cast<std::size_t>(i);
          c[k] += step * p[k];
          r[k] -= step * q[k];
          sum += static_cast<double>(inverse[k] * r[k]) * r[k];
        }
        return sum;
      });
    const auto ratio = static_cast<float>(next / rz);
    const double energyChange = rz * static_cast<double>(step);
    rz = next;
    report.ResidualHistory.push_back(std::sqrt(rz / first));
    measure = rule == StoppingRule::RelativeResidual ? report.ResidualHistory.back() : energyChange;
    parallelChunks(n, threads,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          const auto k = static_cast<std::size_t>(i);
          p[k] = inverse[k] * r[k] + ratio * p[k];
        }
      });
    ++report.NumberOfIterations;
  }
  report.ResidualPerRow = rz / std::max(static_cast<double>(report.NumberOfRows), 1.0);
}

template <int Dim>
double trustInSlope(const HermiteRow<Dim>& row, const float* predictedGradient)
{
  constexpr double fullSlope = 0.7, leastSlope = 0.03;
  double along = 0, full = 0;
  for (int a = 0; a < Dim; ++a)
  {
    along += static_cast<double>(row.Slope[a]) * predictedGradient[a];
    full += static_cast<double>(row.Slope[a]) * row.Slope[a];
  }
  const double slope = full > 0 ? along / full : 1.0;
  return std::sqrt(std::min(std::max(slope / fullSlope, leastSlope), 1.0));
}

template <int Dim>
double occupiedCells(const Level<Dim>& level, int threads)
{
  // In the order of the samples those of a cell are together.
  return parallelSum(static_cast<std::int64_t>(level.Data.size()), threads,
    [&level](std::int64_t begin, std::int64_t end)
    {
      double count = 0;
      Index<Dim> last;
      last.fill(-1);
      if (begin > 0)
      {
        last = level.cellOf(level.Data[static_cast<std::size_t>(begin - 1)]);
      }
      for (std::int64_t k = begin; k < end; ++k)
      {
        const Index<Dim> cell = level.cellOf(level.Data[static_cast<std::size_t>(k)]);
        count += cell != last;
        last = cell;
      }
      return count;
    });
}

template <int Dim>
Samples<Dim> coarserData(const Samples<Dim>& finer, int coarsening, int threads)
{
  return cluster(finer, coarsening + SubCellBits - ClusterBits, threads);
}

template <int Dim>
std::vector<Level<Dim>> makeLevels(
  const Lattice<Dim>& lattice, Samples<Dim> points, const HierarchicalOptions& options, int threads)
{
  std::vector<Level<Dim>> levels;
  for (int coarsening = 0;; ++coarsening)
  {
    Level<Dim> level;
    level.Coarsening = coarsening;
    std::int64_t longest = 0;
    for (int a = 0; a < Dim; ++a)
    {
      const std::int64_t step = std::int64_t{ 1 } << coarsening;
      const std::int64_t cells = (lattice.cells(a) + step - 1) / step;
      level.Grid.Size[a] = cells + Order - 1;
      level.Grid.Spacing[a] = lattice.Spacing[a] * static_cast<double>(step);
      longest = std::max(longest, cells);
    }
    level.Dense = longest <= options.DenseCells;
    if (coarsening == 0)
    {
      level.Data = cluster(points, 0, threads);
      if (level.Data.size() < points.size())
      {
        level.Unclustered = std::move(points);
      }
    }
    else
    {
      level.Data = coarserData(levels.back().Data, coarsening, threads);
    }
    levels.push_back(std::move(level));
    const bool coarsest = options.NumberOfLevels > 0 ? coarsening + 1 == options.NumberOfLevels
                                                     : longest <= CoarsestCells;
    if (coarsest || longest == 1)
    {
      break;
    }
  }
  // Below the coarsest level there is nothing to correct: it is solved everywhere.
  levels.back().Dense = true;
  std::reverse(levels.begin(), levels.end());
  return levels;
}

template <int Dim>
std::vector<BrickLattice<Dim>> makeBricks(const std::vector<Level<Dim>>& levels, int threads)
{
  std::vector<BrickLattice<Dim>> bricks;
  for (const Level<Dim>& level : levels)
  {
    bricks.emplace_back(level.Grid);
  }
  // The bands do not know of each other yet.
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t k = 0; k < levels.size(); ++k)
  {
    const std::size_t l = levels.size() - 1 - k; // the finest takes longest
    if (levels[l].Dense)
    {
      bricks[l].activateAll();
    }
    else
    {
      activateBand(levels[l], bricks[l]);
    }
  }
  finishBricks(levels, bricks, threads);
  return bricks;
}

template <int Dim>
void finishBricks(
  const std::vector<Level<Dim>>& levels, std::vector<BrickLattice<Dim>>& bricks, int threads)
{
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t k = 0; k < levels.size(); ++k)
  {
    const std::size_t l = levels.size() - 1 - k;
    if (!levels[l].Dense)
    {
      bricks[l].storeAroundActive();
    }
  }
  for (std::size_t l = levels.size(); l-- > 0;)
  {
    if (l + 1 < levels.size() && !levels[l].Dense)
    {
      bricks[l].storeForRefinement(bricks[l + 1]);
    }
    bricks[l].allocate(threads);
  }
}

template <int Dim>
LevelReport solveRows(const Level<Dim>& level, BrickLattice<Dim>& bricks,
  const LevelTask<Dim>& task, const HierarchicalOptions& options, int threads,
  const ProgressCallback& progress)
{
  threads = level.Data.size() < LeastRowsForThreads ? 1 : threads;
  const bool finest = task.Finest;
  const double relative = task.SmoothingLength / level.Grid.Spacing.mean();
  const double gradient = level.Dense ? options.DenseGradient
    : finest                          ? options.FinestGradient
                                      : options.BandGradient;
  HermiteRows<Dim> rows =
    makeRows(level, bricks, level.Data.data(), static_cast<std::int64_t>(level.Data.size()),
      std::max(gradient, std::min(relative, MostSmoothingGradient)), threads);
  LevelReport report;
  report.Scales = weighRows(level, bricks, rows, task, options, threads);
  if (task.Start)
  {
    bricks.coefficients() = *task.Start;
  }
  const double finer =
    std::clamp(options.DataSpacing / level.Grid.Spacing.mean(), 1.0, MostFinerThanData);
  const double thinPlate =
    level.Dense ? options.DenseThinPlate : options.BandThinPlate * std::pow(finer, 4);
  FairingWeights fairing;
  fairing.Membrane = static_cast<float>(level.Dense ? options.DenseMembrane : options.BandMembrane);
  fairing.ThinPlate =
    static_cast<float>(std::max(thinPlate, SmoothingThinPlate * relative * relative * relative));
  const BrickOperator<Dim> system(bricks, rows, fairing, threads);

  report.Spacing = level.Grid.Spacing.maxCoeff();
  report.NumberOfRows = static_cast<std::int64_t>(rows.Rows.size());
  report.NumberOfActiveCoefficients = bricks.numberOfActiveCoefficients();
  int iterations = level.Dense ? options.DenseIterations : options.BandIterations;
  double tolerance = level.Dense ? options.DenseTolerance : options.BandTolerance;
  if (!task.Predicted && longestAxis(level.Grid) > CoarsestCells)
  {
    iterations =
      std::max(iterations, CoarsestIterationsPerCell * static_cast<int>(longestAxis(level.Grid)));
  }
  if (finest && options.FinestIterations > 0)
  {
    iterations = options.FinestIterations;
  }
  if (finest && options.FinestTolerance >= 0)
  {
    tolerance = options.FinestTolerance;
  }
  solveSystem(system, bricks, iterations, tolerance,
    finest ? options.Rule : StoppingRule::RelativeResidual,
    task.ResidualPerRow * static_cast<double>(report.NumberOfRows), threads, progress, report);
  if (finest)
  {
    report.Energy = system.energy();
  }
  return report;
}

template <int Dim>
RowScales scalesOf(const Level<Dim>& level, const BrickLattice<Dim>& bricks, int threads)
{
  const HermiteRows<Dim> rows = makeRows(
    level, bricks, level.Data.data(), static_cast<std::int64_t>(level.Data.size()), 0, threads);
  return densityScales(BrickOperator<Dim>(bricks, rows, {}, threads), rows, threads);
}

template <int Dim>
LevelReport solveLevel(const std::vector<Level<Dim>>& levels,
  std::vector<BrickLattice<Dim>>& bricks, std::size_t l, double smoothing,
  const HierarchicalOptions& options, int threads, const ProgressCallback& progress)
{
  const auto start = std::chrono::steady_clock::now();
  const int few = levels[l].Data.size() < LeastRowsForThreads ? 1 : threads;
  if (l > 0)
  {
    bricks[l].refineFrom(bricks[l - 1], few);
  }
  else
  {
    std::fill(bricks[l].coefficients().begin(), bricks[l].coefficients().end(), 0.F);
  }
  LevelTask<Dim> task;
  task.Predicted = l > 0;
  task.Finest = l + 1 == levels.size();
  task.SmoothingLength = smoothing;
  LevelReport report = solveRows(levels[l], bricks[l], task, options, threads, progress);
  report.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

template <int Dim>
void evaluateLevel(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const Sample<Dim>* begin, const Sample<Dim>* end, BrickValues& values)
{
  const HermiteRows<Dim> rows = makeRows(level, bricks, begin, end - begin, 0, 1);
  BrickOperator<Dim>(bricks, rows, {}, 1).evaluateWithGradient(bricks.coefficients(), values);
  for (std::size_t k = 0; k < rows.Rows.size(); ++k)
  {
    for (int a = 0; a < Dim; ++a)
    {
      values[k * (1 + Dim) + 1 + static_cast<std::size_t>(a)] /=
        static_cast<float>(level.Grid.Spacing[a]);
    }
  }
}

template std::vector<Level<2>> makeLevels<2>(
  const Lattice<2>&, Samples<2>, const HierarchicalOptions&, int);
template Samples<2> coarserData<2>(const Samples<2>&, int, int);
template std::vector<BrickLattice<2>> makeBricks<2>(const std::vector<Level<2>>&, int);
template HermiteRows<2> makeRows<2>(
  const Level<2>&, const BrickLattice<2>&, const Sample<2>*, std::int64_t, double, int);
template double typicalDensity<2>(const BrickLattice<2>&, const HermiteRows<2>&, int);
template void solveSystem<2>(const BrickOperator<2>&, BrickLattice<2>&, int, double, StoppingRule,
  double, int, const ProgressCallback&, LevelReport&);
template void finishBricks<2>(const std::vector<Level<2>>&, std::vector<BrickLattice<2>>&, int);
template double trustInSlope<2>(const HermiteRow<2>&, const float*);
template double occupiedCells<2>(const Level<2>&, int);
template LevelReport solveRows<2>(const Level<2>&, BrickLattice<2>&, const LevelTask<2>&,
  const HierarchicalOptions&, int, const ProgressCallback&);
template RowScales scalesOf<2>(const Level<2>&, const BrickLattice<2>&, int);
template LevelReport solveLevel<2>(const std::vector<Level<2>>&, std::vector<BrickLattice<2>>&,
  std::size_t, double, const HierarchicalOptions&, int, const ProgressCallback&);
template void evaluateLevel<2>(
  const Level<2>&, const BrickLattice<2>&, const Sample<2>*, const Sample<2>*, BrickValues&);
template std::vector<Level<3>> makeLevels<3>(
  const Lattice<3>&, Samples<3>, const HierarchicalOptions&, int);
template Samples<3> coarserData<3>(const Samples<3>&, int, int);
template std::vector<BrickLattice<3>> makeBricks<3>(const std::vector<Level<3>>&, int);
template HermiteRows<3> makeRows<3>(
  const Level<3>&, const BrickLattice<3>&, const Sample<3>*, std::int64_t, double, int);
template double typicalDensity<3>(const BrickLattice<3>&, const HermiteRows<3>&, int);
template void solveSystem<3>(const BrickOperator<3>&, BrickLattice<3>&, int, double, StoppingRule,
  double, int, const ProgressCallback&, LevelReport&);
template void finishBricks<3>(const std::vector<Level<3>>&, std::vector<BrickLattice<3>>&, int);
template double trustInSlope<3>(const HermiteRow<3>&, const float*);
template double occupiedCells<3>(const Level<3>&, int);
template LevelReport solveRows<3>(const Level<3>&, BrickLattice<3>&, const LevelTask<3>&,
  const HierarchicalOptions&, int, const ProgressCallback&);
template RowScales scalesOf<3>(const Level<3>&, const BrickLattice<3>&, int);
template LevelReport solveLevel<3>(const std::vector<Level<3>>&, std::vector<BrickLattice<3>>&,
  std::size_t, double, const HierarchicalOptions&, int, const ProgressCallback&);
template void evaluateLevel<3>(
  const Level<3>&, const BrickLattice<3>&, const Sample<3>*, const Sample<3>*, BrickValues&);
}
