// SPDX-License-Identifier: BSD-3-Clause
#include "RationalOperator.h"

#include "Dispatch.h"
#include "Parallel.h"

#include <algorithm>
#include <cstring>

namespace ipia
{
namespace
{
enum class Sums
{
  Coefficients, // v (b - g) / d and v / d
  Weights       // v (g - b) / d and v (g - b) g / d
};

/// Rows that go through each phase together: so many that no phase waits for the one before, so few
/// that what they hand on stays in the nearest cache.
constexpr int BatchSize = 32;

/// Rows whose lanes are added up together, and lanes of a vector.
constexpr int GroupSize = 4, Lanes = 8;

/**
 * All rows of one tile. A vector holds pairs of numbers of four coefficients along x, numerator and
 * denominator or the two sums. The coefficients of a cell stay in registers while its rows of a
 * batch meet them.
 */
template <int Dim, Sums Kind>
struct RationalKernel
{
  static constexpr int Slices = Dim == 3 ? Order : 1;
  static constexpr int Lines = Slices * Order;

  /// Rows [Begin, End) of a batch, which share a cell.
  struct Part
  {
    std::int64_t Coefficient; // the first of the cell's
    int Begin, End;
  };

  /// What the phases hand on, of each row.
  struct Batch
  {
    Part Parts[BatchSize];
    double Products[BatchSize][Lines]; // B_k(z) B_j(y)
    Vector8 AlongX[BatchSize];         // B(x), each twice
    double Values[2 * BatchSize];      // numerator and denominator
    double Target[BatchSize], Weight[BatchSize];
    double Terms[2 * BatchSize]; // what it adds to the two sums
  };

  static IPIA_INLINE void computeBases(const ConstraintRow<Dim>* rows, int count, Batch& batch)
  {
    constexpr Vector8 basis0 = { 1. / 6, 4. / 6, 1. / 6, 0, 1. / 6, 4. / 6, 1. / 6, 0 };
    constexpr Vector8 basis1 = { -.5, 0, .5, 0, -.5, 0, .5, 0 };
    constexpr Vector8 basis2 = { .5, -1, .5, 0, .5, -1, .5, 0 };
    constexpr Vector8 basis3 = { -1. / 6, .5, -.5, 1. / 6, -1. / 6, .5, -.5, 1. / 6 };
    for (int r = 0; r < count; ++r)
    {
      const double x = rows[r].T[0], y = rows[r].T[1];
      const Vector8 t = { x, x, x, x, y, y, y, y };
      const Vector8 xy = basis0 + t * (basis1 + t * (basis2 + t * basis3));
      batch.AlongX[r] = __builtin_shufflevector(xy, xy, 0, 0, 1, 1, 2, 2, 3, 3);
      if (Dim == 2)
      {
        const Vector4 along = __builtin_shufflevector(xy, xy, 4, 5, 6, 7);
        std::memcpy(batch.Products[r], &along, sizeof(along));
      }
      else
      {
        const double u = rows[r].T[Dim - 1];
        const Vector8 z = basis0 + u * (basis1 + u * (basis2 + u * basis3));
        const Vector8 yy = __builtin_shufflevector(xy, xy, 4, 5, 6, 7, 4, 5, 6, 7);
        const Vector8 products[2] = { __builtin_shufflevector(z, z, 0, 0, 0, 0, 1, 1, 1, 1) * yy,
          __builtin_shufflevector(z, z, 2, 2, 2, 2, 3, 3, 3, 3) * yy };
        std::memcpy(batch.Products[r], products, sizeof(batch.Products[r]));
      }
      batch.Target[r] = rows[r].Target;
      batch.Weight[r] = rows[r].Weight;
    }
  }

  /// Where the pairs of line i of a cell begin.
  static IPIA_INLINE std::int64_t lineOf(
    const Part& part, const std::array<std::int64_t, 2>& stride, int i)
  {
    return 2 * (part.Coefficient + i / Order * stride[1] + i % Order * stride[0]);
  }

  /// Even lanes of the sum add up to the numerator at row r, odd ones to the denominator.
  static IPIA_INLINE void sumLines(
    const Vector8 (&c)[Lines], const Batch& batch, int r, Vector8& sum)
  {
    Vector8 sums[2] = { batch.Products[r][0] * c[0], batch.Products[r][1] * c[1] };
    for (int i = 2; i < Lines; ++i)
    {
      sums[i % 2] += batch.Products[r][i] * c[i];
    }
    sum = (sums[0] + sums[1]) * batch.AlongX[r];
  }

