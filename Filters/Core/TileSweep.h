// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A sweep over the tiles of rows on several threads.
 */
#ifndef ipia_TileSweep_h
#define ipia_TileSweep_h

#include "ConstraintRows.h"

#include <vector>

namespace ipia
{
/// Calls body(tile), which returns an energy, for all tiles, those of one colour at the same time.
/// Returns the sum of the energies, added in order, whatever the number of threads.
template <int Dim, typename Body>
double sweepTiles(const ConstraintRows<Dim>& rows, int threads, const Body& body)
{
  std::vector<double> energies(static_cast<std::size_t>(rows.numberOfTiles()), 0.0);
#pragma omp parallel num_threads(threads)
  for (int colour = 0; colour < ConstraintRows<Dim>::NumberOfColours; ++colour)
  {
    const std::int64_t last = rows.tileOfColour(colour + 1);
#pragma omp for schedule(dynamic)
    for (std::int64_t tile = rows.tileOfColour(colour); tile < last; ++tile)
    {
      energies[static_cast<std::size_t>(tile)] = body(tile);
    }
  }
  double energy = 0;
  for (double e : energies)
  {
    energy += e;
  }
  return energy;
}
}

#endif
