// SPDX-License-Identifier: BSD-3-Clause
#include "HierarchicalFit.h"

#include "BrickOperator.h"
#include "Parallel.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>

namespace ipia
{
namespace
{
/// Points are clustered in sub-cells, this many bits of them per knot cell and axis.
constexpr int SubCellBits = 2;
/// Cells along the longest side up to which a level may be the coarsest.
constexpr std::int64_t CoarsestCells = 16;
/// sum_i B_i(x)^2 on average: the density that one row per occupied cell of a surface has.
constexpr double UnitDensity = 151. / 315;
/// The scale of residuals is at least this many knot spacings.
constexpr double LeastScale = 0.1;

/// A point or the mean of a cluster, in cells of the finest lattice.
template <int Dim>
struct Sample
{
  std::uint64_t Key; ///< Morton code of its finest sub-cell
  Point<Dim> Position;
  Point<Dim> Normal;
  double Value;
  double Weight;
  bool HasNormal;
  bool IsExtra; ///< not one of the points that the surface goes through
};

template <int Dim>
std::uint64_t mortonKey(const Index<Dim>& i)
{
  std::uint64_t key = 0;
  for (int a = 0; a < Dim; ++a)
  {
    // Spreads the bits of one coordinate with gaps for the others.
    auto v = static_cast<std::uint64_t>(i[a]);
    if (Dim == 3)
    {
      v &= 0x1fffff;
      v = (v | v << 32) & 0x1f00000000ffff;
      v = (v | v << 16) & 0x1f0000ff0000ff;
      v = (v | v << 8) & 0x100f00f00f00f00f;
      v = (v | v << 4) & 0x10c30c30c30c30c3;
      v = (v | v << 2) & 0x1249249249249249;
    }
    else
    {
      v &= 0xffffffff;
      v = (v | v << 16) & 0x0000ffff0000ffff;
      v = (v | v << 8) & 0x00ff00ff00ff00ff;
      v = (v | v << 4) & 0x0f0f0f0f0f0f0f0f;
      v = (v | v << 2) & 0x3333333333333333;
      v = (v | v << 1) & 0x5555555555555555;
    }
    key |= v << a;
  }
  return key;
}

/// All rows in the Morton order of their sub-cells, which nests those of all levels.
template <int Dim>
std::vector<Sample<Dim>> sortedSamples(const Lattice<Dim>& lattice, const HermiteInput<Dim>& input)
{
  const std::int64_t n = input.Positions.cols(), m = input.ExtraPositions.cols();
  std::vector<std::pair<std::uint64_t, std::int64_t>> order(static_cast<std::size_t>(n + m));
  const auto positionOf = [&](std::int64_t k) -> Point<Dim>
  {
    return (k < n ? input.Positions.col(k) : input.ExtraPositions.col(k - n))
      .cwiseQuotient(lattice.Spacing);
  };
  for (std::int64_t k = 0; k < n + m; ++k)
  {
    const Point<Dim> u = positionOf(k);
    Index<Dim> subCell;
    for (int a = 0; a < Dim; ++a)
    {
      const std::int64_t last = (lattice.cells(a) << SubCellBits) - 1;
      const auto at = static_cast<std::int64_t>(std::floor(u[a] * (1 << SubCellBits)));
      subCell[a] = std::min(std::max<std::int64_t>(at, 0), last);
    }
    order[static_cast<std::size_t>(k)] = { mortonKey<Dim>(subCell), k };
  }
  std::sort(order.begin(), order.end());
  std::vector<Sample<Dim>> samples;
  samples.reserve(order.size());
  for (const auto& entry : order)
  {
    const std::int64_t k = entry.second;
    Sample<Dim> sample;
    sample.Key = entry.first;
    sample.Position = positionOf(k);
    const bool extra = k >= n;
    sample.Normal = Point<Dim>::Zero();
    if (!extra)
    {
      sample.Normal = input.Normals.col(k);
    }
    sample.HasNormal = !sample.Normal.isZero(0);
    sample.IsExtra = extra;
    sample.Value = extra ? input.ExtraValues[k - n] : 0;
    const Vector& weights = extra ? input.ExtraWeights : input.Weights;
    sample.Weight = weights.size() == 0 ? 1 : weights[extra ? k - n : k];
    samples.push_back(sample);
  }
  return samples;
}

/// Means of the samples that share a sub-cell of the level @a coarsening halvings below the finest.
template <int Dim>
std::vector<Sample<Dim>> cluster(const std::vector<Sample<Dim>>& samples, int coarsening)
{
  std::vector<Sample<Dim>> clusters;
  const int shift = Dim * coarsening;
  for (std::size_t k = 0; k < samples.size();)
  {
    Sample<Dim> mean{ samples[k].Key, Point<Dim>::Zero(), Point<Dim>::Zero(), 0, 0, false, false };
    std::size_t end = k;
    double count = 0;
    Point<Dim> plain = Point<Dim>::Zero();
    for (; end < samples.size() && samples[end].Key >> shift == samples[k].Key >> shift; ++end)
    {
      const Sample<Dim>& s = samples[end];
      mean.Position += s.Weight * s.Position;
      mean.Normal += s.Weight * s.Normal;
      mean.Value += s.Weight * s.Value;
      mean.Weight += s.Weight;
      mean.HasNormal = mean.HasNormal || s.HasNormal;
      plain += s.Position;
      ++count;
    }
    if (mean.Weight > 0)
    {
      mean.Position /= mean.Weight;
      mean.Normal /= mean.Weight;
      mean.Value /= mean.Weight;
    }
    else
    {
      mean.Position = plain / count;
    }
    clusters.push_back(mean);
    k = end;
  }
  return clusters;
}

/// A level before it is solved.
template <int Dim>
struct Level
{
  int Coarsening; ///< halvings below the finest
  Lattice<Dim> Grid;
  bool Dense;
  std::vector<Sample<Dim>> Samples;

