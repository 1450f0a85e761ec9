// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The control lattice of a uniform tensor-product cubic B-spline.
 *
 * The domain is [0, extent] per axis, relative to its lower corner. An axis with N >= 4
 * coefficients has N - 3 knot cells of width h = extent / (N - 3). Coefficient i (from 0) belongs
 * to the cardinal cubic B-spline centred at (i - 1) h with support 4 h; knot cell c sees the
 * coefficients c .. c + 3.
 */
#ifndef ipia_Lattice_h
#define ipia_Lattice_h

#include "Types.h"

#include <algorithm>
#include <cmath>

namespace ipia
{
/// Number of coefficients that one knot cell has along an axis: degree + 1.
constexpr int Order = 4;

/// A position this little below a knot or a border of boxes, in knot spacings, counts as on it: the
/// far field jumps from box to box, and rounding must not choose the box of a position.
constexpr double KnotTolerance = 1e-6;

/// Where a position lies on one axis: its knot cell and the local coordinate in [-KnotTolerance,
/// 1].
struct AxisLocation
{
  std::int64_t Cell;
  double T;
};

template <int Dim>
struct Lattice
{
  Index<Dim> Size{};    ///< coefficients per axis, each >= 4
  Point<Dim> Spacing{}; ///< knot spacing h per axis, > 0

  std::int64_t cells(int axis) const { return this->Size[axis] - (Order - 1); }

  double extent(int axis) const
  {
    return static_cast<double>(this->cells(axis)) * this->Spacing[axis];
  }

  std::int64_t numberOfCoefficients() const
  {
    std::int64_t n = 1;
    for (int a = 0; a < Dim; ++a)
    {
      n *= this->Size[a];
    }
    return n;
  }

  std::int64_t numberOfCells() const
  {
    std::int64_t n = 1;
    for (int a = 0; a < Dim; ++a)
    {
      n *= this->cells(a);
    }
    return n;
  }

  Index<Dim> numberOfCellsPerAxis() const
  {
    Index<Dim> n;
    for (int a = 0; a < Dim; ++a)
    {
      n[a] = this->cells(a);
    }
    return n;
  }

  /// Box i has the width h / 2 and the centre i h / 2; the domain halves the first and the last.
  std::int64_t boxes(int axis) const { return 2 * this->cells(axis) + 1; }

  std::int64_t numberOfBoxes() const
  {
    std::int64_t n = 1;
    for (int a = 0; a < Dim; ++a)
    {
      n *= this->boxes(a);
    }
    return n;
  }

  Index<Dim> numberOfBoxesPerAxis() const
  {
    Index<Dim> n;
    for (int a = 0; a < Dim; ++a)
    {
      n[a] = this->boxes(a);
    }
    return n;
  }

  /// Flat index of a coefficient; also that of the first coefficient of the knot cell @a i.
  std::int64_t coefficientIndex(const Index<Dim>& i) const { return flat(i, this->Size); }

  std::int64_t cellIndex(const Index<Dim>& c) const
  {
    return flat(c, this->numberOfCellsPerAxis());
  }

  /// Knot cells are half open but for the last, which is closed: a position on the upper bound is
  /// inside. Positions outside are assigned to the nearest cell (T is then beyond its range), those
  /// that are no number to the first (T is then none).
  AxisLocation locate(double position, int axis) const
  {
    const double u = position / this->Spacing[axis];
    const double last = static_cast<double>(this->cells(axis) - 1);
    const double cell = std::min(last, std::max(0.0, std::floor(u + KnotTolerance)));
    return { static_cast<std::int64_t>(cell), u - cell };
  }

  std::int64_t boxIndex(const Index<Dim>& b) const { return flat(b, this->numberOfBoxesPerAxis()); }

  /// The box of a position, half open as the knot cells are; that of the nearest one outside.
  std::int64_t locateBox(double position, int axis) const
  {
    const double u = position / this->Spacing[axis];
    const double last = static_cast<double>(this->boxes(axis) - 1);
    const double box = std::floor(2 * (u + KnotTolerance) + 0.5);
    return static_cast<std::int64_t>(std::min(last, std::max(0.0, box)));
  }

  /// True within the closed domain; rounding of the upper bound is forgiven.
  bool contains(const Point<Dim>& position) const
  {
    for (int a = 0; a < Dim; ++a)
    {
      const double slack = 1e-12 * this->extent(a);
      if (!(position[a] >= -slack && position[a] <= this->extent(a) + slack))
      {
        return false;
      }
    }
    return true;
  }

private:
  static std::int64_t flat(const Index<Dim>& i, const Index<Dim>& n)
  {
    std::int64_t k = i[Dim - 1];
    for (int a = Dim - 2; a >= 0; --a)
    {
      k = k * n[a] + i[a];
    }
    return k;
  }
};
}

#endif
