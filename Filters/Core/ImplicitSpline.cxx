// SPDX-License-Identifier: BSD-3-Clause
#include "ImplicitSpline.h"

#include "CubicBasis.h"
#include "Dispatch.h"
#include "OutsideDomain.h"
#include "Parallel.h"

#include <atomic>
#include <cstring>
#include <iterator>

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

  bool hasSpline(std::size_t row) const
  {
    const std::size_t begin = this->RunBegin[row];
    return this->RunBegin[row + 1] > begin + 1 || this->Runs[begin].Sign == 0;
  }

  /// The runs of samples along x where the spline counts in any of the rows z to endZ at @a y, at
  /// most GroupSize; these share a knot cell along z, but not always a box.
  void findSplineRuns(
    std::int64_t y, std::int64_t z, std::int64_t endZ, std::vector<Run>& found) const
  {
    found.clear();
    if (endZ - z == 1 || this->boxRow(y, z) == this->boxRow(y, endZ - 1))
    {
      const std::size_t row = this->boxRow(y, z);
      std::copy_if(this->Runs.begin() + static_cast<std::ptrdiff_t>(this->RunBegin[row]),
        this->Runs.begin() + static_cast<std::ptrdiff_t>(this->RunBegin[row + 1]),
        std::back_inserter(found), [](const Run& run) { return run.Sign == 0; });
      return;
    }
    std::array<std::size_t, GroupSize> next{}, last{};
    std::size_t rows = 0;
    for (std::int64_t k = z; k < endZ; ++k)
    {
      const std::size_t row = this->boxRow(y, k);
      if (this->hasSpline(row) && (rows == 0 || this->RunBegin[row + 1] != last[rows - 1]))
      {
        next[rows] = this->RunBegin[row];
        last[rows++] = this->RunBegin[row + 1];
      }
    }
    const auto skipFar = [&](std::size_t i)
    {
      while (next[i] < last[i] && this->Runs[next[i]].Sign != 0)
      {
        ++next[i];
      }
      return next[i] < last[i];
    };
    while (rows > 0)
    {
      std::int64_t begin = this->X.size();
      for (std::size_t i = 0; i < rows; ++i)
      {
        begin = skipFar(i) ? std::min(begin, this->Runs[next[i]].Begin) : begin;
      }
      if (begin == this->X.size())
      {
        return;
      }
      // The run grows by all that it meets.
      std::int64_t end = begin;
      for (bool grown = true; grown;)
      {
        grown = false;
        for (std::size_t i = 0; i < rows; ++i)
        {
          if (skipFar(i) && this->Runs[next[i]].Begin <= end)
          {
            end = std::max(end, this->Runs[next[i]++].End);
            grown = true;
          }
        }
      }
      found.push_back({ begin, end, 0 });
    }
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

  /// The end of the group that begins with sample @a i: up to GroupSize of one cell.
  static std::int64_t groupEnd(const AxisTable& table, std::int64_t i, std::int64_t last)
  {
    const std::int64_t cell = table.Cell[static_cast<std::size_t>(i)];
    std::int64_t end = i + 1;
    while (end < std::min(last, i + GroupSize) && table.Cell[static_cast<std::size_t>(end)] == cell)
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
    std::int64_t x = begin;
    for (; x + Lanes <= end; x += Lanes)
    {
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
    if (x < end)
    {
      std::array<Out, Lanes> lanes;
      for (std::size_t k = 0; k < Terms; ++k)
      {
        load(in[k] + x, v[k]);
      }
      for (int i = 0; i < Count; ++i)
      {
        combine(weights[i].data(), v, sum);
        store(sum, lanes.data());
        std::copy(lanes.begin(), lanes.begin() + (end - x), out + i * stride + x);
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

  /// Slice k of the coefficients, expanded to the samples of the block along x and y.
  static IPIA_INLINE void expandSlice(const Grid& grid, const SampleBlock& block,
    std::int64_t slice, std::vector<double>& alongX, double* expanded)
  {
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
        next - y, in, grid.Y.Weight.data() + y, 0, n, expanded + (y - block.FirstY) * n, n);
    }
  }

  static IPIA_INLINE void run(const Grid& grid, const SampleBlock& block, Scalar* values)
  {
    const std::int64_t n = grid.X.size(), rows = grid.Y.size(), padded = paddedRow(grid);
    const std::int64_t sliceSize = (block.LastY - block.FirstY) * padded;
    std::vector<double> alongX, window(static_cast<std::size_t>(Grid::Slices * sliceSize));
    std::array<std::int64_t, Grid::Slices> held;
    held.fill(-1);
    const bool splineOnly = grid.Far.Sign.empty();
    std::vector<typename Grid::Run> runs(1, { 0, n, 0 });
    std::int64_t next = block.FirstZ;
    for (std::int64_t z = block.FirstZ; z < block.LastZ; z = next)
    {
      const std::int64_t cell = grid.Z.Cell[static_cast<std::size_t>(z)];
      next = groupEnd(grid.Z, z, block.LastZ);
      bool spline = splineOnly;
      for (std::int64_t y = block.FirstY; y < block.LastY && !spline; ++y)
      {
        for (std::int64_t k = z; k < next && !spline; ++k)
        {
          spline = grid.hasSpline(grid.boxRow(y, k));
        }
      }
      std::array<const double*, Grid::Slices> slices{};
      for (std::int64_t k = 0; k < Grid::Slices && spline; ++k)
      {
        const auto slot = static_cast<std::size_t>((cell + k) % Grid::Slices);
        double* expanded = window.data() + static_cast<std::int64_t>(slot) * sliceSize;
        if (held[slot] != cell + k)
        {
          expandSlice(grid, block, cell + k, alongX, expanded);
          held[slot] = cell + k;
        }
        slices[static_cast<std::size_t>(k)] = expanded;
      }
      const BasisValues* w = grid.Z.Weight.data() + z;
      for (std::int64_t y = block.FirstY; y < block.LastY; ++y)
      {
        const std::int64_t offset = (y - block.FirstY) * padded, imageSlice = rows * n;
        Scalar* const out = values + (z * rows + y) * n;
        if (!splineOnly)
        {
          grid.findSplineRuns(y, z, next, runs);
        }
        for (const auto& part : runs)
        {
          std::array<const double*, Grid::Slices> in;
          for (std::size_t k = 0; k < Grid::Slices; ++k)
          {
            in[k] = slices[k] + offset;
          }
          combineGroup(next - z, in, w, part.Begin, part.End, out, imageSlice);
        }
        for (std::int64_t k = z; k < next && !splineOnly; ++k)
        {
          const std::size_t row = grid.boxRow(y, k);
          Scalar* const slice = out + (k - z) * imageSlice;
          for (std::size_t r = grid.RunBegin[row]; r < grid.RunBegin[row + 1]; ++r)
          {
            const auto& part = grid.Runs[r];
            if (part.Sign != 0)
            {
              const double constant = grid.Constants[part.Sign > 0 ? 1 : 0];
              std::fill(slice + part.Begin, slice + part.End, static_cast<Scalar>(constant));
            }
          }
        }
      }
    }
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

  const std::int64_t blocksY = (grid.Y.size() + BlockRows - 1) / BlockRows;
  const std::int64_t blocksZ = (grid.Z.size() + BlockSlices - 1) / BlockSlices;
  std::atomic<bool> aborted{ false };
#pragma omp parallel for schedule(dynamic) num_threads(resolveThreads(threads))
  for (std::int64_t b = 0; b < blocksY * blocksZ; ++b)
  {
    if (aborted)
    {
      continue;
    }
    SampleBlock block;
    block.FirstY = b % blocksY * BlockRows;
    block.LastY = std::min(block.FirstY + BlockRows, grid.Y.size());
    block.FirstZ = b / blocksY * BlockSlices;
    block.LastZ = std::min(block.FirstZ + BlockSlices, grid.Z.size());
    dispatch<SampleKernel<Dim, Scalar>>(grid, block, values);
    if (progress && omp_get_thread_num() == 0 && !progress(double(b) / double(blocksY * blocksZ)))
    {
      aborted = true;
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
  std::array<double, 2> constants = { -this->Far.Magnitude, this->Far.Magnitude };
  if (derivativeAxis >= 0)
  {
    constants = { 0, 0 };
  }
  return sampleSpline<Dim>(this->ControlLattice, this->Coefficients, this->Far, constants,
    positions, values, threads, derivativeAxis, progress);
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