  static IPIA_INLINE void gather(
    const Part& part, const std::array<std::int64_t, 2>& stride, const double* pairs, Batch& batch)
  {
    Vector8 c[Lines];
    for (int i = 0; i < Lines; ++i)
    {
      std::memcpy(&c[i], pairs + lineOf(part, stride, i), sizeof(c[i]));
    }
    int r = part.Begin;
    for (; r + GroupSize <= part.End; r += GroupSize)
    {
      Vector8 g[GroupSize];
      for (int i = 0; i < GroupSize; ++i)
      {
        sumLines(c, batch, r + i, g[i]);
      }
      // Two pairs of lanes of two rows, then of four.
      const Vector8 a = __builtin_shufflevector(g[0], g[1], 0, 1, 8, 9, 4, 5, 12, 13) +
        __builtin_shufflevector(g[0], g[1], 2, 3, 10, 11, 6, 7, 14, 15);
      const Vector8 b = __builtin_shufflevector(g[2], g[3], 0, 1, 8, 9, 4, 5, 12, 13) +
        __builtin_shufflevector(g[2], g[3], 2, 3, 10, 11, 6, 7, 14, 15);
      const Vector8 values = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11) +
        __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
      std::memcpy(batch.Values + 2 * r, &values, sizeof(values));
    }
    for (; r < part.End; ++r)
    {
      Vector8 g;
      sumLines(c, batch, r, g);
      const Vector4 half =
        __builtin_shufflevector(g, g, 0, 1, 2, 3) + __builtin_shufflevector(g, g, 4, 5, 6, 7);
      batch.Values[2 * r] = half[0] + half[2];
      batch.Values[2 * r + 1] = half[1] + half[3];
    }
  }

  /// What each row adds to the sums, and to the energy; eight rows at a time.
  static IPIA_INLINE void divide(int count, Batch& batch, Vector8& energy)
  {
    for (int r = count; r % Lanes != 0; ++r)
    {
      batch.Values[2 * r] = batch.Target[r] = batch.Weight[r] = 0;
      batch.Values[2 * r + 1] = 1;
    }
    for (int r = 0; r < count; r += Lanes)
    {
      Vector8 values[2], target, weight;
      std::memcpy(values, batch.Values + 2 * r, sizeof(values));
      std::memcpy(&target, batch.Target + r, sizeof(target));
      std::memcpy(&weight, batch.Weight + r, sizeof(weight));
      const Vector8 inverse =
        1 / __builtin_shufflevector(values[0], values[1], 1, 3, 5, 7, 9, 11, 13, 15);
      const Vector8 value =
        __builtin_shufflevector(values[0], values[1], 0, 2, 4, 6, 8, 10, 12, 14) * inverse;
      const Vector8 difference = value - target, scaled = weight * inverse;
      const Vector8 first = scaled * (Kind == Sums::Coefficients ? -difference : difference);
      const Vector8 second = Kind == Sums::Coefficients ? scaled : first * value;
      const Vector8 terms[2] = { __builtin_shufflevector(first, second, 0, 8, 1, 9, 2, 10, 3, 11),
        __builtin_shufflevector(first, second, 4, 12, 5, 13, 6, 14, 7, 15) };
      std::memcpy(batch.Terms + 2 * r, terms, sizeof(terms));
      energy += weight * difference * difference;
    }
  }

  static IPIA_INLINE void scatter(
    const Part& part, const std::array<std::int64_t, 2>& stride, const Batch& batch, double* sums)
  {
    Vector8 add[Lines];
    for (int i = 0; i < Lines; ++i)
    {
      std::memcpy(&add[i], sums + lineOf(part, stride, i), sizeof(add[i]));
    }
    for (int r = part.Begin; r < part.End; ++r)
    {
      const double a = batch.Terms[2 * r], b = batch.Terms[2 * r + 1];
      const Vector8 both = batch.AlongX[r] * Vector8{ a, b, a, b, a, b, a, b };
      for (int i = 0; i < Lines; ++i)
      {
        add[i] += batch.Products[r][i] * both;
      }
    }
    for (int i = 0; i < Lines; ++i)
    {
      std::memcpy(sums + lineOf(part, stride, i), &add[i], sizeof(add[i]));
    }
  }