  Index<Dim> cellOf(const Sample<Dim>& sample) const
  {
    Index<Dim> cell;
    for (int a = 0; a < Dim; ++a)
    {
      const auto at =
        static_cast<std::int64_t>(std::floor(std::ldexp(sample.Position[a], -this->Coarsening)));
      cell[a] = std::min(std::max<std::int64_t>(at, 0), this->Grid.cells(a) - 1);
    }
    return cell;
  }
};

template <int Dim>
std::vector<Level<Dim>> makeLevels(
  const Lattice<Dim>& lattice, std::vector<Sample<Dim>> samples, const HierarchicalOptions& options)
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
    level.Samples =
      coarsening == 0 ? std::move(samples) : cluster(levels.back().Samples, coarsening);
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
std::vector<BrickLattice<Dim>> makeBricks(const std::vector<Level<Dim>>& levels)
{
  std::vector<BrickLattice<Dim>> bricks;
  for (const Level<Dim>& level : levels)
  {
    bricks.emplace_back(level.Grid);
  }
  for (std::size_t l = levels.size(); l-- > 0;)
  {
    if (levels[l].Dense)
    {
      bricks[l].activateAll();
    }
    else
    {
      Index<Dim> last;
      last.fill(-1);
      for (const Sample<Dim>& sample : levels[l].Samples)
      {
        const Index<Dim> cell = levels[l].cellOf(sample);
        if (cell != last)
        {
          bricks[l].activateAround(cell);
          last = cell;
        }
      }
      bricks[l].storeAroundActive();
    }
    if (l + 1 < levels.size() && !levels[l].Dense)
    {
      bricks[l].storeForRefinement(bricks[l + 1]);
    }
    bricks[l].allocate();
  }
  return bricks;
}

template <int Dim>
double occupiedCells(const Level<Dim>& level)
{
  double count = 0;
  Index<Dim> last;
  last.fill(-1);
  for (const Sample<Dim>& sample : level.Samples)
  {
    const Index<Dim> cell = level.cellOf(sample);
    count += cell != last;
    last = cell;
  }
  return count;
}

template <int Dim>
HermiteRows<Dim> makeRows(const Level<Dim>& level, const BrickLattice<Dim>& bricks, double gradient)
{
  HermiteRows<Dim> rows;
  rows.Rows.reserve(level.Samples.size());
  std::array<std::vector<typename HermiteRows<Dim>::Brick>, HermiteRows<Dim>::NumberOfColours>
    coloured;
  Index<Dim> current;
  current.fill(-1);
  std::size_t colour = 0;
  for (const Sample<Dim>& sample : level.Samples)
  {
    const Index<Dim> cell = level.cellOf(sample);
    Index<Dim> brick;
    HermiteRow<Dim> row;
    row.Cell = 0;
    for (int a = 0; a < Dim; ++a)
    {
      brick[a] = cell[a] / BrickWidth;
      row.Cell |= static_cast<std::int32_t>(cell[a] % BrickWidth) << (2 * a);
      row.T[a] = static_cast<float>(
        std::ldexp(sample.Position[a], -level.Coarsening) - static_cast<double>(cell[a]));
      row.Slope[a] = static_cast<float>(level.Grid.Spacing[a] * sample.Normal[a]);
    }
    row.Value = static_cast<float>(sample.Value);
    row.Weight = static_cast<float>(sample.Weight);
    row.GradientWeight =
      sample.HasNormal ? static_cast<float>(sample.Weight * gradient * gradient) : 0.F;
    row.Source = static_cast<std::int32_t>(rows.Rows.size());
    if (brick != current)
    {
      current = brick;
      colour = 0;
      for (int a = 0; a < Dim; ++a)
      {
        colour |= static_cast<std::size_t>(brick[a] & 1) << a;
      }
      const auto at = static_cast<std::int64_t>(rows.Rows.size());
      coloured[colour].push_back({ bricks.brickAt(brick), at, at });
    }
    ++coloured[colour].back().End;
    rows.Rows.push_back(row);
  }
  for (std::size_t k = 0; k < coloured.size(); ++k)
  {
    rows.ColourBegin[k] = rows.Bricks.size();
    rows.Bricks.insert(rows.Bricks.end(), coloured[k].begin(), coloured[k].end());
  }
  rows.ColourBegin[coloured.size()] = rows.Bricks.size();
  return rows;
}

double median(std::vector<float> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Scales the weights so that the rows of an occupied cell weigh about 1 in all, and takes weight
/// from rows that the coarser prediction misses by far.
template <int Dim>
void weighRows(const BrickLattice<Dim>& bricks, HermiteRows<Dim>& rows, bool predicted,
  const HierarchicalOptions& options, int threads)
{
  const BrickOperator<Dim> collocation(bricks, rows, {}, threads);
  std::vector<float> sums, density, prediction;
  collocation.density(sums);
  collocation.evaluate(sums, density);
  double logarithms = 0, total = 0;
  for (const HermiteRow<Dim>& row : rows.Rows)
  {
    const double relative = density[static_cast<std::size_t>(row.Source)] / UnitDensity;
    if (row.Weight > 0 && relative > 0)
    {
      logarithms += row.Weight * std::log(relative);
      total += row.Weight;
    }
  }
  const double typical = total > 0 ? std::exp(logarithms / total) : 1.0;

  double scale = 0;
  if (predicted && options.RobustFactor > 0)
  {
    collocation.evaluate(bricks.coefficients(), prediction);
    std::vector<float> misses(prediction.size());
    for (const HermiteRow<Dim>& row : rows.Rows)
    {
      const auto k = static_cast<std::size_t>(row.Source);
      misses[k] = prediction[k] = std::abs(prediction[k] - row.Value);
    }
    scale = options.RobustFactor *
      std::max(1.4826 * median(std::move(misses)), LeastScale * bricks.lattice().Spacing.mean());
  }
  for (HermiteRow<Dim>& row : rows.Rows)
  {
    double factor = 1 / typical;
    if (scale > 0)
    {
      const double miss = prediction[static_cast<std::size_t>(row.Source)] / scale;
      const double trust = 1 / (1 + miss * miss);
      factor *= trust * trust;
    }
    row.Weight *= static_cast<float>(factor);
    row.GradientWeight *= static_cast<float>(factor);
  }
}

/// Conjugate gradients with the diagonal as preconditioner, on the active coefficients.
template <int Dim>
void solveLevel(const BrickOperator<Dim>& system, BrickLattice<Dim>& bricks, int iterations,
  double tolerance, StoppingRule rule, int threads, LevelReport& report)
{
  std::vector<float> r, p, q, inverse;
  system.diagonal(inverse);
  system.residual(r);
  const auto n = static_cast<std::int64_t>(r.size());
  for (std::int32_t b = 0; b < bricks.numberOfActiveBricks(); ++b)
  {
    const std::uint64_t mask = bricks.activeMask(b);
    float* d = inverse.data() + static_cast<std::int64_t>(b) * BrickSize<Dim>;
    for (int k = 0; k < BrickSize<Dim>; ++k)
    {
      d[k] = (mask >> k & 1) != 0 && d[k] > 0 ? 1 / d[k] : 0.F;
    }
  }
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
  while (report.NumberOfIterations < iterations && rz > 0 && !(measure < tolerance))
  {
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
}

/// Occupied cells hold at least this many points where the data alone determine f.
constexpr double PointsPerDeterminedCell = 3;
/// Data are noisy if on such a level the points miss the surface by more than this many knot
/// spacings, and the level before did not miss it by much more: detail that a coarse lattice cannot
/// follow falls by the power of its order from level to level, noise stays.
constexpr double NoiseGate = 0.05, NoiseFall = 0.5;
/// Slopes of f below this do not count as slopes when distances are estimated.
constexpr double LeastSlope = 0.2;
/// Effect of a smoothing length of n knot spacings: tau_2 >= 0.02 n^3, g >= n up to a limit.
constexpr double SmoothingThinPlate = 0.02, MostSmoothingGradient = 20;
/// Cross-validation: every so many'th point is held out and levels up to so many cells are fitted,
/// in fewer iterations. It starts from this many point spacings and goes in factors of the square
/// root of two; the shortest length is taken that predicts within a percent of the best.
constexpr std::int64_t HeldOutPeriod = 8;
constexpr std::int64_t ValidationCells = 64;
constexpr int ValidationIterations = 8, MostValidations = 5;
constexpr double FirstSmoothing = 2.4, ValidationStep = 1.41421356, ValidationSlack = 1.01;
/// Squared errors of predicted normals are cut here, so that outliers do not decide.
constexpr double MostNormalError = 2;

template <int Dim>
std::int64_t longestAxis(const Lattice<Dim>& lattice)
{
  std::int64_t cells = 0;
  for (int a = 0; a < Dim; ++a)
  {
    cells = std::max(cells, lattice.cells(a));
  }
  return cells;
}

/// Solves level @a l from its predecessor.
template <int Dim>
LevelReport solveOne(const std::vector<Level<Dim>>& levels, std::vector<BrickLattice<Dim>>& bricks,
  std::size_t l, double smoothing, const HierarchicalOptions& options, int threads)
{
  const auto start = std::chrono::steady_clock::now();
  const Level<Dim>& level = levels[l];
  const bool finest = l + 1 == levels.size();
  if (l > 0)
  {
    bricks[l].refineFrom(bricks[l - 1], threads);
  }
  else
  {
    std::fill(bricks[l].coefficients().begin(), bricks[l].coefficients().end(), 0.F);
  }
  const double relative = smoothing / level.Grid.Spacing.mean();
  const double gradient = level.Dense ? options.DenseGradient
    : finest                          ? options.FinestGradient
                                      : options.BandGradient;
  HermiteRows<Dim> rows =
    makeRows(level, bricks[l], std::max(gradient, std::min(relative, MostSmoothingGradient)));
  weighRows(bricks[l], rows, l > 0, options, threads);
  FairingWeights fairing;
  fairing.Membrane = static_cast<float>(level.Dense ? options.DenseMembrane : options.BandMembrane);
  fairing.ThinPlate =
    static_cast<float>(std::max(level.Dense ? options.DenseThinPlate : options.BandThinPlate,
      SmoothingThinPlate * relative * relative * relative));
  const BrickOperator<Dim> system(bricks[l], rows, fairing, threads);

  LevelReport report;
  report.Spacing = level.Grid.Spacing.maxCoeff();
  report.NumberOfRows = static_cast<std::int64_t>(rows.Rows.size());
  report.NumberOfActiveCoefficients = bricks[l].numberOfActiveCoefficients();
  const int iterations = finest ? options.FinestIterations
    : level.Dense               ? options.DenseIterations
                                : options.BandIterations;
  const double tolerance = finest ? options.FinestTolerance
    : level.Dense                 ? options.DenseTolerance
                                  : options.BandTolerance;
  solveLevel(system, bricks[l], iterations, tolerance,
    finest ? options.Rule : StoppingRule::RelativeResidual, threads, report);
  if (finest)
  {
    report.Energy = system.energy();
    std::vector<float> values;
    system.evaluate(bricks[l].coefficients(), values);
    double sum = 0, count = 0;
    for (std::size_t k = 0; k < values.size(); ++k)
    {
      const double f = level.Samples[k].IsExtra ? 0.0 : values[k];
      sum += f * f;
      count += !level.Samples[k].IsExtra;
      report.MaximumError = std::max(report.MaximumError, std::abs(f));
    }
    report.AverageError = count > 0 ? sum / count : 0;
  }
  report.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

/// f and its gradient at samples, (1 + Dim) values each, by a level that covers them.
template <int Dim>
std::vector<float> evaluateLevel(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  std::vector<Sample<Dim>> samples, int threads)
{
  Level<Dim> atSamples{ level.Coarsening, level.Grid, level.Dense, std::move(samples) };
  const HermiteRows<Dim> rows = makeRows(atSamples, bricks, 0);
  std::vector<float> values;
  BrickOperator<Dim>(bricks, rows, {}, threads).evaluateWithGradient(bricks.coefficients(), values);
  for (std::size_t k = 0; k < rows.Rows.size(); ++k)
  {
    for (int a = 0; a < Dim; ++a)
    {
      values[k * (1 + Dim) + 1 + static_cast<std::size_t>(a)] /=
        static_cast<float>(level.Grid.Spacing[a]);
    }
  }
  return values;
}

/// The root mean square distance of the points from the zero set, in knot spacings.
template <int Dim>
double noiseOf(const Level<Dim>& level, const BrickLattice<Dim>& bricks,
  const std::vector<Sample<Dim>>& points, int threads)
{
  const std::vector<float> values = evaluateLevel(level, bricks, points, threads);
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    if (points[k].HasNormal)
    {
      const Eigen::Map<const Eigen::Matrix<float, Dim, 1>> slope(&values[k * (1 + Dim) + 1]);
      const double distance =
        values[k * (1 + Dim)] / std::max(static_cast<double>(slope.norm()), LeastSlope);
      sum += distance * distance;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) / level.Grid.Spacing.mean() : 0;
}

/// The smoothing length that predicts the normals of held-out points best.
template <int Dim>
double validatedSmoothing(const std::vector<Level<Dim>>& levels,
  const std::vector<BrickLattice<Dim>>& bricks, const HierarchicalOptions& options, int threads)
{
  std::vector<Sample<Dim>> kept, heldOut;
  std::int64_t index = 0;
  for (const Sample<Dim>& sample : levels.back().Samples)
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
    training[l] = { levels[l].Coarsening, levels[l].Grid, levels[l].Dense, {} };
    training[l].Samples = l + 1 == levels.size()
      ? std::move(kept)
      : cluster(training[l + 1].Samples, levels[l].Coarsening);
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
      solveOne(training, scratch, l, length, quick, threads);
    }
    const std::vector<float> values =
      evaluateLevel(training[last], scratch[last], heldOut, threads);
    double sum = 0;
    for (std::size_t k = 0; k < heldOut.size(); ++k)
    {
      const Eigen::Map<const Eigen::Matrix<float, Dim, 1>> slope(&values[k * (1 + Dim) + 1]);
      sum += std::min(
        (slope.template cast<double>() - heldOut[k].Normal).squaredNorm(), MostNormalError);
    }
    return std::sqrt(sum / static_cast<double>(heldOut.size()));
  };
  const double spacing = levels[last].Grid.Spacing.mean() *
    std::pow(static_cast<double>(levels.back().Samples.size()) / occupiedCells(levels[last]),
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
HierarchicalResult<Dim> fitHierarchical(const Lattice<Dim>& lattice, const HermiteInput<Dim>& input,
  const HierarchicalOptions& options, const ProgressCallback& progress)
{
  const int threads = resolveThreads(options.Threads);
  HierarchicalResult<Dim> result;
  const std::vector<Level<Dim>> levels =
    makeLevels(lattice, sortedSamples(lattice, input), options);
  std::vector<BrickLattice<Dim>> bricks = makeBricks(levels);

  // The finest level that the points alone determine tells how noisy they are.
  std::size_t gate = levels.size();
  const auto n = static_cast<double>(levels.back().Samples.size());
  for (std::size_t l = 0; l < levels.size() && options.SmoothingLength < 0; ++l)
  {
    if (n >= PointsPerDeterminedCell * occupiedCells(levels[l]))
    {
      gate = l;
    }
  }
  result.SmoothingLength = std::max(options.SmoothingLength, 0.0);
  for (std::size_t l = 0; l < levels.size(); ++l)
  {
    if (progress && !progress(static_cast<double>(l) / static_cast<double>(levels.size())))
    {
      result.Aborted = true;
      return result;
    }
    result.Reports.push_back(solveOne(levels, bricks, l, result.SmoothingLength, options, threads));
    if (l == gate || l + 1 == gate)
    {
      const double before = result.Noise * (l > 0 ? levels[l - 1].Grid.Spacing.mean() : 0);
      result.Noise = noiseOf(levels[l], bricks[l], levels.back().Samples, threads);
      if (l + 1 == gate)
      {
        continue;
      }
      gate = levels.size();
      if (result.Noise > NoiseGate &&
        result.Noise * levels[l].Grid.Spacing.mean() > NoiseFall * before)
      {
        result.SmoothingLength = validatedSmoothing(levels, bricks, options, threads);
      }
      if (result.SmoothingLength > 0)
      {
        // Start again, with smoothing on all levels.
        result.Reports.clear();
        l = static_cast<std::size_t>(-1);
      }
    }
  }
  result.Function = std::make_shared<const BrickSpline<Dim>>(std::move(bricks));
  return result;
}

template HierarchicalResult<2> fitHierarchical<2>(
  const Lattice<2>&, const HermiteInput<2>&, const HierarchicalOptions&, const ProgressCallback&);
template HierarchicalResult<3> fitHierarchical<3>(
  const Lattice<3>&, const HermiteInput<3>&, const HierarchicalOptions&, const ProgressCallback&);
}
