// SPDX-License-Identifier: BSD-3-Clause
#include "RowBatches.h"

#include <algorithm>

namespace ipia
{
template <int Dim>
std::vector<std::vector<typename RowBatches<Dim>::PlacedCell>> RowBatches<Dim>::sortByTile(
  const ConstraintRows<Dim>& rows)
{
  constexpr std::int64_t width = ConstraintRows<Dim>::TileWidth;
  const Lattice<Dim>& lattice = rows.lattice();
  const std::int64_t sizeX = lattice.Size[0], sizeY = lattice.Size[1];
  const std::int64_t tilesX = (lattice.cells(0) + width - 1) / width;
  const std::int64_t tilesZ = Dim == 3 ? (lattice.cells(Dim - 1) + width - 1) / width : 1;

  // Tiles are numbered colour by colour.
  std::vector<std::int64_t> number(static_cast<std::size_t>(tilesX * tilesZ));
  std::int64_t tiles = 0;
  for (int colour = 0; colour < NumberOfColours; ++colour)
  {
    this->ColourBegin[static_cast<std::size_t>(colour)] = tiles;
    for (std::int64_t t = 0; t < tilesX * tilesZ; ++t)
    {
      if ((t % tilesX & 1) + 2 * (t / tilesX & 1) == colour)
      {
        number[static_cast<std::size_t>(t)] = tiles++;
      }
    }
  }
  this->ColourBegin.back() = tiles;

  std::vector<std::vector<PlacedCell>> cells(static_cast<std::size_t>(tiles));
  const std::int64_t occupied = rows.tileBegin(rows.numberOfTiles());
  for (std::int64_t c = 0; c < occupied; ++c)
  {
    const auto* const cell = rows.cells() + c;
    const std::int64_t x = cell->Coefficient % sizeX, rest = cell->Coefficient / sizeX;
    const std::int64_t y = rest % sizeY, z = rest / sizeY;
    const auto tile = static_cast<std::size_t>(x / width + tilesX * (z / width));
    cells[static_cast<std::size_t>(number[tile])].push_back(
      { (z % width * width + x % width) * sizeY + y, cell });
  }
  for (auto& ofTile : cells)
  {
    std::sort(ofTile.begin(), ofTile.end(),
      [](const PlacedCell& a, const PlacedCell& b) { return a.Place < b.Place; });
  }
  return cells;
}

template <int Dim>
int RowBatches<Dim>::rowsInBatch() const
{
  return this->Parts.size() > static_cast<std::size_t>(this->Batches.back().Part)
    ? this->Parts.back().End
    : 0;
}

template <int Dim>
void RowBatches<Dim>::append(const ConstraintRow<Dim>& row, double weight)
{
  const int lane = this->Parts.back().End % RowPacket<Dim>::Size;
  if (lane == 0)
  {
    this->Packets.emplace_back();
  }
  RowPacket<Dim>& packet = this->Packets.back();
  for (int a = 0; a < Dim; ++a)
  {
    packet.T[a][lane] = row.T[static_cast<std::size_t>(a)];
  }
  packet.Target[lane] = row.Target;
  packet.Weight[lane] = weight;
  ++this->Parts.back().End;
}

template <int Dim>
RowBatches<Dim>::RowBatches(const ConstraintRows<Dim>& rows)
{
  const auto openBatch = [&]
  {
    this->Batches.push_back({ static_cast<std::int64_t>(this->Packets.size()),
      static_cast<std::int64_t>(this->Parts.size()) });
  };
  const auto cells = this->sortByTile(rows);
  this->Packets.reserve(static_cast<std::size_t>(rows.size() / RowPacket<Dim>::Size) + cells.size());
  for (const auto& ofTile : cells)
  {
    this->TileBegin.push_back(static_cast<std::int64_t>(this->Batches.size()));
    std::int64_t placeBefore = -1;
    const ConstraintRow<Dim>* row = nullptr;
    for (const PlacedCell& placed : ofTile)
    {
      row = rows.rows() + placed.Cell[0].Begin;
      for (std::int64_t left = placed.Cell[1].Begin - placed.Cell->Begin; left > 0;)
      {
        bool follows = placed.Place == placeBefore + 1;
        int inBatch = placeBefore < 0 ? MostRows : this->rowsInBatch();
        if (inBatch == MostRows)
        {
          openBatch();
          follows = false;
          inBatch = 0;
        }
        this->Parts.push_back({ placed.Cell->Coefficient, static_cast<std::int16_t>(inBatch),
          static_cast<std::int16_t>(inBatch), follows });
        for (; left > 0 && inBatch < MostRows; --left, ++inBatch)
        {
          this->append(*row, row->Weight);
          ++row;
        }
        placeBefore = placed.Place;
      }
    }
    // Rows of no weight fill the last packet.
    while (row && this->Parts.back().End % RowPacket<Dim>::Size != 0)
    {
      this->append(row[-1], 0);
    }
  }
  this->TileBegin.push_back(static_cast<std::int64_t>(this->Batches.size()));
  openBatch();
}

template class RowBatches<2>;
template class RowBatches<3>;
}
