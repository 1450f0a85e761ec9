// SPDX-License-Identifier: BSD-3-Clause
#include "ImplicitSpline.h"

#include "CubicBasis.h"
#include "Dispatch.h"
#include "Parallel.h"

#include <atomic>

namespace ipia
{
namespace
{
/// Cell and weights of every sample position of one axis.
struct AxisTable
{
  std::vector<std::int64_t> Cell;
  std::vector<BasisValues> Weight;

  std::int64_t size() const { return static_cast<std::int64_t>(this->Cell.size()); }
};

template <int Dim>
AxisTable makeAxisTable(
  const Lattice<Dim>& lattice, int axis, const std::vector<double>& positions, bool derivative)
{
  AxisTable table;
  table.Cell.reserve(positions.size());
  table.Weight.reserve(positions.size());
  for (double x : positions)
  {
    const AxisLocation at = lattice.locate(std::min(std::max(x, 0.0), lattice.extent(axis)), axis);
    BasisValues w = cubicBasisDerivative(at.T, derivative ? 1 : 0);
    if (derivative)
    {
      for (double& v : w)
      {
        v /= lattice.Spacing[axis];
      }
    }
    table.Cell.push_back(at.Cell);
    table.Weight.push_back(w);
  }
  return table;
}

/// A block of samples: some rows of y, some slices of z, all of x. In 2-D there is one slice.
struct SampleBlock
{
  std::int64_t FirstY, LastY, FirstZ, LastZ;
};

/// Number of sample rows and slices of a block; the expanded rows of four slices fit the cache.
constexpr std::int64_t BlockRows = 16;
constexpr std::int64_t BlockSlices = 32;

/// All that the samples of one grid share.
template <int Dim>
struct SampleGrid
{
  static constexpr int Slices = Dim == 3 ? Order : 1;

  const Lattice<Dim>& ControlLattice;
  const double* Coefficients;
  const FarField& Far;
  bool Derivative;
  AxisTable X, Y, Z;
  /// The far field by runs of samples: for each row of cells, [begin, end) and sign of each run.
  struct Run
  {
    std::int64_t Begin, End;
    int Sign;
  };
  std::vector<Run> Runs;
  std::vector<std::size_t> RunBegin;

  std::int64_t cellRow(std::int64_t y, std::int64_t z) const
  {
    return this->Z.Cell[static_cast<std::size_t>(z)] * this->ControlLattice.cells(1) +
      this->Y.Cell[static_cast<std::size_t>(y)];
  }

  void makeRuns()
  {
    const std::int64_t cellsAlongX = this->ControlLattice.cells(0);
    const std::int64_t rows = this->ControlLattice.numberOfCells() / cellsAlongX;
    // The samples of cell c are [first[c], first[c + 1]).
    std::vector<std::int64_t> first(static_cast<std::size_t>(cellsAlongX) + 1);
    for (std::int64_t c = 0; c <= cellsAlongX; ++c)
    {
      first[static_cast<std::size_t>(c)] =
        std::lower_bound(this->X.Cell.begin(), this->X.Cell.end(), c) - this->X.Cell.begin();
    }
    this->RunBegin.assign(1, 0);
    for (std::int64_t row = 0; row < rows; ++row)
    {
      for (std::int64_t c = 0; c < cellsAlongX;)
      {
        const int sign = this->Far.Sign.empty()
          ? 0
          : this->Far.Sign[static_cast<std::size_t>(row * cellsAlongX + c)];
        std::int64_t end = c + 1;
        while (end < cellsAlongX && !this->Far.Sign.empty() &&
          this->Far.Sign[static_cast<std::size_t>(row * cellsAlongX + end)] == sign)
        {
          ++end;
        }
        end = this->Far.Sign.empty() ? cellsAlongX : end;
        this->Runs.push_back(
          { first[static_cast<std::size_t>(c)], first[static_cast<std::size_t>(end)], sign });
        c = end;
      }
      this->RunBegin.push_back(this->Runs.size());
    }
  }

  bool hasSpline(std::int64_t row) const
  {
    const std::size_t begin = this->RunBegin[static_cast<std::size_t>(row)];
    return this->RunBegin[static_cast<std::size_t>(row) + 1] > begin + 1 ||
      this->Runs[begin].Sign == 0;
  }
};

template <int Dim, typename Scalar>
struct SampleKernel
{
  using Grid = SampleGrid<Dim>;

