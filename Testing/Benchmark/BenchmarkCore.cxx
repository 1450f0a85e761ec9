// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a sweep over the rows and a sample of f cost, against what the machine can do.
 *
 * Counters are medians. Times that are compared are taken in turn, so that both meet the same
 * disturbances. Bounds that the project keeps stand in the labels.
 */
#include "CollocationOperator.h"
#include "Dispatch.h"
#include "ImplicitSpline.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <vector>

namespace
{
using namespace ipia;

/// Coefficients per axis of the lattice that all benchmarks use.
constexpr std::int64_t LatticeSize = 70;

/// Samples per axis of the image.
constexpr std::int64_t ImageSize = 256;

/// Multiply-adds that a row needs: gather and scatter one axis at a time, the basis by Horner's
/// rule.
constexpr double MultiplyAddsPerRow = (64 + 16 + 4) + (4 + 16 + 64) + 3 * 4 * 3;

template <typename Action>
double seconds(const Action& action)
{
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Independent multiply-adds without memory, enough of them in flight to fill the pipelines.
struct MultiplyAddKernel
{
  static constexpr int Chains = 12;
  static constexpr int Steps = 20000;

  static IPIA_INLINE void run(double factor, double& result)
  {
    Vector8 chain[Chains];
    for (int i = 0; i < Chains; ++i)
    {
      chain[i] = Vector8{} + i;
    }
    const Vector8 a = Vector8{} + factor, b = Vector8{} + 1e-9;
    for (int step = 0; step < Steps; ++step)
    {
      for (int i = 0; i < Chains; ++i)
      {
        chain[i] = chain[i] * a + b;
      }
    }
    Vector8 sum = chain[0];
    for (int i = 1; i < Chains; ++i)
    {
      sum += chain[i];
    }
    result = sum[0] + sum[7];
  }
};

/// Multiply-adds of doubles per second that one thread does with the instruction set in use.
double multiplyAddRate()
{
  static const double rate = []
  {
    std::vector<double> times;
    for (int k = 0; k < 51; ++k)
    {
      double result = 0;
      times.push_back(seconds(
        [&]
        {
          dispatch<MultiplyAddKernel>(0.999, result);
          benchmark::DoNotOptimize(result);
        }));
    }
    return 8.0 * MultiplyAddKernel::Chains * MultiplyAddKernel::Steps / median(times);
  }();
  return rate;
}

Lattice<3> cubeLattice()
{
  Lattice<3> lattice;
  lattice.Size.fill(LatticeSize);
  lattice.Spacing.setConstant(1);
  return lattice;
}

Vector randomCoefficients(const Lattice<3>& lattice)
{
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector c(lattice.numberOfCoefficients());
  for (double& value : c)
  {
    value = uniform(engine);
  }
  return c;
}

/// The given number of rows in each knot cell of a band around a sphere, in random order.
ConstraintRows<3> sphereBand(int rowsPerCell)
{
  const Lattice<3> lattice = cubeLattice();
  const double middle = lattice.extent(0) / 2, radius = 0.4 * lattice.extent(0);
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Point<3>> points;
  for (std::int64_t c = 0; c < lattice.numberOfCells(); ++c)
  {
    const std::int64_t n = lattice.cells(0);
    const Point<3> lower(
      static_cast<double>(c % n), static_cast<double>(c / n % n), static_cast<double>(c / n / n));
    const double distance = (lower.array() + 0.5 - middle).matrix().norm() - radius;
    for (int k = 0; k < rowsPerCell && std::abs(distance) < 1.5; ++k)
    {
      points.emplace_back(
        lower.x() + uniform(engine), lower.y() + uniform(engine), lower.z() + uniform(engine));
    }
  }
  std::shuffle(points.begin(), points.end(), engine);
  Points<3> positions(3, points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    positions.col(static_cast<Eigen::Index>(k)) = points[k];
  }
  return { lattice, positions, Vector::Ones(positions.cols()), Vector() };
}

/// CollocationOperator::residual, once with one thread and once with two in turn.
void sweep(benchmark::State& state)
{
  const ConstraintRows<3> rows = sphereBand(static_cast<int>(state.range(0)));
  const CollocationOperator<3> one(rows, 1), two(rows, 2);
  const Vector c = randomCoefficients(rows.lattice());
  Vector gradient;
  one.residual(c, gradient);
  std::vector<double> onOne, onTwo;
  for (auto unused : state)
  {
    onOne.push_back(seconds([&] { one.residual(c, gradient); }));
    onTwo.push_back(seconds([&] { two.residual(c, gradient); }));
    state.SetIterationTime(onOne.back());
  }
  const double perRow = median(onOne) / static_cast<double>(rows.size());
  state.counters["rows"] = static_cast<double>(rows.size());
  state.counters["ns/row"] = 1e9 * perRow;
  state.counters["ns/row on 2"] = 1e9 * median(onTwo) / static_cast<double>(rows.size());
  state.counters["speed-up on 2"] = median(onOne) / median(onTwo);
  state.counters["share of multiply-add rate"] = MultiplyAddsPerRow / perRow / multiplyAddRate();
  state.counters["GB/s of rows"] = 1e-9 * sizeof(ConstraintRow<3>) / perRow;
  state.SetLabel(
    state.range(0) >= 50 ? "bounds: 25 ns/row, speed-up 1.7" : "bounds: 40 ns/row, speed-up 1.7");
}
BENCHMARK(sweep)->Arg(5)->Arg(50)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(2);

/// A float image of f on one thread against filling the same memory, in turn.
void sample(benchmark::State& state)
{
  const Lattice<3> lattice = cubeLattice();
  const ImplicitSpline<3> function(lattice, randomCoefficients(lattice));
  AxisPositions<3> positions;
  for (int a = 0; a < 3; ++a)
  {
    for (std::int64_t k = 0; k < ImageSize; ++k)
    {
      positions[a].push_back(
        lattice.extent(a) * static_cast<double>(k) / static_cast<double>(ImageSize - 1));
    }
  }
  std::vector<float> image(ImageSize * ImageSize * ImageSize, 1.0f);
  std::vector<double> fills, samples;
  for (auto unused : state)
  {
    fills.push_back(seconds(
      [&]
      {
        std::fill(image.begin(), image.end(), static_cast<float>(fills.size()));
        benchmark::ClobberMemory();
      }));
    samples.push_back(seconds([&] { function.sample(positions, image.data(), 1); }));
    state.SetIterationTime(samples.back());
  }
  state.counters["ns/sample"] = 1e9 * median(samples) / static_cast<double>(image.size());
  state.counters["fill ms"] = 1e3 * median(fills);
  state.counters["times filling"] = median(samples) / median(fills);
  state.SetLabel("bound: 3 times filling");
}
BENCHMARK(sample)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(2);

void machineMultiplyAdds(benchmark::State& state)
{
  double result = 0;
  for (auto unused : state)
  {
    dispatch<MultiplyAddKernel>(0.999, result);
    benchmark::DoNotOptimize(result);
  }
  state.counters["1e9 multiply-adds/s"] = 1e-9 * multiplyAddRate();
}
BENCHMARK(machineMultiplyAdds)->Unit(benchmark::kMicrosecond);

/// a = b + s c on arrays that no cache holds, one thread; three arrays are moved.
void machineMemory(benchmark::State& state)
{
  constexpr std::size_t n = std::size_t(1) << 24;
  std::vector<double> a(n, 0), b(n, 1), c(n, 2);
  std::vector<double> times;
  for (auto unused : state)
  {
    times.push_back(seconds(
      [&]
      {
        for (std::size_t i = 0; i < n; ++i)
        {
          a[i] = b[i] + 0.5 * c[i];
        }
        benchmark::ClobberMemory();
      }));
    state.SetIterationTime(times.back());
  }
  state.counters["GB/s"] = 1e-9 * 3 * sizeof(double) * static_cast<double>(n) / median(times);
}
BENCHMARK(machineMemory)->UseManualTime()->Unit(benchmark::kMillisecond);
}
