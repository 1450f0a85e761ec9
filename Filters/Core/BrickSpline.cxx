// SPDX-License-Identifier: BSD-3-Clause
#include "BrickSpline.h"

#include "CubicBasis.h"
#include "KnotRefinement.h"
#include "OutsideDomain.h"

namespace ipia
{
namespace
{
/// The search is divided into at least this many parts where there are so many blocks.
constexpr std::size_t LeastParts = 64;

/// Calls action with every index in [first, end), x fastest.
template <int Dim, typename Action>
void forRange(const Index<Dim>& first, const Index<Dim>& end, const Action& action)
{
  Index<Dim> i = first;
  for (int a = 0; a < Dim; ++a)
  {
    if (first[a] >= end[a])
    {
      return;
    }
  }
  for (;;)
  {
    action(i);
    int a = 0;
    while (a < Dim && ++i[a] == end[a])
    {
      i[a] = first[a];
      ++a;
    }
    if (a == Dim)
    {
      return;
    }
  }
}

template <int Dim>
std::int64_t flatIndex(const Index<Dim>& i, const Index<Dim>& count)
{
  std::int64_t index = 0;
  for (int a = Dim - 1; a >= 0; --a)
  {
    index = index * count[a] + i[a];
  }
  return index;
}

/// Refines one axis of an array: lines of @a count values with the given stride. The first fine
/// value is @a margin (1) before the fine one that lies on coarse @a offset + margin.
void refineAxis(const double* in, double* out, std::int64_t lines, std::int64_t lineLength,
  std::int64_t count, std::int64_t offset)
{
  for (std::int64_t line = 0; line < lines; ++line)
  {
    const double* from = in + (line * count + offset) * lineLength;
    double* to = out + line * count * lineLength;
    for (std::int64_t i = 0; i < count; ++i, to += lineLength)
    {
      // Fine coefficient i - 1 of the block: an odd one where i is even.
      const double* c = from + (i + 1) / 2 * lineLength;
      if (i % 2 == 1)
      {
        for (std::int64_t k = 0; k < lineLength; ++k)
        {
          to[k] = 0.5 * (c[k] + c[k + lineLength]);
        }
      }
      else
      {
        for (std::int64_t k = 0; k < lineLength; ++k)
        {
          to[k] = 0.125 * (c[k] + c[k + 2 * lineLength]) + 0.75 * c[k + lineLength];
        }
      }
    }
  }
}
}

template <int Dim>
BrickSpline<Dim>::BrickSpline(std::vector<BrickLattice<Dim>> levels)
  : Levels(std::move(levels))
{
  this->markCorrections();
}

template <int Dim>
Index<Dim> BrickSpline<Dim>::blocksPerAxis(std::size_t level) const
{
  Index<Dim> count;
  for (int a = 0; a < Dim; ++a)
  {
    count[a] = (this->Levels[level].lattice().cells(a) + BlockCells - 1) / BlockCells;
  }
  return count;
}

template <int Dim>
void BrickSpline<Dim>::markCorrections()
{
  this->Corrected.resize(this->Levels.size());
  for (std::size_t l = this->Levels.size(); l-- > 0;)
  {
    const Index<Dim> count = this->blocksPerAxis(l);
    std::int64_t total = 1;
    for (std::int64_t n : count)
    {
      total *= n;
    }
    this->Corrected[l].assign(static_cast<std::size_t>(total), 0);
    if (l + 1 == this->Levels.size())
    {
      continue;
    }
    const Index<Dim> fineCount = this->blocksPerAxis(l + 1);
    const auto mark = [&](const Index<Dim>& fine)
    {
      Index<Dim> block;
      for (int a = 0; a < Dim; ++a)
      {
        block[a] = fine[a] / 2;
      }
      this->Corrected[l][static_cast<std::size_t>(flatIndex<Dim>(block, count))] = 1;
    };
    forRange<Dim>(Index<Dim>{}, fineCount,
      [&](const Index<Dim>& fine)
      {
        if (this->Corrected[l + 1][static_cast<std::size_t>(flatIndex<Dim>(fine, fineCount))])
        {
          mark(fine);
        }
      });
    const BrickLattice<Dim>& bricks = this->Levels[l + 1];
    for (std::int32_t b = 0; b < bricks.numberOfActiveBricks(); ++b)
    {
      // Coefficient i reaches the cells i - 3 to i.
      Index<Dim> first, end;
      for (int a = 0; a < Dim; ++a)
      {
        const std::int64_t coefficient = bricks.position(b)[a] * BrickWidth;
        first[a] = std::max<std::int64_t>(coefficient - Order + 1, 0) / BlockCells;
        end[a] = std::min((coefficient + BrickWidth - 1) / BlockCells, fineCount[a] - 1) + 1;
      }
      forRange<Dim>(first, end, mark);
    }
  }
}

template <int Dim>
void BrickSpline<Dim>::readStored(Block& block) const
{
  const BrickLattice<Dim>& bricks = this->Levels[block.Level];
  Index<Dim> first, end;
  for (int a = 0; a < Dim; ++a)
  {
    first[a] = std::max<std::int64_t>(block.Cell[a] - Margin, 0) / BrickWidth;
    end[a] = std::min(
      (block.Cell[a] - Margin + BlockSize - 1) / BrickWidth + 1, bricks.bricksPerAxis()[a]);
  }
  forRange<Dim>(first, end,
    [&](const Index<Dim>& position)
    {
      const std::int32_t id = bricks.brickAt(position);
      if (id == BrickLattice<Dim>::Absent)
      {
        return;
      }
      const float* from =
        bricks.coefficients().data() + static_cast<std::int64_t>(id) * BrickSize<Dim>;
      // What the brick and the block have in common.
      std::int64_t source = 0, target = 0, stride = 1, brickStride = 1;
      std::array<std::int64_t, 3> count{ 1, 1, 1 };
      for (int a = 0; a < Dim; ++a)
      {
        const std::int64_t at = position[a] * BrickWidth - (block.Cell[a] - Margin);
        const std::int64_t begin = std::max<std::int64_t>(-at, 0);
        count[static_cast<std::size_t>(a)] =
          std::min<std::int64_t>(BlockSize - at, BrickWidth) - begin;
        source += begin * brickStride;
        target += (at + begin) * stride;
        stride *= BlockSize;
        brickStride *= BrickWidth;
      }
      for (std::int64_t z = 0; z < count[2]; ++z)
      {
        for (std::int64_t y = 0; y < count[1]; ++y)
        {
          std::copy_n(from + source + (z * BrickWidth + y) * BrickWidth, count[0],
            block.Coefficients.data() + target + (z * BlockSize + y) * BlockSize);
        }
      }
    });
}

template <int Dim>
bool BrickSpline<Dim>::mayHaveZeros(const Block& block) const
{
  const Lattice<Dim>& lattice = this->Levels[block.Level].lattice();
  Index<Dim> size, at;
  for (int a = 0; a < Dim; ++a)
  {
    at[a] = block.Cell[a] / BlockCells;
    size[a] = std::min(BlockCells + Order - 1, lattice.Size[a] - block.Cell[a]);
  }
  if (this->Corrected[block.Level][static_cast<std::size_t>(
        flatIndex<Dim>(at, this->blocksPerAxis(block.Level)))])
  {
    return true;
  }
  bool negative = false, other = false;
  Index<Dim> end = size;
  end[0] = 1;
  forRange<Dim>(Index<Dim>{}, end,
    [&](const Index<Dim>& line)
    {
      Index<Dim> all;
      all.fill(BlockSize);
      Index<Dim> first = line;
      for (int a = 0; a < Dim; ++a)
      {
        first[a] += Margin;
      }
      const double* c = block.Coefficients.data() + flatIndex<Dim>(first, all);
      for (std::int64_t i = 0; i < size[0]; ++i)
      {
        negative = negative || c[i] < 0;
        other = other || !(c[i] < 0);
      }
    });
  return negative && other;
}

template <int Dim>
std::vector<typename BrickSpline<Dim>::Block> BrickSpline<Dim>::children(const Block& block) const
{
  std::vector<Block> found;
  const Lattice<Dim>& lattice = this->Levels[block.Level + 1].lattice();
  std::vector<double> first, second;
  Index<Dim> two;
  two.fill(2);
  forRange<Dim>(Index<Dim>{}, two,
    [&](const Index<Dim>& half)
    {
      Block child{ block.Level + 1, {}, {} };
      std::int64_t total = 1;
      for (int a = 0; a < Dim; ++a)
      {
        child.Cell[a] = 2 * block.Cell[a] + half[a] * BlockCells;
        if (child.Cell[a] >= lattice.cells(a))
        {
          return;
        }
        total *= BlockSize;
      }
      const double* in = block.Coefficients.data();
      std::int64_t lines = total / BlockSize, lineLength = 1;
      first.resize(static_cast<std::size_t>(total));
      second.resize(static_cast<std::size_t>(total));
      for (int a = 0; a < Dim; ++a)
      {
        std::vector<double>& out = a % 2 == 0 ? first : second;
        refineAxis(in, out.data(), lines, lineLength, BlockSize, half[a] * BlockCells / 2);
        in = out.data();
        lines /= BlockSize;
        lineLength *= BlockSize;
      }
      child.Coefficients.assign(in, in + total);
      this->readStored(child);
      if (this->mayHaveZeros(child))
      {
        found.push_back(std::move(child));
      }
    });
  return found;
}

template <int Dim>
std::vector<typename BrickSpline<Dim>::Block> BrickSpline<Dim>::zeroSetParts() const
{
  std::vector<Block> parts;
  forRange<Dim>(Index<Dim>{}, this->blocksPerAxis(0),
    [&](const Index<Dim>& position)
    {
      Block block{ 0, {}, {} };
      std::int64_t total = 1;
      for (int a = 0; a < Dim; ++a)
      {
        block.Cell[a] = position[a] * BlockCells;
        total *= BlockSize;
      }
      block.Coefficients.assign(static_cast<std::size_t>(total), 0.0);
      this->readStored(block);
      if (this->mayHaveZeros(block))
      {
        parts.push_back(std::move(block));
      }
    });
  for (std::size_t l = 0; l + 1 < this->Levels.size() && parts.size() < LeastParts; ++l)
  {
    std::vector<Block> finer;
    for (const Block& block : parts)
    {
      for (Block& child : this->children(block))
      {
        finer.push_back(std::move(child));
      }
    }
    parts.swap(finer);
  }
  return parts;
}

template <int Dim>
typename BrickSpline<Dim>::BlockFunction BrickSpline<Dim>::blockFunction(const Block& block) const
{
  BlockFunction function;
  Lattice<Dim> local;
  local.Spacing.setOnes();
  Index<Dim> first, end, all;
  for (int a = 0; a < Dim; ++a)
  {
    const std::int64_t cells = this->lattice().cells(a);
    const std::int64_t last = std::min(block.Cell[a] + BlockCells, cells);
    function.Corner[a] = std::max<std::int64_t>(block.Cell[a] - Margin, 0);
    function.Begin[a] = block.Cell[a] - function.Corner[a];
    function.End[a] = last - function.Corner[a];
    local.Size[a] = std::min(last + Margin, cells) - function.Corner[a] + Order - 1;
    first[a] = function.Corner[a] - (block.Cell[a] - Margin);
    end[a] = first[a] + local.Size[a];
    all[a] = BlockSize;
  }
  Vector coefficients(local.numberOfCoefficients());
  std::int64_t next = 0;
  Index<Dim> lineEnd = end;
  lineEnd[0] = first[0] + 1;
  forRange<Dim>(first, lineEnd,
    [&](const Index<Dim>& line)
    {
      std::copy_n(block.Coefficients.data() + flatIndex<Dim>(line, all), local.Size[0],
        coefficients.data() + next);
      next += local.Size[0];
    });
  function.Spline = ImplicitSpline<Dim>(local, std::move(coefficients));
  return function;
}

template <int Dim>
Vector BrickSpline<Dim>::coefficients() const
{
  Vector coefficients;
  for (std::size_t l = 0; l < this->Levels.size(); ++l)
  {
    const Lattice<Dim>& fine = this->Levels[l].lattice();
    coefficients = l == 0 ? Vector(Vector::Zero(fine.numberOfCoefficients()))
                          : refineKnots(this->Levels[l - 1].lattice(), coefficients, fine);
    for (std::int32_t b = 0; b < this->Levels[l].numberOfBricks(); ++b)
    {
      const float* from =
        this->Levels[l].coefficients().data() + static_cast<std::int64_t>(b) * BrickSize<Dim>;
      Index<Dim> first, end;
      for (int a = 0; a < Dim; ++a)
      {
        first[a] = this->Levels[l].position(b)[a] * BrickWidth;
        end[a] = std::min(first[a] + BrickWidth, fine.Size[a]);
      }
      forRange<Dim>(first, end,
        [&](const Index<Dim>& at)
        {
          std::int64_t inside = 0;
          for (int a = Dim - 1; a >= 0; --a)
          {
            inside = inside * BrickWidth + at[a] - first[a];
          }
          coefficients[fine.coefficientIndex(at)] = from[inside];
        });
    }
  }
  return coefficients;
}

template <int Dim>
double BrickSpline<Dim>::value(const Point<Dim>& position) const
{
  Point<Dim> gradient;
  return this->valueAndGradient(position, gradient);
}

template <int Dim>
double BrickSpline<Dim>::valueAndGradient(const Point<Dim>& position, Point<Dim>& gradient) const
{
  Point<Dim> nearest = position;
  for (int a = 0; a < Dim; ++a)
  {
    nearest[a] = std::min(std::max(position[a], 0.0), this->lattice().extent(a));
  }
  std::size_t l = this->Levels.size();
  Index<Dim> cell, end;
  std::array<BasisValues, Dim> w, d;
  do
  {
    --l;
    for (int a = 0; a < Dim; ++a)
    {
      const auto i = static_cast<std::size_t>(a);
      const Lattice<Dim>& lattice = this->Levels[l].lattice();
      const AxisLocation at = lattice.locate(nearest[a], a);
      cell[i] = at.Cell;
      end[i] = at.Cell + Order;
      w[i] = cubicBasis(at.T);
      d[i] = cubicBasisFirstDerivative(at.T);
    }
  } while (l > 0 && !this->Levels[l].covers(cell));

  const BrickLattice<Dim>& bricks = this->Levels[l];
  double f = 0;
  gradient.setZero();
  forRange<Dim>(cell, end,
    [&](const Index<Dim>& at)
    {
      Index<Dim> brick;
      std::int64_t inside = 0;
      double product = 1;
      Point<Dim> derivative = Point<Dim>::Ones();
      for (int a = Dim - 1; a >= 0; --a)
      {
        const auto i = static_cast<std::size_t>(a);
        const auto k = static_cast<std::size_t>(at[i] - cell[i]);
        brick[i] = at[i] / BrickWidth;
        inside = inside * BrickWidth + at[i] % BrickWidth;
        product *= w[i][k];
        for (int b = 0; b < Dim; ++b)
        {
          derivative[b] *= a == b ? d[i][k] : w[i][k];
        }
      }
      const double c = bricks.coefficients()[static_cast<std::size_t>(
        static_cast<std::int64_t>(bricks.brickAt(brick)) * BrickSize<Dim> + inside)];
      f += c * product;
      gradient += c * derivative;
    });
  gradient = gradient.cwiseQuotient(bricks.lattice().Spacing).eval();
  return continueOutside<Dim>(position - nearest, f, &gradient);
}

template class BrickSpline<2>;
template class BrickSpline<3>;
}
