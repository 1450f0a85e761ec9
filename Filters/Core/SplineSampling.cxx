// SPDX-License-Identifier: BSD-3-Clause
#include "SplineSampling.h"

#include "Dispatch.h"
#include "Parallel.h"
#include "SampleGrid.h"

#include <atomic>

namespace ipia
{
namespace
{
/// A block of samples: some rows of y, some slices of z, all of x. In 2-D there is one slice.
struct SampleBlock
{
  std::int64_t FirstY, LastY, FirstZ, LastZ;
};

/// Number of sample rows and slices of a block; the expanded rows of four slices fit the cache.
constexpr std::int64_t BlockRows = 16;
constexpr std::int64_t BlockSlices = 64;

/// Neighbouring samples along y or z that share what they load.
constexpr std::int64_t GroupSize = 4;

/**
 * Samples of a block. All arithmetic is on whole vectors, past the end of a row too, so that a
 * sample has the same bits whatever its neighbours are.
 */
template <int Dim, typename Scalar>
struct SampleKernel
{
  using Grid = SampleGrid<Dim>;

  /// The end of the group that begins with sample @a i: up to GroupSize of one cell, and on
  /// request one box.
  static std::int64_t groupEnd(
    const AxisTable& table, std::int64_t i, std::int64_t last, bool oneBox = false)
  {
    const auto at = [](const std::vector<std::int64_t>& v, std::int64_t k)
    { return v[static_cast<std::size_t>(k)]; };
    std::int64_t end = i + 1;
    while (end < std::min(last, i + GroupSize) && at(table.Cell, end) == at(table.Cell, i) &&
      (!oneBox || at(table.Box, end) == at(table.Box, i)))
    {
      ++end;
    }
    return end;
  }

  /// Room for a row of samples and for the vector that starts at the last one.
  static std::int64_t paddedRow(const Grid& grid)
  {
    return (grid.X.size() + 2 * Lanes - 2) / Lanes * Lanes;
  }

  static IPIA_INLINE void load(const double* from, Vector8& v) { std::memcpy(&v, from, sizeof(v)); }

  static IPIA_INLINE void store(const Vector8& v, double* to) { std::memcpy(to, &v, sizeof(v)); }

  static IPIA_INLINE void store(const Vector8& v, float* to)
  {
    const FloatVector8 rounded = __builtin_convertvector(v, FloatVector8);
    std::memcpy(to, &rounded, sizeof(rounded));
  }

  /// sum = sum_k factors[k] v[k]
  template <int Count>
  static IPIA_INLINE void combine(const double* factors, const Vector8 (&v)[Count], Vector8& sum)
  {
    sum = factors[0] * v[0];
    for (int k = 1; k < Count; ++k)
    {
      sum += factors[k] * v[k];
    }
  }

  /// Count lines, out[i * stride + x] = sum_k weights[i][k] in[k][x] for x in [begin, end).
  template <int Count, std::size_t Terms, typename Out>
  static IPIA_INLINE void combineLines(const std::array<const double*, Terms>& in,
    const BasisValues* weights, std::int64_t begin, std::int64_t end, Out* out, std::int64_t stride)
  {
    Vector8 v[Terms], sum;
    if (end - begin < Lanes)
    {
      std::array<Out, Lanes> lanes;
      for (std::size_t k = 0; k < Terms; ++k)
      {
        load(in[k] + begin, v[k]);
      }
      for (int i = 0; i < Count; ++i)
      {
        combine(weights[i].data(), v, sum);
        store(sum, lanes.data());
        std::copy(lanes.begin(), lanes.begin() + (end - begin), out + i * stride + begin);
      }
      return;
    }
    for (std::int64_t next = begin; next < end; next += Lanes)
    {
      // The last vector may overlap the one before, with the same values.
      const std::int64_t x = std::min(next, end - Lanes);
      for (std::size_t k = 0; k < Terms; ++k)
      {
        load(in[k] + x, v[k]);
      }
      for (int i = 0; i < Count; ++i)
      {
        combine(weights[i].data(), v, sum);
        store(sum, out + i * stride + x);
      }
    }
  }

