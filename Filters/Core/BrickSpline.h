// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The function of a hierarchy of brick lattices, without ever holding its finest lattice densely.
 */
#ifndef ipia_BrickSpline_h
#define ipia_BrickSpline_h

#include "BrickLattice.h"
#include "ImplicitSpline.h"

#include <vector>

namespace ipia
{
/**
 * f of all levels: in each knot cell the spline of the finest level that stores all of the cell's
 * coefficients. Since inherited coefficients represent the coarser level exactly, this is one
 * spline on the finest lattice. Beyond the domain f goes on as ImplicitSpline does.
 */
template <int Dim>
class BrickSpline
{
public:
  /// Cells per axis of the blocks that f is handed out in.
  static constexpr std::int64_t BlockCells = 16;

  /// @param levels  coarse to fine, each of half the spacing of the one before; all coefficients of
  ///                the first are stored
  explicit BrickSpline(std::vector<BrickLattice<Dim>> levels);

  /// The finest lattice.
  const Lattice<Dim>& lattice() const { return this->Levels.back().lattice(); }
  const std::vector<BrickLattice<Dim>>& levels() const { return this->Levels; }

  double value(const Point<Dim>& position) const;

  /// Both at once; returns f.
  double valueAndGradient(const Point<Dim>& position, Point<Dim>& gradient) const;

  /// The coefficients of the finest lattice, all of them.
  Vector coefficients() const;

  /// A block of knot cells of one level: its first cell, and the coefficients of its cells and of
  /// Margin more on every side. Those beyond the lattice have no meaning.
  struct Block
  {
    std::size_t Level;
    Index<Dim> Cell;
    std::vector<double> Coefficients;
  };

  /// f on a block of the finest level, with the cells around it as far as the domain goes.
  struct BlockFunction
  {
    Index<Dim> Corner; ///< the cell that Spline's domain begins with
    Index<Dim> Begin;  ///< the first cell of the block and the end of its cells, from there
    Index<Dim> End;
    ImplicitSpline<Dim> Spline; ///< of unit spacing: positions and derivatives are in cells
  };

  /**
   * A part of the search for the zero set: blocks of some level, in a fixed order, outside of which
   * f has no zeros. The coefficients of a spline bound its values, so that a block whose
   * coefficients have one sign, with no finer correction in it, is left out.
   */
  std::vector<Block> zeroSetParts() const;

  /**
   * Calls action(block) for the blocks of the finest level in @a part in which f may change sign.
   * Neighbouring blocks have the same bits where they share coefficients.
   */
  template <typename Action>
  void forZeroSetBlocks(const Block& part, const Action& action) const
  {
    if (part.Level + 1 == this->Levels.size())
    {
      action(part);
      return;
    }
    for (const Block& child : this->children(part))
    {
      this->forZeroSetBlocks(child, action);
    }
  }

  BlockFunction blockFunction(const Block& block) const;

private:
  /// Cells around a block that it knows f on, so that a position may leave it by a little.
  static constexpr std::int64_t Margin = 1;
  static constexpr std::int64_t BlockSize = BlockCells + 2 * Margin + Order - 1;

  std::vector<Block> children(const Block& block) const;
  void readStored(Block& block) const;
  bool mayHaveZeros(const Block& block) const;
  Index<Dim> blocksPerAxis(std::size_t level) const;
  void markCorrections();

  std::vector<BrickLattice<Dim>> Levels;
  /// Per level and block: whether a finer level corrects f in it.
  std::vector<std::vector<char>> Corrected;
};
}

#endif