  /// Slice k of the coefficients, expanded to the samples of the block along x and y.
  static IPIA_INLINE void expandSlice(const Grid& grid, const SampleBlock& block,
    std::int64_t slice, std::vector<double>& alongX, double* expanded)
  {
    const std::int64_t n = grid.X.size();
    const std::int64_t firstRow = grid.Y.Cell[static_cast<std::size_t>(block.FirstY)];
    const std::int64_t lastRow = grid.Y.Cell[static_cast<std::size_t>(block.LastY - 1)] + Order;
    const auto& size = grid.ControlLattice.Size;
    alongX.resize(static_cast<std::size_t>((lastRow - firstRow) * n));
    for (std::int64_t row = firstRow; row < lastRow; ++row)
    {
      const double* c = grid.Coefficients + (slice * size[1] + row) * size[0];
      double* out = alongX.data() + (row - firstRow) * n;
      for (std::int64_t x = 0; x < n; ++x)
      {
        const double* at = c + grid.X.Cell[static_cast<std::size_t>(x)];
        const BasisValues& w = grid.X.Weight[static_cast<std::size_t>(x)];
        out[x] = w[0] * at[0] + w[1] * at[1] + w[2] * at[2] + w[3] * at[3];
      }
    }
    for (std::int64_t y = block.FirstY; y < block.LastY; ++y)
    {
      const double* in = alongX.data() + (grid.Y.Cell[static_cast<std::size_t>(y)] - firstRow) * n;
      const BasisValues w = grid.Y.Weight[static_cast<std::size_t>(y)];
      double* out = expanded + (y - block.FirstY) * n;
      for (std::int64_t x = 0; x < n; ++x)
      {
        out[x] = w[0] * in[x] + w[1] * in[x + n] + w[2] * in[x + 2 * n] + w[3] * in[x + 3 * n];
      }
    }
  }

  static IPIA_INLINE void run(const Grid& grid, const SampleBlock& block, Scalar* values)
  {
    const std::int64_t n = grid.X.size(), rows = grid.Y.size();
    const std::int64_t sliceSize = (block.LastY - block.FirstY) * n;
    std::vector<double> alongX, window(static_cast<std::size_t>(Grid::Slices * sliceSize));
    std::array<std::int64_t, Grid::Slices> held;
    held.fill(-1);
    for (std::int64_t z = block.FirstZ; z < block.LastZ; ++z)
    {
      const std::int64_t cell = grid.Z.Cell[static_cast<std::size_t>(z)];
      bool spline = false;
      for (std::int64_t y = block.FirstY; y < block.LastY; ++y)
      {
        spline = spline || grid.hasSpline(grid.cellRow(y, z));
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
      const BasisValues w = grid.Z.Weight[static_cast<std::size_t>(z)];
      for (std::int64_t y = block.FirstY; y < block.LastY; ++y)
      {
        const auto row = static_cast<std::size_t>(grid.cellRow(y, z));
        const std::int64_t offset = (y - block.FirstY) * n;
        Scalar* out = values + (z * rows + y) * n;
        for (std::size_t r = grid.RunBegin[row]; r < grid.RunBegin[row + 1]; ++r)
        {
          const auto part = grid.Runs[r];
          if (part.Sign != 0)
          {
            const double constant = grid.Derivative ? 0.0 : part.Sign * grid.Far.Magnitude;
            std::fill(out + part.Begin, out + part.End, static_cast<Scalar>(constant));
          }
          else if (Dim == 3)
          {
            const double *a = slices[0] + offset, *b = slices[1 % Grid::Slices] + offset,
                         *c = slices[2 % Grid::Slices] + offset,
                         *d = slices[3 % Grid::Slices] + offset;
            for (std::int64_t x = part.Begin; x < part.End; ++x)
            {
              out[x] = static_cast<Scalar>(w[0] * a[x] + w[1] * b[x] + w[2] * c[x] + w[3] * d[x]);
            }
          }
          else
          {
            std::copy(
              slices[0] + offset + part.Begin, slices[0] + offset + part.End, out + part.Begin);
          }
        }
      }
    }
  }
};
}

template <int Dim>
struct ImplicitSpline<Dim>::Nearest
{
  std::array<AxisLocation, Dim> At;
  std::int64_t Cell;
  Point<Dim> Away; ///< from the nearest point of the domain to the position
  double Distance;

