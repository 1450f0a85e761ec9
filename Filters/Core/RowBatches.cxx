// SPDX-License-Identifier: BSD-3-Clause
#include "RowBatches.h"

#include <algorithm>

namespace ipia
{
template <int Dim>
RowBatches<Dim>::RowBatches(const ConstraintRows<Dim>& rows)
{
  const std::int64_t sizeX = rows.lattice().Size[0];
  for (std::int64_t tile = 0; tile < rows.numberOfTiles(); ++tile)
  {
    this->TileBegin.push_back(static_cast<std::int64_t>(this->BatchBegin.size()));
    int inBatch = MostRows;
    for (std::int64_t c = rows.tileBegin(tile); c < rows.tileBegin(tile + 1); ++c)
    {
      const auto* const cell = rows.cells() + c;
      for (std::int64_t row = cell[0].Begin; row < cell[1].Begin;)
      {
        bool follows = true;
        if (inBatch == MostRows)
        {
          this->BatchBegin.push_back(static_cast<std::int64_t>(this->Parts.size()));
          inBatch = 0;
          follows = false;
        }
        const auto count =
          static_cast<int>(std::min<std::int64_t>(MostRows - inBatch, cell[1].Begin - row));
        follows = follows && cell->Coefficient == this->Parts.back().Coefficient + sizeX;
        this->Parts.push_back({ cell->Coefficient, row, static_cast<std::int16_t>(inBatch),
          static_cast<std::int16_t>(inBatch + count), follows });
        row += count;
        inBatch += count;
      }
    }
  }
  this->TileBegin.push_back(static_cast<std::int64_t>(this->BatchBegin.size()));
  this->BatchBegin.push_back(static_cast<std::int64_t>(this->Parts.size()));
}

template class RowBatches<2>;
template class RowBatches<3>;
}
