// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The rows of the collocation matrix B: positions where f shall take a value.
 */
#ifndef ipia_ConstraintRows_h
#define ipia_ConstraintRows_h

#include "Lattice.h"

#include <vector>

namespace ipia
{
/// One row: f(x) = Target with a least-squares weight, x given by its local coordinate in a knot
/// cell.
template <int Dim>
struct ConstraintRow
{
  std::array<double, Dim> T;
  double Weight;
  double Target;
};

/**
 * Rows sorted by knot cell, and the cells grouped in tiles for threads.
 *
 * A tile is a bar along one axis, x or y, of TileWidth cells on every other. Tiles of one colour
 * touch disjoint coefficients, so the threads that work on them need no lock, and every coefficient
 * collects its contributions in the same order whatever their number.
 */
template <int Dim>
class ConstraintRows
{
public:
  static constexpr std::int64_t TileWidth = Order;
  static constexpr int NumberOfColours = Dim == 2 ? 2 : 4;

  /// The rows of one knot cell: Rows[Begin] up to the Begin of the next entry.
  struct Cell
  {
    std::int64_t Coefficient; ///< flat index of the first of the 4^Dim coefficients
    std::int64_t Begin;
  };

  /**
   * @param lattice    the control lattice
   * @param positions  Dim x n, relative to the lower corner of the domain, inside it
   * @param targets    n values of f
   * @param weights    n weights >= 0, or empty for 1
   * @param barAxis    the axis of the bars, 0 or 1
   */
  ConstraintRows(const Lattice<Dim>& lattice, const Points<Dim>& positions, const Vector& targets,
    const Vector& weights, int barAxis = 0);

  const Lattice<Dim>& lattice() const { return this->ControlLattice; }
  std::int64_t size() const { return static_cast<std::int64_t>(this->Rows.size()); }

  const ConstraintRow<Dim>* rows() const { return this->Rows.data(); }
  const Cell* cells() const { return this->Cells.data(); }

  std::int64_t numberOfTiles() const
  {
    return static_cast<std::int64_t>(this->TileBegin.size()) - 1;
  }
  /// Cells of tile t: cells()[tileBegin(t)] up to tileBegin(t + 1).
  std::int64_t tileBegin(std::int64_t tile) const
  {
    return this->TileBegin[static_cast<std::size_t>(tile)];
  }
  /// Tiles of colour k: tileOfColour(k) up to tileOfColour(k + 1).
  std::int64_t tileOfColour(int colour) const
  {
    return this->ColourBegin[static_cast<std::size_t>(colour)];
  }

private:
  Lattice<Dim> ControlLattice;
  std::vector<ConstraintRow<Dim>> Rows;
  std::vector<Cell> Cells; // one more than there are occupied cells
  std::vector<std::int64_t> TileBegin;
  std::array<std::int64_t, NumberOfColours + 1> ColourBegin{};
};
}

#endif
