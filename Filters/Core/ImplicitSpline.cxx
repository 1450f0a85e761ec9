// SPDX-License-Identifier: BSD-3-Clause
#include "ImplicitSpline.h"

#include "CubicBasis.h"
#include "Dispatch.h"
#include "OutsideDomain.h"
#include "Parallel.h"

#include <atomic>
#include <cstring>

namespace ipia
{
namespace
{
/// Cell, box and weights of every sample position of one axis.
struct AxisTable
{
  std::vector<std::int64_t> Cell, Box;
  std::vector<BasisValues> Weight;

  std::int64_t size() const { return static_cast<std::int64_t>(this->Cell.size()); }
};

template <int Dim>
AxisTable makeAxisTable(
  const Lattice<Dim>& lattice, int axis, const std::vector<double>& positions, bool derivative)
{
  AxisTable table;
  table.Cell.reserve(positions.size());
  table.Box.reserve(positions.size());
  table.Weight.reserve(positions.size());
  for (double x : positions)
  {
    const double inside = std::min(std::max(x, 0.0), lattice.extent(axis));
    const AxisLocation at = lattice.locate(inside, axis);
    BasisValues w = cubicBasisDerivative(at.T, derivative ? 1 : 0);
    if (derivative)
    {
      for (double& v : w)
      {
        v /= lattice.Spacing[axis];
      }
    }
    table.Cell.push_back(at.Cell);
    table.Box.push_back(lattice.locateBox(inside, axis));
    table.Weight.push_back(w);
  }
  return table;
}

/// Samples that the kernels take at a time, the lanes of a vector.
constexpr std::int64_t Lanes = 8;

/// The samples along x by knot cell, and their weights one basis function after another, with room
/// for a whole vector from any sample on.
struct SampleRow
{
  struct CellRun
  {
    std::int64_t Cell, Begin, End;
  };
  std::vector<CellRun> Cells;
  std::array<std::vector<double>, Order> Weight;

  explicit SampleRow(const AxisTable& table)
  {
    for (std::int64_t x = 0; x < table.size(); ++x)
    {
      const std::int64_t cell = table.Cell[static_cast<std::size_t>(x)];
      if (this->Cells.empty() || this->Cells.back().Cell != cell)
      {
        this->Cells.push_back({ cell, x, x });
      }
      this->Cells.back().End = x + 1;
    }
    for (std::size_t j = 0; j < Order; ++j)
    {
      this->Weight[j].assign(static_cast<std::size_t>(table.size() + Lanes), 0.0);
      for (std::size_t x = 0; x < table.Weight.size(); ++x)
      {
        this->Weight[j][x] = table.Weight[x][j];
      }
    }
  }
};

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

/// All that the samples of one grid share.
template <int Dim>
struct SampleGrid
{
  static constexpr int Slices = Dim == 3 ? Order : 1;

  const Lattice<Dim>& ControlLattice;
  const double* Coefficients;
  const FarField& Far;
  double Constants[2]; ///< in boxes of sign -1 and 1
  AxisTable X, Y, Z;
  SampleRow Row;
  /// The far field by runs of samples: for each row of boxes, [begin, end) and sign of each run.
  struct Run
  {
    std::int64_t Begin, End;
    int Sign;
  };
  std::vector<Run> Runs;
  std::vector<std::size_t> RunBegin;

  /// The row of boxes that a row of samples lies in, among those that the samples reach.
  std::size_t boxRow(std::int64_t y, std::int64_t z) const
  {
    if (this->Far.Sign.empty())
    {
      return 0;
    }
    const std::int64_t rows = this->Y.Box.back() - this->Y.Box.front() + 1;
    return static_cast<std::size_t>(
      (this->Z.Box[static_cast<std::size_t>(z)] - this->Z.Box.front()) * rows +
      this->Y.Box[static_cast<std::size_t>(y)] - this->Y.Box.front());
  }

