// SPDX-License-Identifier: BSD-3-Clause
#include "RationalOperator.h"

#include "Dispatch.h"
#include "TileSweep.h"

#include <atomic>
#include <cstring>

namespace ipia
{
namespace
{
enum class Sums
{
  None,
  Coefficients, // v (b - g) / d and v / d
  Weights       // v (g - b) / d and v (g - b) g / d
};

/// By reference, since how a vector is returned depends on the instruction set.
IPIA_INLINE void load(const double* from, Vector8& v)
{
  std::memcpy(&v, from, sizeof(v));
}

/// What a sweep reads and writes.
template <int Dim>
struct SweepData
{
  const ConstraintRow<Dim>* Rows;
  const typename RowBatches<Dim>::Part* Parts;
  const std::int64_t* BatchBegin; // in Parts
  std::array<std::int64_t, 2> Stride;
  const double* Pairs;
  double* Sums;
  double* InverseDenominators; // RowBatches::MostRows a batch
};

/**
 * All rows of one tile. A vector holds pairs of numbers of four coefficients along x, numerator and
 * denominator or the two sums. The coefficients of a cell stay in registers while its rows of a
 * batch meet them.
 */
template <int Dim, Sums Kind>
struct RationalKernel
{
  using Part = typename RowBatches<Dim>::Part;
  static constexpr int Across =
    Dim == 3 ? Order : 1;                      // lines of a layer, one behind the other along z
  static constexpr int Lines = Order * Across; // layers follow each other along y
  static constexpr bool UsesNumeratorsAlone = Dim == 3 && Kind == Sums::Weights;
  static constexpr int Lanes = 8; // of a vector
  static constexpr int BatchSize = RowBatches<Dim>::MostRows;

  /// What the phases hand on, of each row.
  struct Workspace
  {
    alignas(64) double Products[BatchSize][Lines]; // B_j(y) B_k(z)
    Vector8 AlongX[BatchSize];                     // B(x), each twice
    Vector8 Gathered[BatchSize];                   // lanes to be added up
    alignas(64) double Target[BatchSize], Weight[BatchSize];
    // What it adds to the two sums, with room to read a whole vector from the last on.
    alignas(64) double Terms[2 * BatchSize + Lanes];
  };

  static IPIA_INLINE void readRows(
    const Part* begin, const Part* end, const SweepData<Dim>& data, Workspace& work)
  {
    // The cubic basis as a polynomial in t (see CubicBasis.h).
    constexpr Vector8 basis0 = { 1. / 6, 4. / 6, 1. / 6, 0, 1. / 6, 4. / 6, 1. / 6, 0 };
    constexpr Vector8 basis1 = { -.5, 0, .5, 0, -.5, 0, .5, 0 };
    constexpr Vector8 basis2 = { .5, -1, .5, 0, .5, -1, .5, 0 };
    constexpr Vector8 basis3 = { -1. / 6, .5, -.5, 1. / 6, -1. / 6, .5, -.5, 1. / 6 };
    constexpr Vector8 twice0 = { 1. / 6, 1. / 6, 4. / 6, 4. / 6, 1. / 6, 1. / 6, 0, 0 };
    constexpr Vector8 twice1 = { -.5, -.5, 0, 0, .5, .5, 0, 0 };
    constexpr Vector8 twice2 = { .5, .5, -1, -1, .5, .5, 0, 0 };
    constexpr Vector8 twice3 = { -1. / 6, -1. / 6, .5, .5, -.5, -.5, 1. / 6, 1. / 6 };
    for (auto part = begin; part != end; ++part)
    {
      const ConstraintRow<Dim>* row = data.Rows + part->Row;
      for (int r = part->Begin; r < part->End; ++r, ++row)
      {
        // Reading a batch at a time is too jerky for the processor to see where it leads.
        __builtin_prefetch(row + BatchSize);
        const double x = row->T[0], y = row->T[1], z = row->T[Dim - 1];
        work.AlongX[r] = twice0 + x * (twice1 + x * (twice2 + x * twice3));
        const Vector8 t = { y, y, y, y, z, z, z, z };
        const Vector8 yz = basis0 + t * (basis1 + t * (basis2 + t * basis3));
        if (Dim == 2)
        {
          std::memcpy(work.Products[r], &yz, sizeof(work.Products[r]));
        }
        else
        {
          const Vector8 zz = __builtin_shufflevector(yz, yz, 4, 5, 6, 7, 4, 5, 6, 7);
          const Vector8 both[2] = { __builtin_shufflevector(yz, yz, 0, 0, 0, 0, 1, 1, 1, 1) * zz,
            __builtin_shufflevector(yz, yz, 2, 2, 2, 2, 3, 3, 3, 3) * zz };
          std::memcpy(work.Products[r], both, sizeof(work.Products[r]));
        }
        work.Target[r] = row->Target;
        work.Weight[r] = row->Weight;
      }
    }
  }