  /// The same for 1 to GroupSize lines.
  template <std::size_t Terms, typename Out>
  static IPIA_INLINE void combineGroup(std::int64_t count,
    const std::array<const double*, Terms>& in, const BasisValues* weights, std::int64_t begin,
    std::int64_t end, Out* out, std::int64_t stride)
  {
    switch (count)
    {
      case 4:
        combineLines<4>(in, weights, begin, end, out, stride);
        break;
      case 3:
        combineLines<3>(in, weights, begin, end, out, stride);
        break;
      case 2:
        combineLines<2>(in, weights, begin, end, out, stride);
        break;
      default:
        combineLines<1>(in, weights, begin, end, out, stride);
    }
  }

  /// Slice k of the coefficients, expanded to the samples of the block along x and y, in whole
  /// vectors that cover [beginX, endX) along x.
  static IPIA_INLINE void expandSlice(const Grid& grid, const SampleBlock& block,
    std::int64_t slice, std::int64_t beginX, std::int64_t endX, std::vector<double>& alongX,
    double* expanded)
  {
    beginX = beginX / Lanes * Lanes;
    endX = (endX + Lanes - 1) / Lanes * Lanes;
    const std::int64_t n = paddedRow(grid);
    const std::int64_t firstRow = grid.Y.Cell[static_cast<std::size_t>(block.FirstY)];
    const std::int64_t lastRow = grid.Y.Cell[static_cast<std::size_t>(block.LastY - 1)] + Order;
    const auto& size = grid.ControlLattice.Size;
    std::array<const double*, Order> weight;
    for (std::size_t j = 0; j < Order; ++j)
    {
      weight[j] = grid.Row.Weight[j].data();
    }
    alongX.resize(static_cast<std::size_t>((lastRow - firstRow) * n));
    Vector8 v[Order], sum;
    for (const SampleRow::CellRun& run : grid.Row.Cells)
    {
      if (run.End <= beginX || run.Begin >= endX)
      {
        continue;
      }
      const double* c = grid.Coefficients + (slice * size[1] + firstRow) * size[0] + run.Cell;
      for (std::int64_t x = run.Begin; x < run.End; x += Lanes)
      {
        for (std::size_t j = 0; j < Order; ++j)
        {
          load(weight[j] + x, v[j]);
        }
        // What a vector holds beyond its cell is overwritten by the next one.
        double* out = alongX.data() + x;
        for (std::int64_t row = 0; row < lastRow - firstRow; ++row)
        {
          combine(c + row * size[0], v, sum);
          store(sum, out + row * n);
        }
      }
    }
    std::int64_t next = block.FirstY;
    for (std::int64_t y = block.FirstY; y < block.LastY; y = next)
    {
      next = groupEnd(grid.Y, y, block.LastY);
      std::array<const double*, Order> in;
      for (std::size_t j = 0; j < Order; ++j)
      {
        in[j] = alongX.data() +
          (grid.Y.Cell[static_cast<std::size_t>(y)] - firstRow + static_cast<std::int64_t>(j)) * n;
      }
      combineGroup(
        next - y, in, grid.Y.Weight.data() + y, beginX, endX, expanded + (y - block.FirstY) * n, n);
    }
  }

  /// The samples along x that the spline is asked for, by knot cells of z from the block's first.
  static std::vector<typename Grid::Run> splineSpans(const Grid& grid, const SampleBlock& block)
  {
    const auto cellOf = [&](std::int64_t z) { return grid.Z.Cell[static_cast<std::size_t>(z)]; };
    const std::int64_t firstCell = cellOf(block.FirstZ);
    std::vector<typename Grid::Run> spans(
      static_cast<std::size_t>(cellOf(block.LastZ - 1) - firstCell + 1), { grid.X.size(), 0, 0 });
    const bool far = !grid.Far.Sign.empty();
    std::int64_t next = block.FirstZ;
    for (std::int64_t z = block.FirstZ; z < block.LastZ; z = next)
    {
      next = groupEnd(grid.Z, z, block.LastZ, far);
      auto& span = spans[static_cast<std::size_t>(cellOf(z) - firstCell)];
      for (std::int64_t y = block.FirstY; y < block.LastY; ++y)
      {
        const auto ofRow = grid.splineSpan(grid.boxRow(y, z));
        span.Begin = std::min(span.Begin, ofRow.Begin);
        span.End = std::max(span.End, ofRow.End);
      }
    }
    return spans;
  }

