// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The rows of ConstraintRows in batches that go through the phases of a sweep together.
 */
#ifndef ipia_RowBatches_h
#define ipia_RowBatches_h

#include "ConstraintRows.h"

#include <vector>

namespace ipia
{
template <int Dim>
class RowBatches
{
public:
  /// So many rows that no phase waits for the one before, so few that what they hand on stays in
  /// the nearest cache.
  static constexpr int MostRows = 32;

  /// Rows [Begin, End) of a batch, which share a cell.
  struct Part
  {
    std::int64_t Coefficient; ///< as ConstraintRows::Cell has it
    std::int64_t Row;         ///< the first, in ConstraintRows
    std::int16_t Begin, End;
    bool Follows; ///< the next cell along y after that of the part before, in the same batch
  };

  explicit RowBatches(const ConstraintRows<Dim>& rows);

  /// Batches of tile t: tileBegin(t) up to tileBegin(t + 1).
  std::int64_t tileBegin(std::int64_t tile) const
  {
    return this->TileBegin[static_cast<std::size_t>(tile)];
  }
  std::int64_t numberOfBatches() const
  {
    return static_cast<std::int64_t>(this->BatchBegin.size()) - 1;
  }

  /// Parts of batch b: parts()[batchBegin()[b]] up to parts()[batchBegin()[b + 1]].
  const Part* parts() const { return this->Parts.data(); }
  const std::int64_t* batchBegin() const { return this->BatchBegin.data(); }

private:
  std::vector<Part> Parts;
  std::vector<std::int64_t> BatchBegin, TileBegin; // one more than there are
};
}

#endif