  void makeRuns()
  {
    this->RunBegin.assign(1, 0);
    this->RunBegin.reserve(static_cast<std::size_t>(
      this->ControlLattice.boxes(1) * this->ControlLattice.boxes(Dim - 1)));
    if (this->Far.Sign.empty() || this->X.Box.empty() || this->Y.Box.empty() || this->Z.Box.empty())
    {
      this->Runs.push_back({ 0, this->X.size(), 0 });
      this->RunBegin.push_back(1);
      return;
    }
    // The samples of box b are [first[b], first[b + 1]).
    const std::int64_t boxesAlongX = this->ControlLattice.boxes(0);
    std::vector<std::int64_t> first(static_cast<std::size_t>(boxesAlongX) + 1);
    for (std::int64_t b = 0; b <= boxesAlongX; ++b)
    {
      first[static_cast<std::size_t>(b)] =
        std::lower_bound(this->X.Box.begin(), this->X.Box.end(), b) - this->X.Box.begin();
    }
    for (std::int64_t z = this->Z.Box.front(); z <= this->Z.Box.back(); ++z)
    {
      for (std::int64_t y = this->Y.Box.front(); y <= this->Y.Box.back(); ++y)
      {
        const std::int8_t* sign =
          this->Far.Sign.data() + (z * this->ControlLattice.boxes(1) + y) * boxesAlongX;
        for (std::int64_t b = 0, end = 0; b < boxesAlongX; b = end)
        {
          end = b + 1;
          while (end + 8 <= boxesAlongX && std::memcmp(sign + end, sign + end - 1, 8) == 0)
          {
            end += 8; // equal to the same bytes moved by one: all alike
          }
          while (end < boxesAlongX && sign[end] == sign[b])
          {
            ++end;
          }
          this->Runs.push_back(
            { first[static_cast<std::size_t>(b)], first[static_cast<std::size_t>(end)], sign[b] });
        }
        this->RunBegin.push_back(this->Runs.size());
      }
    }
  }

  /// The samples of a row from the first to the last where the spline counts, [begin, end).
  Run splineSpan(std::size_t row) const
  {
    std::size_t first = this->RunBegin[row], last = this->RunBegin[row + 1];
    while (first < last && this->Runs[first].Sign != 0)
    {
      ++first;
    }
    while (first < last && this->Runs[last - 1].Sign != 0)
    {
      --last;
    }
    return first < last ? Run{ this->Runs[first].Begin, this->Runs[last - 1].End, 0 }
                        : Run{ this->X.size(), 0, 0 };
  }
};

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

/// The nearest point of the domain.
template <int Dim>
struct Nearest
{
  std::array<AxisLocation, Dim> At;
  std::int64_t Box;
  Point<Dim> Away; ///< from the nearest point of the domain to the position