  static IPIA_INLINE void run(const Grid& grid, const SampleBlock& block, Scalar* values)
  {
    const std::int64_t n = grid.X.size(), rows = grid.Y.size(), padded = paddedRow(grid);
    const std::int64_t sliceSize = (block.LastY - block.FirstY) * padded;
    const std::int64_t firstCell = grid.Z.Cell[static_cast<std::size_t>(block.FirstZ)];
    const std::vector<typename Grid::Run> spans = splineSpans(grid, block);
    std::vector<double> alongX, window(static_cast<std::size_t>(Grid::Slices * sliceSize));
    std::array<std::int64_t, Grid::Slices> held;
    held.fill(-1);
    const bool far = !grid.Far.Sign.empty();
    std::int64_t next = block.FirstZ;
    for (std::int64_t z = block.FirstZ; z < block.LastZ; z = next)
    {
      const std::int64_t cell = grid.Z.Cell[static_cast<std::size_t>(z)];
      next = groupEnd(grid.Z, z, block.LastZ, far);
      if (spans[static_cast<std::size_t>(cell - firstCell)].End == 0)
      {
        continue;
      }
      std::array<const double*, Grid::Slices> slices{};
      for (std::int64_t k = 0; k < Grid::Slices; ++k)
      {
        const auto slot = static_cast<std::size_t>((cell + k) % Grid::Slices);
        double* expanded = window.data() + static_cast<std::int64_t>(slot) * sliceSize;
        if (held[slot] != cell + k)
        {
          // The cells from this one on that the slice reaches.
          auto span = spans[static_cast<std::size_t>(cell - firstCell)];
          const auto last = std::min<std::int64_t>(
            cell - firstCell + k, static_cast<std::int64_t>(spans.size()) - 1);
          for (std::int64_t c = cell - firstCell + 1; c <= last; ++c)
          {
            span.Begin = std::min(span.Begin, spans[static_cast<std::size_t>(c)].Begin);
            span.End = std::max(span.End, spans[static_cast<std::size_t>(c)].End);
          }
          expandSlice(grid, block, cell + k, span.Begin, span.End, alongX, expanded);
          held[slot] = cell + k;
        }
        slices[static_cast<std::size_t>(k)] = expanded;
      }
      for (std::int64_t y = block.FirstY; y < block.LastY; ++y)
      {
        const std::size_t row = grid.boxRow(y, z);
        for (std::size_t r = grid.RunBegin[row]; r < grid.RunBegin[row + 1]; ++r)
        {
          const auto& part = grid.Runs[r];
          // An empty run at the end of a row would load past its padding.
          if (part.Sign == 0 && part.Begin < part.End)
          {
            std::array<const double*, Grid::Slices> in;
            for (std::size_t k = 0; k < Grid::Slices; ++k)
            {
              in[k] = slices[k] + (y - block.FirstY) * padded;
            }
            combineGroup(next - z, in, grid.Z.Weight.data() + z, part.Begin, part.End,
              values + (z * rows + y) * n, rows * n);
          }
        }
      }
    }
  }
};

/// The constants of the far field in the slices [first, last), in the order of memory.
template <int Dim, typename Scalar>
struct ConstantKernel
{
  static IPIA_INLINE void run(
    const SampleGrid<Dim>& grid, std::int64_t first, std::int64_t last, Scalar* values)
  {
    const std::int64_t n = grid.X.size(), rows = grid.Y.size();
    for (std::int64_t z = first; z < last; ++z)
    {
      for (std::int64_t y = 0; y < rows; ++y)
      {
        const std::size_t row = grid.boxRow(y, z);
        Scalar* const out = values + (z * rows + y) * n;
        for (std::size_t r = grid.RunBegin[row]; r < grid.RunBegin[row + 1]; ++r)
        {
          const auto& part = grid.Runs[r];
          if (part.Sign != 0)
          {
            const double constant = grid.Constants[part.Sign > 0 ? 1 : 0];
            fill(out + part.Begin, out + part.End, static_cast<Scalar>(constant));
          }
        }
      }
    }
  }

