// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The rows of ConstraintRows as vectors want them: eight side by side, in batches that go through
 * the phases of a sweep together, and cells in an order that lets neighbours share vectors.
 *
 * Vectors hold coefficients along x. The cells of a tile follow each other along y: where one cell
 * is beside the one before, three of its four layers of vectors are those that it already had, and
 * stay in registers.
 */
#ifndef ipia_RowBatches_h
#define ipia_RowBatches_h

#include "ConstraintRows.h"

#include <vector>

namespace ipia
{
/// Eight rows.
template <int Dim>
struct alignas(64) RowPacket
{
  static constexpr int Size = 8;
  double T[Dim][Size], Target[Size], Weight[Size];
};

template <int Dim>
class RowBatches
{
public:
  static constexpr int NumberOfColours = ConstraintRows<Dim>::NumberOfColours;

  /// Rows [Begin, End) of a batch, which share a cell.
  struct Part
  {
    std::int64_t Coefficient; ///< as ConstraintRows::Cell has it
    std::int16_t Begin, End;
    bool Follows; ///< along y on the cell of the part before, in the same batch
  };

  /// Packets and parts up to those of the next batch.
  struct Batch
  {
    std::int64_t Packet, Part;
  };

  /// So many rows that no phase waits for the one before, so few that what they hand on stays in
  /// the nearest cache.
  static constexpr int MostRows = 32;

  explicit RowBatches(const ConstraintRows<Dim>& rows);

  const RowPacket<Dim>* packets() const { return this->Packets.data(); }
  const Part* parts() const { return this->Parts.data(); }

  /// Tiles are bars along y of ConstraintRows::TileWidth cells on every other axis, and have colours
  /// as those of ConstraintRows do.
  std::int64_t numberOfTiles() const
  {
    return static_cast<std::int64_t>(this->TileBegin.size()) - 1;
  }
  std::int64_t tileOfColour(int colour) const
  {
    return this->ColourBegin[static_cast<std::size_t>(colour)];
  }

  /// Batches of tile t: batches()[tileBegin(t)] up to tileBegin(t + 1), which may be looked at.
  const Batch* batches() const { return this->Batches.data(); }
  std::int64_t tileBegin(std::int64_t tile) const
  {
    return this->TileBegin[static_cast<std::size_t>(tile)];
  }

  /// Rows with those of weight 0 that fill the last packet of each tile.
  std::int64_t size() const
  {
    return static_cast<std::int64_t>(this->Packets.size()) * RowPacket<Dim>::Size;
  }

private:
  /// A cell, and its place in its tile.
  struct PlacedCell
  {
    std::int64_t Place;
    const typename ConstraintRows<Dim>::Cell* Cell;
  };

  std::vector<std::vector<PlacedCell>> sortByTile(const ConstraintRows<Dim>& rows);
  void append(const ConstraintRow<Dim>& row, double weight);
  int rowsInBatch() const;

  std::vector<RowPacket<Dim>> Packets;
  std::vector<Part> Parts;
  std::vector<Batch> Batches; // one more than there are
  std::vector<std::int64_t> TileBegin;
  std::array<std::int64_t, NumberOfColours + 1> ColourBegin{};
};
}

#endif
