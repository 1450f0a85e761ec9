// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a sweep over the rows and a sample of f cost, against what the machine can do.
 *
 * Counters are medians. Times that are compared are taken in turn, so that both meet the same
 * disturbances. Bounds that the project keeps stand in the labels.
 */
#include "BrickOperator.h"
#include "CollocationOperator.h"
#include "Dispatch.h"
#include "ImplicitSpline.h"
#include "RationalSolver.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
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

/// The same of a row with its gradient. Per direction the coefficients meet two functions of z,
/// what is left three pairs of functions of z and y, then four of all axes; a slope takes two more
/// steps of Horner's rule.
constexpr double MultiplyAddsPerHermiteRow = 2 * (2 * 64 + 3 * 16 + 4 * 4) + 3 * 4 * (3 + 2);

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

using FloatVector16 = float __attribute__((vector_size(64)));

/// Independent multiply-adds without memory, enough of them in flight to fill the pipelines.
template <typename Scalar, typename Vectors>
struct MultiplyAddKernel
{
  static constexpr int Chains = 12;
  static constexpr int Steps = 20000;
  static constexpr double Count = sizeof(Vectors) / sizeof(Scalar) * Chains * Steps;

  static IPIA_INLINE void run(Scalar factor, Scalar& result)
  {
    Vectors chain[Chains];
    for (int i = 0; i < Chains; ++i)
    {
      chain[i] = Vectors{} + static_cast<Scalar>(i);
    }
    const Vectors a = Vectors{} + factor, b = Vectors{} + static_cast<Scalar>(1e-9);
    for (int step = 0; step < Steps; ++step)
    {
      for (int i = 0; i < Chains; ++i)
      {
        chain[i] = chain[i] * a + b;
      }
    }
    Vectors sum = chain[0];
    for (int i = 1; i < Chains; ++i)
    {
      sum += chain[i];
    }
    result = sum[0] + sum[7];
  }
};

/// Multiply-adds per second that one thread does with the instruction set in use.
template <typename Scalar, typename Vectors>
double multiplyAddRate()
{
  static const double rate = []
  {
    using Kernel = MultiplyAddKernel<Scalar, Vectors>;
    std::vector<double> times;
    for (int k = 0; k < 51; ++k)
    {
      Scalar factor = static_cast<Scalar>(0.999), result = 0;
      times.push_back(seconds(
        [&]
        {
          dispatch<Kernel>(factor, result);
          benchmark::DoNotOptimize(result);
        }));
    }
    return Kernel::Count / median(times);
  }();
  return rate;
}

double doubleMultiplyAddRate()
{
  return multiplyAddRate<double, Vector8>();
}

double floatMultiplyAddRate()
{
  return multiplyAddRate<float, FloatVector16>();
}

