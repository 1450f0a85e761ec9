// SPDX-License-Identifier: BSD-3-Clause
#include "BrickLattice.h"

#include "Parallel.h"

#include <bitset>

namespace ipia
{
namespace
{
/// Calls action with every index of a box, x fastest.
template <int Dim, typename Action>
void forBox(const Index<Dim>& first, const Index<Dim>& last, const Action& action)
{
  Index<Dim> i = first;
  for (;;)
  {
    action(i);
    int a = 0;
    while (a < Dim && ++i[a] > last[a])
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

/// The bits of a brick whose coordinate along an axis lies in [first, last] (0 to 3).
template <int Dim>
std::uint64_t slab(int axis, std::int64_t first, std::int64_t last)
{
  std::uint64_t bits = 0;
  for (int k = 0; k < BrickSize<Dim>; ++k)
  {
    const int at = k >> (2 * axis) & 3;
    bits |= std::uint64_t{ at >= first && at <= last } << k;
  }
  return bits;
}

/// slab() for all arguments.
template <int Dim>
struct SlabTable
{
  std::uint64_t Bits[Dim][BrickWidth][BrickWidth];

  SlabTable()
  {
    for (int a = 0; a < Dim; ++a)
    {
      for (int first = 0; first < BrickWidth; ++first)
      {
        for (int last = 0; last < BrickWidth; ++last)
        {
          this->Bits[a][first][last] = slab<Dim>(a, first, last);
        }
      }
    }
  }

  static const SlabTable& instance()
  {
    static const SlabTable table;
    return table;
  }
};
}

template <int Dim>
BrickLattice<Dim>::BrickLattice(const Lattice<Dim>& lattice)
  : Grid(lattice)
{
  std::int64_t total = 1;
  for (int a = 0; a < Dim; ++a)
  {
    this->BrickCount[a] = (lattice.Size[a] + BrickWidth - 1) / BrickWidth;
    total *= this->BrickCount[a];
  }
  this->Map.assign(static_cast<std::size_t>(total), Absent);
}

template <int Dim>
void BrickLattice<Dim>::activateAll()
{
  Index<Dim> last = this->BrickCount;
  for (auto& n : last)
  {
    --n;
  }
  forBox<Dim>(Index<Dim>{}, last,
    [this](const Index<Dim>& brick)
    {
      std::uint64_t mask = ~std::uint64_t{ 0 };
      for (int a = 0; a < Dim; ++a)
      {
        const std::int64_t end =
          std::min<std::int64_t>(this->Grid.Size[a] - brick[a] * BrickWidth, BrickWidth);
        mask &= SlabTable<Dim>::instance().Bits[a][0][end - 1];
      }
      this->Map[this->flatBrick(brick)] = static_cast<std::int32_t>(this->Marks.size());
      this->Marks.push_back(mask);
    });
}

template <int Dim>
void BrickLattice<Dim>::activateAround(const Index<Dim>& cell)
{
  // Six coefficients of an axis lie in no more than three bricks.
  constexpr std::size_t most = 3;
  Index<Dim> first, last;
  std::array<std::array<std::uint64_t, most>, Dim> bits;
  for (std::size_t a = 0; a < Dim; ++a)
  {
    const std::int64_t low = std::max<std::int64_t>(cell[a] - 1, 0);
    const std::int64_t high = std::min(cell[a] + Order, this->Grid.Size[a] - 1);
    first[a] = low / BrickWidth;
    last[a] = high / BrickWidth;
    for (std::int64_t brick = first[a]; brick <= last[a]; ++brick)
    {
      const std::int64_t from = std::max<std::int64_t>(low - brick * BrickWidth, 0);
      const std::int64_t to = std::min<std::int64_t>(high - brick * BrickWidth, BrickWidth - 1);
      bits[a][static_cast<std::size_t>(brick - first[a])] =
        SlabTable<Dim>::instance().Bits[a][from][to];
    }
  }
  forBox<Dim>(first, last,
    [&](const Index<Dim>& brick)
    {
      std::uint64_t mask = ~std::uint64_t{ 0 };
      for (std::size_t a = 0; a < Dim; ++a)
      {
        mask &= bits[a][static_cast<std::size_t>(brick[a] - first[a])];
      }
      this->activate(brick, mask);
    });
}

template <int Dim>
void BrickLattice<Dim>::activate(const Index<Dim>& brick, std::uint64_t mask)
{
  std::int32_t& id = this->Map[this->flatBrick(brick)];
  if (id == Absent)
  {
    id = static_cast<std::int32_t>(this->Marks.size());
    this->Marks.push_back(0);
  }
  this->Marks[static_cast<std::size_t>(id)] |= mask;
}

template <int Dim>
void BrickLattice<Dim>::storeAroundActive()
{
  const std::vector<std::int32_t> before = this->Map;
  Index<Dim> end = this->BrickCount;
  for (auto& n : end)
  {
    --n;
  }
  forBox<Dim>(Index<Dim>{}, end,
    [&](const Index<Dim>& brick)
    {
      const std::int32_t id = before[this->flatBrick(brick)];
      if (id == Absent || this->Marks[static_cast<std::size_t>(id)] == 0)
      {
        return;
      }
      Index<Dim> first, last;
      for (int a = 0; a < Dim; ++a)
      {
        first[a] = std::max<std::int64_t>(brick[a] - 1, 0);
        last[a] = std::min(brick[a] + 1, this->BrickCount[a] - 1);
      }
      forBox<Dim>(first, last,
        [&](const Index<Dim>& neighbour)
        {
          std::int32_t& mark = this->Map[this->flatBrick(neighbour)];
          if (mark == Absent)
          {
            mark = static_cast<std::int32_t>(this->Marks.size());
            this->Marks.push_back(0);
          }
        });
    });
}

template <int Dim>
void BrickLattice<Dim>::bricksForRefinement(
  const Index<Dim>& finer, Index<Dim>& first, Index<Dim>& last) const
{
  // Fine coefficients 4b .. 4b + 3 read the coarse ones 2b .. 2b + 3.
  for (std::size_t a = 0; a < Dim; ++a)
  {
    first[a] = std::min(2 * finer[a] / BrickWidth, this->BrickCount[a] - 1);
    last[a] = std::min((2 * finer[a] + 3) / BrickWidth, this->BrickCount[a] - 1);
  }
}

template <int Dim>
void BrickLattice<Dim>::storeForRefinement(const BrickLattice& finer)
{
  for (const Index<Dim>& brick : finer.Position)
  {
    Index<Dim> first, last;
    this->bricksForRefinement(brick, first, last);
    forBox<Dim>(first, last,
      [this](const Index<Dim>& coarse)
      {
        std::int32_t& mark = this->Map[this->flatBrick(coarse)];
        if (mark == Absent)
        {
          mark = static_cast<std::int32_t>(this->Marks.size());
          this->Marks.push_back(0);
        }
      });
  }
}

template <int Dim>
void BrickLattice<Dim>::allocate(int threads)
{
  Index<Dim> end = this->BrickCount;
  for (auto& n : end)
  {
    --n;
  }
  std::vector<std::uint64_t> marks;
  marks.swap(this->Marks);
  std::vector<std::int32_t> map(this->Map.size(), Absent);
  for (const bool active : { true, false })
  {
    forBox<Dim>(Index<Dim>{}, end,
      [&](const Index<Dim>& brick)
      {
        const std::size_t flat = this->flatBrick(brick);
        const std::int32_t mark = this->Map[flat];
        if (mark != Absent && (marks[static_cast<std::size_t>(mark)] != 0) == active)
        {
          map[flat] = static_cast<std::int32_t>(this->Position.size());
          this->Position.push_back(brick);
          this->Mask.push_back(marks[static_cast<std::size_t>(mark)]);
        }
      });
    if (active)
    {
      this->ActiveCount = static_cast<std::int32_t>(this->Position.size());
    }
  }
  this->Map.swap(map);
  this->findNeighbours(threads);
  this->Coefficients.resize(this->Position.size() * BrickSize<Dim>);
  parallelChunks(static_cast<std::int64_t>(this->Coefficients.size()), threads,
    [this](std::int64_t from, std::int64_t to)
    { std::fill(this->Coefficients.begin() + from, this->Coefficients.begin() + to, 0.F); });
}

template <int Dim>
void BrickLattice<Dim>::findNeighbours(int threads)
{
  // In the map, from a brick that has all of them.
  std::array<std::int64_t, NeighbourCount> step{};
  std::array<Index<Dim>, NeighbourCount> offset;
  for (std::size_t k = 0; k < step.size(); ++k)
  {
    std::int64_t stride = 1, rest = static_cast<std::int64_t>(k);
    for (std::size_t a = 0; a < Dim; ++a, rest /= 3)
    {
      offset[k][a] = rest % 3 - 1;
      step[k] += offset[k][a] * stride;
      stride *= this->BrickCount[a];
    }
  }
  this->Neighbours.resize(this->Position.size());
  parallelChunks(this->numberOfBricks(), threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (auto b = static_cast<std::size_t>(begin); b < static_cast<std::size_t>(end); ++b)
      {
        const Index<Dim>& brick = this->Position[b];
        bool inside = true;
        for (std::size_t a = 0; a < Dim; ++a)
        {
          inside = inside && brick[a] > 0 && brick[a] + 1 < this->BrickCount[a];
        }
        const std::int32_t* const at = this->Map.data() + this->flatBrick(brick);
        for (std::size_t k = 0; k < step.size(); ++k)
        {
          Index<Dim> neighbour = brick;
          for (std::size_t a = 0; a < Dim; ++a)
          {
            neighbour[a] += offset[k][a];
          }
          this->Neighbours[b][k] = inside ? at[step[k]] : this->brickAt(neighbour);
        }
      }
    });
}

template <int Dim>
std::int64_t BrickLattice<Dim>::numberOfActiveCoefficients() const
{
  std::int64_t n = 0;
  for (std::int32_t b = 0; b < this->ActiveCount; ++b)
  {
    n += static_cast<std::int64_t>(std::bitset<64>(this->activeMask(b)).count());
  }
  return n;
}

template <int Dim>
void BrickLattice<Dim>::refineFrom(const BrickLattice& coarser, int threads)
{
  this->refine(coarser, coarser.Coefficients, {}, threads, this->Coefficients);
}

template <int Dim>
std::vector<char> BrickLattice<Dim>::readers(
  const BrickLattice& coarser, const std::vector<char>& marked) const
{
  std::vector<char> reads(this->Position.size(), 0);
  for (std::size_t b = 0; b < reads.size(); ++b)
  {
    Index<Dim> first, last;
    coarser.bricksForRefinement(this->Position[b], first, last);
    forBox<Dim>(first, last,
      [&](const Index<Dim>& brick)
      {
        const std::int32_t id = coarser.brickAt(brick);
        reads[b] |= static_cast<char>(id != Absent && marked[static_cast<std::size_t>(id)] != 0);
      });
  }
  return reads;
}

template <int Dim>
void BrickLattice<Dim>::refine(const BrickLattice& coarser, const BrickValues& coarse,
  const std::vector<char>& marked, int threads, BrickValues& fine) const
{
  // Coarse coefficients 2b .. 2b + 3 of an axis give the four fine ones of brick b.
  const auto refineAxis = [](const float* in, float* out, int stride, int before, int after)
  {
    for (int o = 0; o < after; ++o)
    {
      for (int i = 0; i < before; ++i)
      {
        const float* c = in + o * BrickWidth * stride + i;
        float* f = out + o * BrickWidth * stride + i;
        f[0] = 0.5F * (c[0] + c[stride]);
        f[stride] = 0.125F * (c[0] + c[2 * stride]) + 0.75F * c[stride];
        f[2 * stride] = 0.5F * (c[stride] + c[2 * stride]);
        f[3 * stride] = 0.125F * (c[stride] + c[3 * stride]) + 0.75F * c[2 * stride];
      }
    }
  };
#pragma omp parallel for schedule(static) num_threads(threads)
  for (std::int32_t b = 0; b < this->numberOfBricks(); ++b)
  {
    if (!marked.empty() && marked[static_cast<std::size_t>(b)] == 0)
    {
      continue;
    }
    const Index<Dim>& brick = this->position(b);
    // What it reads lies in no more than two bricks an axis.
    Index<Dim> low{};
    std::array<std::array<int, BrickWidth>, Dim> upper, inside;
    for (std::size_t a = 0; a < Dim; ++a)
    {
      for (std::size_t i = 0; i < BrickWidth; ++i)
      {
        // Fine coefficients beyond the lattice may ask for coarse ones beyond it; they do not
        // count.
        const std::int64_t c =
          std::min(2 * brick[a] + static_cast<std::int64_t>(i), coarser.Grid.Size[a] - 1);
        low[a] = i == 0 ? c / BrickWidth : low[a];
        upper[a][i] = static_cast<int>(c / BrickWidth - low[a]) << a;
        inside[a][i] = static_cast<int>(c % BrickWidth) << (2 * a);
      }
    }
    std::array<const float*, 1 << Dim> from;
    for (std::size_t child = 0; child < from.size(); ++child)
    {
      Index<Dim> at = low;
      for (std::size_t a = 0; a < Dim; ++a)
      {
        at[a] += static_cast<std::int64_t>(child >> a & 1);
      }
      const std::int32_t id = coarser.brickAt(at);
      from[child] =
        id == Absent ? nullptr : coarse.data() + static_cast<std::int64_t>(id) * BrickSize<Dim>;
    }
    float read[BrickSize<Dim>];
    for (int k = 0; k < BrickSize<Dim>; ++k)
    {
      int child = 0, at = 0;
      for (std::size_t a = 0; a < Dim; ++a)
      {
        const auto i = static_cast<std::size_t>(k >> (2 * a) & 3);
        child |= upper[a][i];
        at |= inside[a][i];
      }
      read[k] = from[static_cast<std::size_t>(child)][at];
    }
    float first[BrickSize<Dim>];
    float* out = fine.data() + static_cast<std::int64_t>(b) * BrickSize<Dim>;
    refineAxis(read, first, 1, 1, BrickSize<Dim> / 4);
    if (Dim == 2)
    {
      refineAxis(first, out, 4, 4, 1);
    }
    else
    {
      refineAxis(first, read, 4, 4, 4);
      refineAxis(read, out, 16, 16, 1);
    }
  }
}

template <int Dim>
int BrickLattice<Dim>::countActive(const Index<Dim>& cell) const
{
  std::size_t count = 0;
  Index<Dim> first, last;
  for (std::size_t a = 0; a < Dim; ++a)
  {
    first[a] = cell[a] / BrickWidth;
    last[a] = (cell[a] + Order - 1) / BrickWidth;
  }
  forBox<Dim>(first, last,
    [&](const Index<Dim>& brick)
    {
      const std::int32_t id = this->brickAt(brick);
      if (id == Absent || id >= this->ActiveCount)
      {
        return;
      }
      std::uint64_t mask = this->activeMask(id);
      for (std::size_t a = 0; a < Dim; ++a)
      {
        const std::int64_t from = std::max<std::int64_t>(cell[a] - brick[a] * BrickWidth, 0);
        const std::int64_t to =
          std::min<std::int64_t>(cell[a] + Order - 1 - brick[a] * BrickWidth, BrickWidth - 1);
        mask &= SlabTable<Dim>::instance().Bits[a][from][to];
      }
      count += std::bitset<64>(mask).count();
    });
  return static_cast<int>(count);
}

template <int Dim>
bool BrickLattice<Dim>::covers(const Index<Dim>& cell) const
{
  bool covered = true;
  Index<Dim> first, last;
  for (int a = 0; a < Dim; ++a)
  {
    first[a] = cell[a] / BrickWidth;
    last[a] = (cell[a] + Order - 1) / BrickWidth;
  }
  forBox<Dim>(first, last,
    [&](const Index<Dim>& brick) { covered = covered && this->brickAt(brick) != Absent; });
  return covered;
}

template class BrickLattice<2>;
template class BrickLattice<3>;
}
