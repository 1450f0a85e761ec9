// SPDX-License-Identifier: BSD-3-Clause
#include "ConstraintRows.h"

namespace ipia
{
namespace
{
/// The order of the knot cells: by colour, then tile, then cell within the tile, the axis of the
/// bars fastest.
template <int Dim>
class TileOrder
{
public:
  TileOrder(const Lattice<Dim>& lattice, int barAxis)
    : BarAxis(static_cast<std::size_t>(barAxis))
    , CellsAlongBar(lattice.cells(barAxis))
  {
    constexpr std::int64_t width = ConstraintRows<Dim>::TileWidth;
    std::int64_t tiles = 1;
    this->CellsPerTile = this->CellsAlongBar;
    std::size_t other = 0;
    for (int a = 0; a < Dim; ++a)
    {
      if (a != barAxis)
      {
        this->Others[other] = static_cast<std::size_t>(a);
        this->Tiles[other] = (lattice.cells(a) + width - 1) / width;
        tiles *= this->Tiles[other++];
        this->CellsPerTile *= width;
      }
    }
    this->Rank.resize(static_cast<std::size_t>(tiles));
    std::int64_t rank = 0;
    for (int colour = 0; colour < ConstraintRows<Dim>::NumberOfColours; ++colour)
    {
      this->ColourBegin[static_cast<std::size_t>(colour)] = rank;
      for (std::int64_t t = 0; t < tiles; ++t)
      {
        const std::int64_t first = t % this->Tiles[0], second = t / this->Tiles[0];
        if ((first & 1) + 2 * (second & 1) == colour)
        {
          this->Rank[static_cast<std::size_t>(t)] = rank++;
        }
      }
    }
    this->ColourBegin.back() = rank;
  }

  std::int64_t numberOfTiles() const { return static_cast<std::int64_t>(this->Rank.size()); }
  std::int64_t cellsPerTile() const { return this->CellsPerTile; }
  std::int64_t colourBegin(std::size_t colour) const { return this->ColourBegin[colour]; }

  std::int64_t key(const Index<Dim>& cell) const
  {
    constexpr std::int64_t width = ConstraintRows<Dim>::TileWidth;
    std::int64_t tile = 0, local = 0;
    for (std::size_t other = Dim - 1; other-- > 0;)
    {
      const std::int64_t at = cell[this->Others[other]];
      tile = tile * this->Tiles[other] + at / width;
      local = local * width + at % width;
    }
    return this->Rank[static_cast<std::size_t>(tile)] * this->CellsPerTile +
      local * this->CellsAlongBar + cell[this->BarAxis];
  }

private:
  std::size_t BarAxis;
  std::int64_t CellsAlongBar;
  std::int64_t CellsPerTile;
  std::array<std::size_t, Dim - 1> Others; // the other axes
  std::array<std::int64_t, Dim - 1> Tiles; // on them
  std::vector<std::int64_t> Rank;
  std::array<std::int64_t, ConstraintRows<Dim>::NumberOfColours + 1> ColourBegin;
};
}

template <int Dim>
ConstraintRows<Dim>::ConstraintRows(const Lattice<Dim>& lattice, const Points<Dim>& positions,
  const Vector& targets, const Vector& weights, int barAxis)
  : ControlLattice(lattice)
{
  const TileOrder<Dim> order(lattice, barAxis);
  const std::int64_t n = positions.cols();

  // Counting sort of the rows by the key of their cell.
  std::vector<std::int64_t> keys(static_cast<std::size_t>(n)), coefficients(keys.size());
  std::vector<ConstraintRow<Dim>> unsorted(keys.size());
  std::vector<std::int64_t> place(
    static_cast<std::size_t>(order.numberOfTiles() * order.cellsPerTile()) + 1, 0);
  for (std::int64_t k = 0; k < n; ++k)
  {
    const auto i = static_cast<std::size_t>(k);
    Index<Dim> cell;
    for (int a = 0; a < Dim; ++a)
    {
      const AxisLocation at = lattice.locate(positions(a, k), a);
      cell[a] = at.Cell;
      unsorted[i].T[a] = at.T;
    }
    unsorted[i].Target = targets[k];
    unsorted[i].Weight = weights.size() ? weights[k] : 1.0;
    keys[i] = order.key(cell);
    coefficients[i] = lattice.coefficientIndex(cell);
    ++place[static_cast<std::size_t>(keys[i]) + 1];
  }
  for (std::size_t key = 1; key < place.size(); ++key)
  {
    place[key] += place[key - 1];
  }

  this->TileBegin.resize(static_cast<std::size_t>(order.numberOfTiles()) + 1);
  for (std::int64_t tile = 0; tile < order.numberOfTiles(); ++tile)
  {
    this->TileBegin[static_cast<std::size_t>(tile)] = static_cast<std::int64_t>(this->Cells.size());
    for (std::int64_t c = 0; c < order.cellsPerTile(); ++c)
    {
      const auto key = static_cast<std::size_t>(tile * order.cellsPerTile() + c);
      if (place[key + 1] > place[key])
      {
        this->Cells.push_back({ 0, place[key] });
      }
    }
  }
  this->TileBegin.back() = static_cast<std::int64_t>(this->Cells.size());
  this->Cells.push_back({ 0, n });

  this->Rows.resize(keys.size());
  std::vector<std::int64_t> coefficientOfRow(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    const auto to = static_cast<std::size_t>(place[static_cast<std::size_t>(keys[i])]++);
    this->Rows[to] = unsorted[i];
    coefficientOfRow[to] = coefficients[i];
  }
  for (std::size_t c = 0; c + 1 < this->Cells.size(); ++c)
  {
    this->Cells[c].Coefficient = coefficientOfRow[static_cast<std::size_t>(this->Cells[c].Begin)];
  }
  for (std::size_t colour = 0; colour < this->ColourBegin.size(); ++colour)
  {
    this->ColourBegin[colour] = order.colourBegin(colour);
  }
}

template class ConstraintRows<2>;
template class ConstraintRows<3>;
}
