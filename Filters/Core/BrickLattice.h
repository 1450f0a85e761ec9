// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A control lattice of which only a band is stored, in bricks of 4^Dim coefficients.
 *
 * Bricks are active, stored or absent. Active ones hold coefficients that a level solves for (their
 * mask says which); stored ones complete the knot cells that active coefficients reach and keep the
 * values inherited from the coarser level. Where bricks are absent, the coarser level is the
 * function, and since inherited coefficients represent it exactly, f is twice continuously
 * differentiable across the border of the band.
 */
#ifndef ipia_BrickLattice_h
#define ipia_BrickLattice_h

#include "BulkVector.h"
#include "Lattice.h"

#include <vector>

namespace ipia
{
/// Coefficients per axis and in all of a brick. The width equals the spline's order, so that the
/// cells of a brick reach into no more than the next brick on every axis.
constexpr int BrickWidth = 4;
template <int Dim>
constexpr int BrickSize = Dim == 2 ? 16 : 64;

/// A window of coefficients: rows of 8 along x, 8 of them along y, and in 3-D 8 slices.
constexpr int WindowWidth = 8;
template <int Dim>
constexpr int WindowSize = Dim == 2 ? 64 : 512;

/// BrickSize values per brick, or some per row.
using BrickValues = BulkVector<float>;

template <int Dim>
class BrickLattice
{
public:
  static constexpr std::int32_t Absent = -1;
  /// Neighbours of a brick and itself: offsets -1, 0, +1 per axis, x fastest.
  static constexpr int NeighbourCount = Dim == 2 ? 9 : 27;

  explicit BrickLattice(const Lattice<Dim>& lattice);

  const Lattice<Dim>& lattice() const { return this->Grid; }
  const Index<Dim>& bricksPerAxis() const { return this->BrickCount; }

  /// Marks all coefficients as active.
  void activateAll();

  /// Marks the coefficients of all cells within one cell of @a cell as active.
  void activateAround(const Index<Dim>& cell);

  /// Marks coefficients of one brick as active.
  void activate(const Index<Dim>& brick, std::uint64_t mask);

  /// Adds the bricks that complete the cells around active ones.
  void storeAroundActive();

  /// Adds the bricks that the refinement to the given, finer lattice reads.
  void storeForRefinement(const BrickLattice& finer);

  /// Ends the marking: bricks get their final numbers, active ones first, both in lexicographic
  /// order. Coefficients are 0.
  void allocate(int threads = 1);

  std::int32_t numberOfActiveBricks() const { return this->ActiveCount; }
  std::int32_t numberOfBricks() const { return static_cast<std::int32_t>(this->Position.size()); }
  std::int64_t numberOfActiveCoefficients() const;

  std::int32_t brickAt(const Index<Dim>& brick) const
  {
    std::int64_t index = 0;
    for (int a = Dim - 1; a >= 0; --a)
    {
      if (brick[a] < 0 || brick[a] >= this->BrickCount[a])
      {
        return Absent;
      }
      index = index * this->BrickCount[a] + brick[a];
    }
    return this->Map[static_cast<std::size_t>(index)];
  }

  const Index<Dim>& position(std::int32_t brick) const
  {
    return this->Position[static_cast<std::size_t>(brick)];
  }
  const std::array<std::int32_t, NeighbourCount>& neighbours(std::int32_t brick) const
  {
    return this->Neighbours[static_cast<std::size_t>(brick)];
  }
  /// One bit per coefficient of the brick.
  std::uint64_t activeMask(std::int32_t brick) const
  {
    return this->Mask[static_cast<std::size_t>(brick)];
  }

  /// All stored coefficients, brick by brick.
  BrickValues& coefficients() { return this->Coefficients; }
  const BrickValues& coefficients() const { return this->Coefficients; }

  /// Fills all stored bricks with the exact knot refinement of the coarser lattice.
  void refineFrom(const BrickLattice& coarser, int threads);

  /// The refinement of other coefficients of the coarser lattice.
  ///
  /// @param coarse  BrickSize values per brick of the coarser lattice
  /// @param marked  one per brick: whether to refine it; empty: all
  /// @param fine    as many values per brick; those of other bricks stay
  void refine(const BrickLattice& coarser, const BrickValues& coarse,
    const std::vector<char>& marked, int threads, BrickValues& fine) const;

  /// One per brick: whether its refinement reads a marked brick of the coarser lattice.
  std::vector<char> readers(const BrickLattice& coarser, const std::vector<char>& marked) const;

  /// How many of the BrickSize coefficients of a knot cell are active.
  int countActive(const Index<Dim>& cell) const;

  /// Whether all coefficients of a knot cell are stored.
  bool covers(const Index<Dim>& cell) const;

private:
  void findNeighbours(int threads);

  /// The bricks, from first to last, that the refinement to a finer lattice's brick reads.
  void bricksForRefinement(const Index<Dim>& finer, Index<Dim>& first, Index<Dim>& last) const;

  std::size_t flatBrick(const Index<Dim>& brick) const
  {
    std::int64_t index = 0;
    for (int a = Dim - 1; a >= 0; --a)
    {
      index = index * this->BrickCount[a] + brick[a];
    }
    return static_cast<std::size_t>(index);
  }

  Lattice<Dim> Grid;
  Index<Dim> BrickCount{};
  std::vector<std::int32_t> Map;
  std::vector<std::uint64_t> Marks; // while marking: the mask of each brick that is stored
  std::vector<Index<Dim>> Position;
  std::vector<std::uint64_t> Mask;
  BulkVector<std::array<std::int32_t, NeighbourCount>> Neighbours;
  BrickValues Coefficients;
  std::int32_t ActiveCount = 0;
};
}

#endif