  static IPIA_INLINE void run(const ConstraintRow<Dim>* rows,
    const typename ConstraintRows<Dim>::Cell* begin, const typename ConstraintRows<Dim>::Cell* end,
    const std::array<std::int64_t, 2>& stride, const double* pairs, double* sums, double& energy)
  {
    Vector8 energies{};
    Batch batch;
    std::int64_t row = begin->Begin;
    for (auto cell = begin; cell != end;)
    {
      const std::int64_t start = row;
      int parts = 0, count = 0;
      while (cell != end && count < BatchSize)
      {
        const std::int64_t left = cell[1].Begin - row;
        Part& part = batch.Parts[parts++];
        part.Coefficient = cell->Coefficient;
        part.Begin = count;
        count += static_cast<int>(std::min<std::int64_t>(BatchSize - count, left));
        part.End = count;
        row = start + count;
        cell += row == cell[1].Begin ? 1 : 0;
      }
      computeBases(rows + start, count, batch);
      for (int p = 0; p < parts; ++p)
      {
        gather(batch.Parts[p], stride, pairs, batch);
      }
      divide(count, batch, energies);
      for (int p = 0; p < parts; ++p)
      {
        scatter(batch.Parts[p], stride, batch, sums);
      }
    }
    energy = 0;
    for (int lane = 0; lane < Lanes; ++lane)
    {
      energy += energies[lane];
    }
  }
};
}

template <int Dim>
RationalOperator<Dim>::RationalOperator(const ConstraintRows<Dim>& rows, int threads)
  : Rows(rows)
  , Touched(rows)
  , Threads(resolveThreads(threads))
{
}

template <int Dim>
template <typename Kernel>
double RationalOperator<Dim>::sweep(const CoefficientPairs& pairs, CoefficientPairs& sums) const
{
  const Lattice<Dim>& lattice = this->Rows.lattice();
  if (sums.cols() != lattice.numberOfCoefficients())
  {
    sums.setZero(2, lattice.numberOfCoefficients());
  }
  this->Touched.forEach(this->Threads,
    [&](std::int64_t begin, std::int64_t end) { sums.middleCols(begin, end - begin).setZero(); });
  const std::array<std::int64_t, 2> stride = { lattice.Size[0], lattice.Size[0] * lattice.Size[1] };
  std::vector<double> energies(static_cast<std::size_t>(this->Rows.numberOfTiles()));
  const double* const from = pairs.data();
  double* const to = sums.data();
#pragma omp parallel num_threads(this->Threads)
  for (int colour = 0; colour < ConstraintRows<Dim>::NumberOfColours; ++colour)
  {
    const std::int64_t last = this->Rows.tileOfColour(colour + 1);
#pragma omp for schedule(dynamic)
    for (std::int64_t tile = this->Rows.tileOfColour(colour); tile < last; ++tile)
    {
      double energy = 0;
      dispatch<Kernel>(this->Rows.rows(), this->Rows.cells() + this->Rows.tileBegin(tile),
        this->Rows.cells() + this->Rows.tileBegin(tile + 1), stride, from, to, energy);
      energies[static_cast<std::size_t>(tile)] = energy;
    }
  }
  double energy = 0;
  for (double e : energies)
  {
    energy += e;
  }
  return energy;
}

template <int Dim>
double RationalOperator<Dim>::coefficientSums(
  const CoefficientPairs& pairs, CoefficientPairs& sums) const
{
  return this->sweep<RationalKernel<Dim, Sums::Coefficients>>(pairs, sums);
}

template <int Dim>
double RationalOperator<Dim>::weightSums(
  const CoefficientPairs& pairs, CoefficientPairs& sums) const
{
  return this->sweep<RationalKernel<Dim, Sums::Weights>>(pairs, sums);
}

template <int Dim>
double RationalOperator<Dim>::sumOfRowWeights() const
{
  double sum = 0;
  for (std::int64_t k = 0; k < this->Rows.size(); ++k)
  {
    sum += this->Rows.rows()[k].Weight;
  }
  return sum;
}

template class RationalOperator<2>;
template class RationalOperator<3>;
}