  static IPIA_INLINE void fill(Scalar* begin, Scalar* end, Scalar value)
  {
    constexpr std::ptrdiff_t width = 64 / sizeof(Scalar);
    if (end - begin < width)
    {
      std::fill(begin, end, value);
      return;
    }
    std::array<Scalar, width> wide;
    wide.fill(value);
    for (; end - begin > width; begin += width)
    {
      std::memcpy(begin, wide.data(), sizeof(wide));
    }
    std::memcpy(end - width, wide.data(), sizeof(wide)); // may overlap the one before
  }
};
}

template <int Dim, typename Scalar>
bool sampleSpline(const Lattice<Dim>& lattice, const Vector& coefficients, const FarField& farField,
  std::array<double, 2> constants, const AxisPositions<Dim>& positions, Scalar* values, int threads,
  int derivativeAxis, const ProgressCallback& progress)
{
  const auto table = [&](int axis)
  { return makeAxisTable(lattice, axis, positions[axis], derivativeAxis == axis); };
  const AxisTable alongX = table(0);
  SampleGrid<Dim> grid{ lattice, coefficients.data(), farField, { constants[0], constants[1] },
    alongX, table(1), { { 0 }, { 0 }, { BasisValues{ 1 } } }, SampleRow(alongX), {}, {} };
  if (Dim == 3)
  {
    grid.Z = table(Dim - 1);
  }
  grid.makeRuns();

  // A slab of slices after the other, constants first, so that what the spline overwrites is still
  // in the cache.
  const std::int64_t rows = grid.Y.size(), slices = grid.Z.size();
  std::atomic<bool> aborted{ false };
#pragma omp parallel num_threads(resolveThreads(threads))
  {
    for (std::int64_t first = 0; first < slices; first += BlockSlices)
    {
      const std::int64_t last = std::min(first + BlockSlices, slices);
      if (!farField.Sign.empty())
      {
        constexpr std::int64_t chunk = 8;
#pragma omp for
        for (std::int64_t z = first; z < last; z += chunk)
        {
          dispatch<ConstantKernel<Dim, Scalar>>(grid, z, std::min(z + chunk, last), values);
        }
      }
#pragma omp for schedule(dynamic)
      for (std::int64_t y = 0; y < rows; y += BlockRows)
      {
        if (aborted)
        {
          continue;
        }
        dispatch<SampleKernel<Dim, Scalar>>(
          grid, SampleBlock{ y, std::min(y + BlockRows, rows), first, last }, values);
        const auto done = static_cast<double>(first * rows + y * (last - first));
        if (progress && omp_get_thread_num() == 0 &&
          !progress(done / static_cast<double>(rows * slices)))
        {
          aborted = true;
        }
      }
    }
  }
  return !aborted;
}

template bool sampleSpline<2, float>(const Lattice<2>&, const Vector&, const FarField&,
  std::array<double, 2>, const AxisPositions<2>&, float*, int, int, const ProgressCallback&);
template bool sampleSpline<2, double>(const Lattice<2>&, const Vector&, const FarField&,
  std::array<double, 2>, const AxisPositions<2>&, double*, int, int, const ProgressCallback&);
template bool sampleSpline<3, float>(const Lattice<3>&, const Vector&, const FarField&,
  std::array<double, 2>, const AxisPositions<3>&, float*, int, int, const ProgressCallback&);
template bool sampleSpline<3, double>(const Lattice<3>&, const Vector&, const FarField&,
  std::array<double, 2>, const AxisPositions<3>&, double*, int, int, const ProgressCallback&);
}