  Nearest(const Lattice<Dim>& lattice, const Point<Dim>& position)
  {
    Index<Dim> cell;
    for (int a = 0; a < Dim; ++a)
    {
      const double inside = std::min(std::max(position[a], 0.0), lattice.extent(a));
      this->At[a] = lattice.locate(inside, a);
      // An end of the domain that rounding has put outside is not outside.
      const double away = position[a] - inside;
      this->Away[a] = std::abs(away) <= 1e-12 * lattice.extent(a) ? 0.0 : away;
      cell[a] = this->At[a].Cell;
    }
    this->Cell = lattice.cellIndex(cell);
    this->Distance = this->Away.norm();
  }
};

template <int Dim>
ImplicitSpline<Dim>::ImplicitSpline(
  const Lattice<Dim>& lattice, Vector coefficients, FarField farField)
  : ControlLattice(lattice)
  , Coefficients(std::move(coefficients))
  , Far(std::move(farField))
{
}

template <int Dim>
double ImplicitSpline<Dim>::splineSum(
  const std::array<AxisLocation, Dim>& at, int derivativeAxis) const
{
  std::array<BasisValues, 3> w = { BasisValues{ 1 }, BasisValues{ 1 }, BasisValues{ 1 } };
  Index<Dim> cell;
  for (int a = 0; a < Dim; ++a)
  {
    w[static_cast<std::size_t>(a)] = cubicBasisDerivative(at[a].T, a == derivativeAxis ? 1 : 0);
    cell[a] = at[a].Cell;
  }
  const auto& size = this->ControlLattice.Size;
  const double* base = this->Coefficients.data() + this->ControlLattice.coefficientIndex(cell);
  double sum = 0;
  for (std::size_t k = 0; k < (Dim == 3 ? Order : 1); ++k)
  {
    for (std::size_t j = 0; j < Order; ++j)
    {
      const double* c =
        base + (static_cast<std::int64_t>(k) * size[1] + static_cast<std::int64_t>(j)) * size[0];
      sum +=
        w[2][k] * w[1][j] * (w[0][0] * c[0] + w[0][1] * c[1] + w[0][2] * c[2] + w[0][3] * c[3]);
    }
  }
  return derivativeAxis < 0 ? sum : sum / this->ControlLattice.Spacing[derivativeAxis];
}

template <int Dim>
double ImplicitSpline<Dim>::value(const Point<Dim>& position) const
{
  const Nearest nearest(this->ControlLattice, position);
  const bool far = !this->Far.Sign.empty() && this->Far.value(nearest.Cell) != 0;
  const double f = far ? this->Far.value(nearest.Cell) : this->splineSum(nearest.At, -1);
  return f < 0 ? f - nearest.Distance : f + nearest.Distance;
}

template <int Dim>
Point<Dim> ImplicitSpline<Dim>::gradient(const Point<Dim>& position) const
{
  const Nearest nearest(this->ControlLattice, position);
  const bool far = !this->Far.Sign.empty() && this->Far.value(nearest.Cell) != 0;
  Point<Dim> g = Point<Dim>::Zero();
  for (int a = 0; a < Dim && !far; ++a)
  {
    g[a] = nearest.Away[a] == 0 ? this->splineSum(nearest.At, a) : 0.0;
  }
  if (nearest.Distance > 0)
  {
    const double f = far ? this->Far.value(nearest.Cell) : this->splineSum(nearest.At, -1);
    g += (f < 0 ? -1.0 : 1.0) / nearest.Distance * nearest.Away;
  }
  return g;
}

template <int Dim>
template <typename Scalar>
bool ImplicitSpline<Dim>::sample(const AxisPositions<Dim>& positions, Scalar* values, int threads,
  int derivativeAxis, const ProgressCallback& progress) const
{
  SampleGrid<Dim> grid{ this->ControlLattice, this->Coefficients.data(), this->Far,
    derivativeAxis >= 0, {}, {}, {}, {}, {} };
  grid.X = makeAxisTable(this->ControlLattice, 0, positions[0], derivativeAxis == 0);
  grid.Y = makeAxisTable(this->ControlLattice, 1, positions[1], derivativeAxis == 1);
  grid.Z = { { 0 }, { BasisValues{ 1 } } };
  if (Dim == 3)
  {
    grid.Z =
      makeAxisTable(this->ControlLattice, Dim - 1, positions[Dim - 1], derivativeAxis == Dim - 1);
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