/// Bytes per second of a = b + s c on arrays that no cache holds, one thread; three are moved.
double memoryRate()
{
  static const double rate = []
  {
    constexpr std::size_t n = std::size_t(1) << 24;
    std::vector<double> a(n, 0), b(n, 1), c(n, 2), times;
    for (int k = 0; k < 11; ++k)
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
    }
    return 3 * sizeof(double) * static_cast<double>(n) / median(times);
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

/// Calls action(corner of the cell, position) for the given number of random positions in each knot
/// cell of a band around a sphere.
template <typename Action>
void forSphereBand(int rowsPerCell, const Action& action)
{
  const Lattice<3> lattice = cubeLattice();
  const double middle = lattice.extent(0) / 2, radius = 0.4 * lattice.extent(0);
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (std::int64_t c = 0; c < lattice.numberOfCells(); ++c)
  {
    const std::int64_t n = lattice.cells(0);
    const Index<3> cell{ c % n, c / n % n, c / n / n };
    const Point<3> lower(
      static_cast<double>(cell[0]), static_cast<double>(cell[1]), static_cast<double>(cell[2]));
    const double distance = (lower.array() + 0.5 - middle).matrix().norm() - radius;
    for (int k = 0; k < rowsPerCell && std::abs(distance) < 1.5; ++k)
    {
      action(cell,
        Point<3>(
          lower.x() + uniform(engine), lower.y() + uniform(engine), lower.z() + uniform(engine)));
    }
  }
}

/// Rows with the distance from the sphere as value, in random order.
ConstraintRows<3> sphereBand(int rowsPerCell)
{
  std::vector<Point<3>> points;
  forSphereBand(rowsPerCell, [&](const Index<3>&, const Point<3>& x) { points.push_back(x); });
  std::mt19937_64 engine(3);
  std::shuffle(points.begin(), points.end(), engine);
  Points<3> positions(3, points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    positions.col(static_cast<Eigen::Index>(k)) = points[k];
  }
  const double middle = cubeLattice().extent(0) / 2;
  const Vector distances =
    (positions.array() - middle).matrix().colwise().norm().transpose().array() - 0.8 * middle;
  return { cubeLattice(), positions, distances, Vector() };
}

/// Rows with values and gradients on the band of one level, sorted as they have to be.
class HermiteBand
{
public:
  BrickLattice<3> Bricks{ cubeLattice() };
  HermiteRows<3> Rows;

  explicit HermiteBand(int rowsPerCell)
  {
    std::map<Index<3>, std::vector<HermiteRow<3>>> byBrick;
    forSphereBand(rowsPerCell,
      [&](const Index<3>& cell, const Point<3>& x)
      {
        HermiteRow<3> row{};
        Index<3> brick;
        for (int a = 0; a < 3; ++a)
        {
          brick[a] = cell[a] / BrickWidth;
          row.Cell |= static_cast<std::int32_t>(cell[a] % BrickWidth) << (2 * a);
          row.T[a] = static_cast<float>(x[a] - static_cast<double>(cell[a]));
          row.Slope[a] = 0.5F;
        }
        row.Weight = row.GradientWeight = 1;
        byBrick[brick].push_back(row);
        this->Bricks.activateAround(cell);
      });
    this->Bricks.storeAroundActive();
    this->Bricks.allocate();
    for (std::size_t colour = 0; colour < HermiteRows<3>::NumberOfColours; ++colour)
    {
      this->Rows.ColourBegin[colour] = this->Rows.Bricks.size();
      for (auto& [brick, rows] : byBrick)
      {
        const auto parity = (brick[0] & 1) | (brick[1] & 1) << 1 | (brick[2] & 1) << 2;
        if (static_cast<std::size_t>(parity) == colour)
        {
          std::stable_sort(
            rows.begin(), rows.end(), [](const auto& p, const auto& q) { return p.Cell < q.Cell; });
          const auto begin = static_cast<std::int64_t>(this->Rows.Rows.size());
          this->Rows.Rows.insert(this->Rows.Rows.end(), rows.begin(), rows.end());
          this->Rows.Bricks.push_back({ this->Bricks.brickAt(brick), begin,
            static_cast<std::int64_t>(this->Rows.Rows.size()) });
        }
      }
    }
    this->Rows.ColourBegin.back() = this->Rows.Bricks.size();
  }
};

/// What the sweeps report: medians of times on one thread and on two.
void countSweep(benchmark::State& state, const std::vector<double>& onOne,
  const std::vector<double>& onTwo, double rows, double multiplyAdds, double multiplyAddRate,
  double bytes)
{
  const double perRow = median(onOne) / rows;
  state.counters["rows"] = rows;
  state.counters["ns/row"] = 1e9 * perRow;
  state.counters["ns/row on 2"] = 1e9 * median(onTwo) / rows;
  state.counters["speed-up on 2"] = median(onOne) / median(onTwo);
  state.counters["share of multiply-add rate"] = multiplyAdds / perRow / multiplyAddRate;
  state.counters["share of memory rate"] = bytes / perRow / memoryRate();
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
  countSweep(state, onOne, onTwo, static_cast<double>(rows.size()), MultiplyAddsPerRow,
    doubleMultiplyAddRate(), sizeof(ConstraintRow<3>));
  state.SetLabel(
    state.range(0) >= 50 ? "bounds: 25 ns/row, speed-up 1.7" : "bounds: 40 ns/row, speed-up 1.7");
}
BENCHMARK(sweep)->Arg(5)->Arg(50)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(2);

/// An iteration of solveRational against one of solveLeastSquares on the same rows, one thread, in
/// turn; what goes before the first iteration is in both.
void rationalIteration(benchmark::State& state)
{
  const ConstraintRows<3> rows = sphereBand(static_cast<int>(state.range(0)));
  const CollocationOperator<3> collocation(rows, 1);
  SolverOptions options;
  options.MaximumNumberOfIterations = state.range(0) >= 50 ? 10 : 50;
  RationalOptions rational;
  rational.WeightStepSize = 1e-3;
  std::vector<double> splines, rationals, ratios;
  for (auto unused : state)
  {
    Vector c = Vector::Zero(rows.lattice().numberOfCoefficients()), d = c;
    splines.push_back(seconds([&] { solveLeastSquares(collocation, options, c); }));
    rationals.push_back(seconds([&] { solveRational(rows, options, rational, 1, d); }));
    ratios.push_back(rationals.back() / splines.back());
    state.SetIterationTime(rationals.back());
  }
  const double scale = 1e9 / static_cast<double>(rows.size()) / options.MaximumNumberOfIterations;
  state.counters["rows"] = static_cast<double>(rows.size());
  state.counters["ns/row, B-spline"] = scale * median(splines);
  state.counters["ns/row, rational"] = scale * median(rationals);
  state.counters["times B-spline"] = median(ratios);
  state.SetLabel("bound at 50 rows a cell: 2.5 times B-spline");
}
BENCHMARK(rationalIteration)
  ->Arg(5)
  ->Arg(50)
  ->UseManualTime()
  ->Unit(benchmark::kMillisecond)
  ->MinTime(2);

/// BrickOperator::product, a row's value and gradient together, without fairing; once with one
/// thread and once with two in turn.
void hermiteSweep(benchmark::State& state)
{
  const HermiteBand band(static_cast<int>(state.range(0)));
  const BrickOperator<3> one(band.Bricks, band.Rows, {}, 1), two(band.Bricks, band.Rows, {}, 2);
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  BrickValues p(static_cast<std::size_t>(band.Bricks.numberOfActiveBricks()) * BrickSize<3>);
  for (float& value : p)
  {
    value = uniform(engine);
  }
  BrickValues product;
  std::vector<double> onOne, onTwo;
  for (auto unused : state)
  {
    onOne.push_back(seconds([&] { one.product(p, product); }));
    onTwo.push_back(seconds([&] { two.product(p, product); }));
    state.SetIterationTime(onOne.back());
  }
  countSweep(state, onOne, onTwo, static_cast<double>(band.Rows.Rows.size()),
    MultiplyAddsPerHermiteRow, floatMultiplyAddRate(), sizeof(HermiteRow<3>));
  state.SetLabel("bound at 5 rows a cell: 15 ns/row");
}
BENCHMARK(hermiteSweep)
  ->Arg(5)
  ->Arg(50)
  ->UseManualTime()
  ->Unit(benchmark::kMillisecond)
  ->MinTime(2);

/// Constants but for a band of 3.5 cells to either side of a sphere, as a classic fit has them.
FarField farFieldOfSphere(const Lattice<3>& lattice)
{
  FarField far;
  far.Magnitude = 1;
  const std::int64_t n = lattice.boxes(0);
  const double middle = static_cast<double>(n - 1) / 2, radius = 0.7 * middle;
  for (std::int64_t b = 0; b < n * n * n; ++b)
  {
    const Point<3> box(static_cast<double>(b % n), static_cast<double>(b / n % n),
      static_cast<double>(b / n / n)); // two boxes a cell
    const double distance = (box.array() - middle).matrix().norm() - radius;
    far.Sign.push_back(std::abs(distance) < 7 ? 0 : (distance > 0 ? 1 : -1));
  }
  return far;
}

/// A float image of f on one thread against filling the same memory, in turn; with 1 with a far
/// field.
void sample(benchmark::State& state)
{
  const Lattice<3> lattice = cubeLattice();
  const ImplicitSpline<3> function(lattice, randomCoefficients(lattice),
    state.range(0) == 1 ? farFieldOfSphere(lattice) : FarField{});
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
BENCHMARK(sample)->Arg(0)->Arg(1)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(2);

/// The rates of the machine that the shares above refer to.
void machine(benchmark::State& state)
{
  for (auto unused : state)
  {
    state.counters["1e9 multiply-adds/s, double"] = 1e-9 * doubleMultiplyAddRate();
    state.counters["1e9 multiply-adds/s, float"] = 1e-9 * floatMultiplyAddRate();
    state.counters["memory, GB/s"] = 1e-9 * memoryRate();
  }
}
BENCHMARK(machine)->Iterations(1);
}