  IPIA_INLINE Nearest(const Lattice<Dim>& lattice, const Point<Dim>& position)
  {
    Index<Dim> box;
    for (int a = 0; a < Dim; ++a)
    {
      const double inside = std::min(std::max(position[a], 0.0), lattice.extent(a));
      this->At[a] = lattice.locate(inside, a);
      // An end of the domain that rounding has put outside is not outside.
      const double away = position[a] - inside;
      this->Away[a] = std::abs(away) <= 1e-12 * lattice.extent(a) ? 0.0 : away;
      box[a] = lattice.locateBox(inside, a);
    }
    this->Box = lattice.boxIndex(box);
  }
};

/// sum_i c_i B_i, and its gradient unless nullptr.
template <int Dim>
IPIA_INLINE double sumAt(const Lattice<Dim>& lattice, const double* coefficients,
  const std::array<AxisLocation, Dim>& at, Point<Dim>* gradient)
{
  std::array<BasisValues, 3> w = { BasisValues{ 1 }, BasisValues{ 1 }, BasisValues{ 1 } };
  std::array<BasisValues, 3> d{};
  Index<Dim> cell;
  for (int a = 0; a < Dim; ++a)
  {
    const auto i = static_cast<std::size_t>(a);
    w[i] = cubicBasis(at[i].T);
    if (gradient)
    {
      d[i] = cubicBasisFirstDerivative(at[i].T);
    }
    cell[i] = at[i].Cell;
  }
  // Sums along z and y first, one lane per coefficient along x.
  const auto& size = lattice.Size;
  const double* base = coefficients + lattice.coefficientIndex(cell);
  Vector4 f{}, fy{}, fz{};
  for (std::size_t k = 0; k < (Dim == 3 ? Order : 1); ++k)
  {
    for (std::size_t j = 0; j < Order; ++j)
    {
      Vector4 c;
      std::memcpy(&c,
        base + (static_cast<std::int64_t>(k) * size[1] + static_cast<std::int64_t>(j)) * size[0],
        sizeof(c));
      f += w[2][k] * w[1][j] * c;
      if (gradient)
      {
        fy += w[2][k] * d[1][j] * c;
        fz += d[2][k] * w[1][j] * c;
      }
    }
  }
  const auto alongX = [](const BasisValues& x, const Vector4& v)
  { return x[0] * v[0] + x[1] * v[1] + x[2] * v[2] + x[3] * v[3]; };
  if (gradient)
  {
    const Point<Dim>& h = lattice.Spacing;
    (*gradient)[0] = alongX(d[0], f) / h[0];
    (*gradient)[1] = alongX(w[0], fy) / h[1];
    if (Dim == 3)
    {
      (*gradient)[Dim - 1] = alongX(w[0], fz) / h[Dim - 1];
    }
  }
  return alongX(w[0], f);
}

/// What evaluation needs: @a Weights is nullptr where the spline is not rational, otherwise @a
/// Coefficients are those of the numerator.
struct Coefficients
{
  const double* Values;
  const double* Weights;
};

/// f at a position anywhere, and its gradient unless nullptr.
template <int Dim>
IPIA_INLINE double evaluateAt(const Lattice<Dim>& lattice, const Coefficients& coefficients,
  const FarField& farField, const Point<Dim>& position, Point<Dim>* gradient)
{
  const Nearest<Dim> nearest(lattice, position);
  const double constant = farField.Sign.empty() ? 0.0 : farField.value(nearest.Box);
  if (gradient)
  {
    gradient->setZero();
  }
  double f = constant;
  if (constant == 0)
  {
    f = sumAt<Dim>(lattice, coefficients.Values, nearest.At, gradient);
    if (coefficients.Weights)
    {
      Point<Dim> slope;
      const double d =
        sumAt<Dim>(lattice, coefficients.Weights, nearest.At, gradient ? &slope : nullptr);
      f /= d;
      if (gradient)
      {
        *gradient = (*gradient - f * slope) / d;
      }
    }
  }
  return continueOutside<Dim>(nearest.Away, f, gradient);
}

template <int Dim>
struct PointsKernel
{
  static IPIA_INLINE void run(const Lattice<Dim>& lattice, const Coefficients& coefficients,
    const FarField& farField, const Points<Dim>& positions, Vector& values, Points<Dim>& gradients)
  {
    for (Eigen::Index k = 0; k < positions.cols(); ++k)
    {
      const Point<Dim> x = positions.col(k);
      Point<Dim> g;
      values[k] = evaluateAt<Dim>(lattice, coefficients, farField, x, &g);
      gradients.col(k) = g;
    }
  }
};

/// Slices along the last axis that a rational spline samples at a time.
template <int Dim>
constexpr std::size_t SlabSize = Dim == 3 ? 16 : 1024;

Coefficients coefficientsOf(
  const Vector& polynomial, const Vector& numerator, const Vector& weights)
{
  return weights.size() ? Coefficients{ numerator.data(), weights.data() }
                        : Coefficients{ polynomial.data(), nullptr };
}

/**
 * Samples of one spline, see ImplicitSpline::sample().
 *
 * @param constants  where the far field has the sign -1 and 1
 */
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

}

template <int Dim>
ImplicitSpline<Dim>::ImplicitSpline(
  const Lattice<Dim>& lattice, Vector coefficients, FarField farField)
  : ControlLattice(lattice)
  , Coefficients(std::move(coefficients))
  , Far(std::move(farField))
{
}

template <int Dim>
ImplicitSpline<Dim>::ImplicitSpline(
  const Lattice<Dim>& lattice, Vector coefficients, Vector weights, FarField farField)
  : ControlLattice(lattice)
  , Coefficients(std::move(coefficients))
  , Weights(std::move(weights))
  , Numerator(this->Coefficients.cwiseProduct(this->Weights))
  , Far(std::move(farField))
{
}

template <int Dim>
double ImplicitSpline<Dim>::value(const Point<Dim>& position) const
{
  return evaluateAt<Dim>(this->ControlLattice,
    coefficientsOf(this->Coefficients, this->Numerator, this->Weights), this->Far, position,
    nullptr);
}

template <int Dim>
Point<Dim> ImplicitSpline<Dim>::gradient(const Point<Dim>& position) const
{
  Point<Dim> g;
  this->valueAndGradient(position, g);
  return g;
}

template <int Dim>
double ImplicitSpline<Dim>::valueAndGradient(const Point<Dim>& position, Point<Dim>& gradient) const
{
  return evaluateAt<Dim>(this->ControlLattice,
    coefficientsOf(this->Coefficients, this->Numerator, this->Weights), this->Far, position,
    &gradient);
}

template <int Dim>
void ImplicitSpline<Dim>::valuesAndGradients(
  const Points<Dim>& positions, Vector& values, Points<Dim>& gradients) const
{
  values.resize(positions.cols());
  gradients.resize(Dim, positions.cols());
  dispatch<PointsKernel<Dim>>(this->ControlLattice,
    coefficientsOf(this->Coefficients, this->Numerator, this->Weights), this->Far, positions,
    values, gradients);
}

template <int Dim>
template <typename Scalar>
bool ImplicitSpline<Dim>::sampleRational(const AxisPositions<Dim>& positions, Scalar* values,
  int threads, int derivativeAxis, const ProgressCallback& progress) const
{
  const std::vector<double>& last = positions[Dim - 1];
  std::size_t slice = 1;
  for (std::size_t a = 0; a + 1 < Dim; ++a)
  {
    slice *= positions[a].size();
  }
  const std::size_t room = slice * std::min(SlabSize<Dim>, last.size());
  std::vector<double> numerator(room), denominator(room), slopes, weightSlopes;
  if (derivativeAxis >= 0)
  {
    slopes.resize(room);
    weightSlopes.resize(room);
  }
  AxisPositions<Dim> slab = positions;
  for (std::size_t begin = 0; begin < last.size(); begin += SlabSize<Dim>)
  {
    const std::size_t end = std::min(begin + SlabSize<Dim>, last.size());
    slab[Dim - 1].assign(last.begin() + static_cast<std::ptrdiff_t>(begin),
      last.begin() + static_cast<std::ptrdiff_t>(end));
    const auto fill = [&](const Vector& coefficients, std::array<double, 2> constants, int axis,
                        std::vector<double>& to)
    {
      if (!to.empty())
      {
        sampleSpline<Dim>(this->ControlLattice, coefficients, this->Far, constants, slab, to.data(),
          threads, axis, {});
      }
    };
    // In the far field the quotient is its constant, and the slopes are 0.
    fill(this->Numerator, { -this->Far.Magnitude, this->Far.Magnitude }, -1, numerator);
    fill(this->Weights, { 1, 1 }, -1, denominator);
    fill(this->Numerator, { 0, 0 }, derivativeAxis, slopes);
    fill(this->Weights, { 0, 0 }, derivativeAxis, weightSlopes);
    Scalar* const out = values + begin * slice;
    parallelChunks(static_cast<std::int64_t>((end - begin) * slice), resolveThreads(threads),
      [&](std::int64_t from, std::int64_t to)
      {
        for (auto i = static_cast<std::size_t>(from); i < static_cast<std::size_t>(to); ++i)
        {
          const double f = numerator[i] / denominator[i];
          out[i] = static_cast<Scalar>(
            slopes.empty() ? f : (slopes[i] - f * weightSlopes[i]) / denominator[i]);
        }
      });
    if (progress && !progress(static_cast<double>(end) / static_cast<double>(last.size())))
    {
      return false;
    }
  }
  return true;
}

template <int Dim>
template <typename Scalar>
bool ImplicitSpline<Dim>::sample(const AxisPositions<Dim>& positions, Scalar* values, int threads,
  int derivativeAxis, const ProgressCallback& progress) const
{
  if (this->isRational())
  {
    return this->sampleRational(positions, values, threads, derivativeAxis, progress);
  }
  const double constant = derivativeAxis >= 0 ? 0.0 : this->Far.Magnitude;
  return sampleSpline<Dim>(this->ControlLattice, this->Coefficients, this->Far,
    { -constant, constant }, positions, values, threads, derivativeAxis, progress);
}

template class ImplicitSpline<2>;
template class ImplicitSpline<3>;
template bool ImplicitSpline<2>::sample(
  const AxisPositions<2>&, float*, int, int, const ProgressCallback&) const;
template bool ImplicitSpline<2>::sample(
  const AxisPositions<2>&, double*, int, int, const ProgressCallback&) const;
template bool ImplicitSpline<3>::sample(
  const AxisPositions<3>&, float*, int, int, const ProgressCallback&) const;
template bool ImplicitSpline<3>::sample(
  const AxisPositions<3>&, double*, int, int, const ProgressCallback&) const;
}