  /// Where the pairs of line i of a cell begin.
  static IPIA_INLINE std::int64_t lineOf(const Part& part, const SweepData<Dim>& data, int i)
  {
    return 2 * (part.Coefficient + i / Across * data.Stride[0] + i % Across * data.Stride[1]);
  }

  /// Of each batch. Even lanes add up to the numerator, odd ones to the denominator.
  static IPIA_INLINE void gatherPairs(
    const Part* begin, const Part* end, const SweepData<Dim>& data, Workspace& work)
  {
    Vector8 c[Lines] = {};
    for (auto part = begin; part != end; ++part)
    {
      if (part->Follows)
      {
        for (int i = 0; i < Lines - Across; ++i)
        {
          c[i] = c[i + Across];
        }
      }
      else
      {
        for (int i = 0; i < Lines - Across; ++i)
        {
          load(data.Pairs + lineOf(*part, data, i), c[i]);
        }
      }
      for (int i = Lines - Across; i < Lines; ++i)
      {
        load(data.Pairs + lineOf(*part, data, i), c[i]);
      }
      for (int r = part->Begin; r < part->End; ++r)
      {
        Vector8 sums[2] = { work.Products[r][0] * c[0], work.Products[r][1] * c[1] };
        for (int i = 2; i < Lines; ++i)
        {
          sums[i % 2] += work.Products[r][i] * c[i];
        }
        work.Gathered[r] = (sums[0] + sums[1]) * work.AlongX[r];
      }
    }
  }

  /// Of lines i and i + 1, one as even lanes, one as odd ones.
  static IPIA_INLINE void loadNumerators(
    const Part& part, const SweepData<Dim>& data, int i, Vector8& c)
  {
    Vector8 a, b;
    load(data.Pairs + lineOf(part, data, i), a);
    load(data.Pairs + lineOf(part, data, i + 1), b);
    c = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
  }

  /// The same for numerators alone, in three dimensions. All lanes add up to one.
  static IPIA_INLINE void gatherNumerators(
    const Part* begin, const Part* end, const SweepData<Dim>& data, Workspace& work)
  {
    constexpr int vectors = Lines / 2, layer = Across / 2;
    Vector8 c[vectors] = {};
    for (auto part = begin; part != end; ++part)
    {
      if (part->Follows)
      {
        for (int i = 0; i < vectors - layer; ++i)
        {
          c[i] = c[i + layer];
        }
      }
      else
      {
        for (int i = 0; i < vectors - layer; ++i)
        {
          loadNumerators(*part, data, 2 * i, c[i]);
        }
      }
      for (int i = vectors - layer; i < vectors; ++i)
      {
        loadNumerators(*part, data, 2 * i, c[i]);
      }
      for (int r = part->Begin; r < part->End; ++r)
      {
        Vector8 p[2];
        load(work.Products[r], p[0]);
        load(work.Products[r] + 8, p[1]);
        Vector8 sums[2] = {};
        for (int i = 0; i < 2; ++i)
        {
          sums[0] += __builtin_shufflevector(p[i], p[i], 0, 1, 0, 1, 0, 1, 0, 1) * c[4 * i];
          sums[1] += __builtin_shufflevector(p[i], p[i], 2, 3, 2, 3, 2, 3, 2, 3) * c[4 * i + 1];
          sums[0] += __builtin_shufflevector(p[i], p[i], 4, 5, 4, 5, 4, 5, 4, 5) * c[4 * i + 2];
          sums[1] += __builtin_shufflevector(p[i], p[i], 6, 7, 6, 7, 6, 7, 6, 7) * c[4 * i + 3];
        }
        work.Gathered[r] = (sums[0] + sums[1]) * work.AlongX[r];
      }
    }
  }

