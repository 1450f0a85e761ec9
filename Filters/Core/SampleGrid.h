// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the samples of one grid share: where they lie among knot cells and boxes, and which of them
 * the far field has.
 */
#ifndef ipia_SampleGrid_h
#define ipia_SampleGrid_h

#include "CubicBasis.h"
#include "SplineSampling.h"

#include <algorithm>
#include <cstring>

namespace ipia
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
}

#endif