  /// What each of the rows [begin, begin + Lanes) adds to the sums, and to the energy.
  static IPIA_INLINE void evaluate(int begin, double* inverses, Workspace& work, Vector8& energy)
  {
    const Vector8* const gathered = work.Gathered + begin;
    // Lanes of two rows, then of four, then of eight.
    Vector8 two[4], four[2];
    for (int i = 0; i < 4; ++i)
    {
      const Vector8 a = gathered[2 * i], b = gathered[2 * i + 1];
      two[i] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13) +
        __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    }
    for (int i = 0; i < 2; ++i)
    {
      const Vector8 a = two[2 * i], b = two[2 * i + 1];
      four[i] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11) +
        __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
    }
    const Vector8 even = __builtin_shufflevector(four[0], four[1], 0, 2, 4, 6, 8, 10, 12, 14);
    const Vector8 odd = __builtin_shufflevector(four[0], four[1], 1, 3, 5, 7, 9, 11, 13, 15);
    Vector8 target, weight, inverse;
    load(work.Target + begin, target);
    load(work.Weight + begin, weight);
    if (Kind == Sums::Weights)
    {
      load(inverses + begin, inverse);
    }
    else
    {
      inverse = 1 / odd;
    }
    const Vector8 numerator = UsesNumeratorsAlone ? even + odd : even;
    const Vector8 value = numerator * inverse;
    const Vector8 difference = value - target;
    energy += weight * difference * difference;
    if (Kind != Sums::None)
    {
      const Vector8 scaled = weight * inverse;
      const Vector8 first = scaled * (Kind == Sums::Coefficients ? -difference : difference);
      const Vector8 second = Kind == Sums::Coefficients ? scaled : first * value;
      const Vector8 both[2] = { __builtin_shufflevector(first, second, 0, 8, 1, 9, 2, 10, 3, 11),
        __builtin_shufflevector(first, second, 4, 12, 5, 13, 6, 14, 7, 15) };
      std::memcpy(work.Terms + 2 * begin, both, sizeof(both));
    }
    if (Kind == Sums::Coefficients)
    {
      std::memcpy(inverses + begin, &inverse, sizeof(inverse));
    }
  }

  static IPIA_INLINE void addLine(
    const Part& part, const SweepData<Dim>& data, int i, const Vector8& add)
  {
    double* const at = data.Sums + lineOf(part, data, i);
    Vector8 sum;
    load(at, sum);
    sum += add;
    std::memcpy(at, &sum, sizeof(sum));
  }

  /// Of each batch.
  static IPIA_INLINE void scatter(
    const Part* begin, const Part* end, const SweepData<Dim>& data, const Workspace& work)
  {
    Vector8 add[Lines] = {};
    for (auto part = begin; part != end; ++part)
    {
      for (int r = part->Begin; r < part->End; ++r)
      {
        Vector8 both;
        load(work.Terms + 2 * r, both);
        both = __builtin_shufflevector(both, both, 0, 1, 0, 1, 0, 1, 0, 1) * work.AlongX[r];
        for (int i = 0; i < Lines; ++i)
        {
          add[i] += work.Products[r][i] * both;
        }
      }
      for (int i = 0; i < Across; ++i)
      {
        addLine(*part, data, i, add[i]);
      }
      if (part + 1 != end && part[1].Follows)
      {
        for (int i = 0; i < Lines - Across; ++i)
        {
          add[i] = add[i + Across];
        }
        for (int i = Lines - Across; i < Lines; ++i)
        {
          add[i] = Vector8{};
        }
      }
      else
      {
        for (int i = Across; i < Lines; ++i)
        {
          addLine(*part, data, i, add[i]);
        }
        for (int i = 0; i < Lines; ++i)
        {
          add[i] = Vector8{};
        }
      }
    }
  }

  /// The batches [begin, end).
  static IPIA_INLINE void run(
    const SweepData<Dim>& data, std::int64_t begin, std::int64_t end, double& energy)
  {
    Vector8 energies{};
    Workspace work;
    for (std::int64_t batch = begin; batch < end; ++batch)
    {
      const Part* const first = data.Parts + data.BatchBegin[batch];
      const Part* const last = data.Parts + data.BatchBegin[batch + 1];
      const int count = last[-1].End;
      readRows(first, last, data, work);
      if constexpr (UsesNumeratorsAlone)
      {
        gatherNumerators(first, last, data, work);
      }
      else
      {
        gatherPairs(first, last, data, work);
      }
      // Rows that fill the last vector.
      for (int r = count; r % Lanes != 0; ++r)
      {
        work.Gathered[r] = Vector8{ 0, 1 };
        work.Target[r] = work.Weight[r] = 0;
      }
      for (int r = 0; r < count; r += Lanes)
      {
        evaluate(r, data.InverseDenominators + batch * BatchSize, work, energies);
      }
      if (Kind != Sums::None)
      {
        scatter(first, last, data, work);
      }
    }
    energy = 0;
    for (int lane = 0; lane < Lanes; ++lane)
    {
      energy += energies[lane];
    }
  }
};

/// An energy that threads add to, to tell when a bound is passed.
class BoundedEnergy
{
public:
  explicit BoundedEnergy(double bound)
    : Bound(bound * (1 + 1e-9)) // sums in another order are larger than the bound, too
  {
  }

  bool isPassed() const { return this->Sum.load(std::memory_order_relaxed) > this->Bound; }

  void add(double energy)
  {
    double sum = this->Sum.load(std::memory_order_relaxed);
    while (!this->Sum.compare_exchange_weak(sum, sum + energy, std::memory_order_relaxed))
    {
    }
  }

private:
  const double Bound;
  std::atomic<double> Sum{ 0 };
};
}

template <int Dim>
RationalOperator<Dim>::RationalOperator(const ConstraintRows<Dim>& rows, int threads)
  : Rows(rows)
  , Batches(rows)
  , Touched(rows)
  , Threads(resolveThreads(threads))
  , InverseDenominators(Batches.numberOfBatches() * RowBatches<Dim>::MostRows)
{
}

template <int Dim>
template <typename Kernel>
double RationalOperator<Dim>::sweep(const CoefficientPairs& pairs, double* sums, double bound)
{
  const Lattice<Dim>& lattice = this->lattice();
  const SweepData<Dim> data = { this->Rows.rows(), this->Batches.parts(),
    this->Batches.batchBegin(), { lattice.Size[0], lattice.Size[0] * lattice.Size[1] },
    pairs.data(), sums, this->InverseDenominators.data() };
  BoundedEnergy sum(bound);
  const double energy = sweepTiles(this->Rows, this->Threads,
    [&](std::int64_t tile)
    {
      double ofTile = 0;
      if (!sum.isPassed())
      {
        dispatch<Kernel>(
          data, this->Batches.tileBegin(tile), this->Batches.tileBegin(tile + 1), ofTile);
        sum.add(ofTile);
      }
      return ofTile;
    });
  return sum.isPassed() ? std::numeric_limits<double>::infinity() : energy;
}

template <int Dim>
double RationalOperator<Dim>::coefficientSums(
  const CoefficientPairs& pairs, CoefficientPairs& sums, double bound)
{
  return this->sweep<RationalKernel<Dim, Sums::Coefficients>>(pairs, sums.data(), bound);
}

template <int Dim>
double RationalOperator<Dim>::weightSums(const CoefficientPairs& pairs, CoefficientPairs& sums)
{
  return this->sweep<RationalKernel<Dim, Sums::Weights>>(
    pairs, sums.data(), std::numeric_limits<double>::infinity());
}

template <int Dim>
double RationalOperator<Dim>::energy(const CoefficientPairs& pairs, double bound)
{
  return this->sweep<RationalKernel<Dim, Sums::None>>(pairs, nullptr, bound);
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
