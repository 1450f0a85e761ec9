// SPDX-License-Identifier: BSD-3-Clause
#include "PointSamples.h"

#include "MortonOrder.h"
#include "Parallel.h"

#include <utility>

namespace ipia
{
namespace
{
/// Positions are multiples of the inverse, in cells.
constexpr double PositionSteps = 1048576;

/// Samples that the memory needs to answer for one of them.
constexpr std::int64_t Lookahead = 16;

/// What a sample is sorted by, and where it is in the input.
struct KeyedRow
{
  std::uint64_t Key;
  std::int64_t Row;
};

/// std::round() for what fits an integer, without a call where the instruction set has no rounding.
inline double nearestInteger(double x)
{
  const auto below = static_cast<double>(static_cast<std::int64_t>(x)); // towards 0
  const double rest = x - below;
  return below + static_cast<double>(rest >= 0.5) - static_cast<double>(rest <= -0.5);
}

template <int Dim>
Sample<Dim> meanOf(const Sample<Dim>* begin, const Sample<Dim>* end)
{
  Sample<Dim> mean = *begin;
  if (end - begin == 1)
  {
    return mean;
  }
  Point<Dim> position = Point<Dim>::Zero(), plain = position, normal = position;
  double weight = 0, value = 0, fairing = 0;
  for (const Sample<Dim>* s = begin; s != end; ++s)
  {
    const double w = s->Weight;
    position += w * s->Position;
    normal += w * s->Normal;
    value += w * s->Value;
    fairing += w * s->Fairing;
    weight += w;
    mean.HasNormal = mean.HasNormal || s->HasNormal;
    plain += s->Position;
  }
  mean.Weight = static_cast<float>(weight);
  mean.Position = weight > 0 ? Point<Dim>(position / weight)
                             : Point<Dim>(plain / static_cast<double>(end - begin));
  const double share = weight > 0 ? 1 / weight : 0.0;
  mean.Normal = share * normal;
  mean.Value = static_cast<float>(share * value);
  mean.Fairing = weight > 0 ? static_cast<float>(share * fairing) : 1.F;
  return mean;
}
}

template <int Dim>
Samples<Dim> sortedSamples(const Lattice<Dim>& lattice, const HermiteInput<Dim>& input, int threads)
{
  const std::int64_t n = input.Positions.cols(), m = input.ExtraPositions.cols();
  BulkVector<KeyedRow> order(static_cast<std::size_t>(n + m));
  // Rounded, so that noise of the last bits, such as from another unit or origin, does not choose
  // the cell of a point.
  const auto positionOf = [&](std::int64_t k) -> Point<Dim>
  {
    const Point<Dim> u = (k < n ? input.Positions.col(k) : input.ExtraPositions.col(k - n))
                           .cwiseQuotient(lattice.Spacing);
    return (u * PositionSteps).unaryExpr([](double x) { return nearestInteger(x); }) /
      PositionSteps;
  };
  parallelChunks(n + m, threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t k = begin; k < end; ++k)
      {
        const Point<Dim> u = positionOf(k);
        Index<Dim> subCell;
        for (int a = 0; a < Dim; ++a)
        {
          const std::int64_t last = (lattice.cells(a) << SubCellBits) - 1;
          // Towards 0 where it is negative, which makes no difference to the first sub-cell.
          const auto at = static_cast<std::int64_t>(u[a] * (1 << SubCellBits));
          subCell[a] = std::min(std::max<std::int64_t>(at, 0), last);
        }
        order[static_cast<std::size_t>(k)] = { mortonKey<Dim>(subCell), k };
      }
    });
  sortByKey(
    order, [](const KeyedRow& row) { return row.Key; }, threads);
  Samples<Dim> samples(order.size());
  // The input is in any order: ask for it some samples ahead.
  const auto prefetch = [&](std::int64_t at)
  {
    const std::int64_t k = at < n + m ? order[static_cast<std::size_t>(at)].Row : n;
    if (k < n)
    {
      __builtin_prefetch(input.Positions.data() + Dim * k);
      __builtin_prefetch(input.Normals.data() + Dim * k);
    }
  };
  const auto fill = [&](std::size_t at)
  {
    const std::int64_t k = order[at].Row;
    Sample<Dim>& sample = samples[at];
    sample.Key = order[at].Key;
    sample.Position = positionOf(k);
    const bool extra = k >= n;
    sample.Normal.setZero();
    sample.Fairing = 1;
    if (!extra)
    {
      sample.Normal = input.Normals.col(k);
      sample.Fairing =
        input.LocalFairing.size() == 0 ? 1.F : static_cast<float>(input.LocalFairing[k]);
    }
    sample.HasNormal = !sample.Normal.isZero(0);
    sample.IsExtra = extra;
    sample.Value = extra ? static_cast<float>(input.ExtraValues[k - n]) : 0.F;
    const Vector& weights = extra ? input.ExtraWeights : input.Weights;
    sample.Weight = weights.size() == 0 ? 1.F : static_cast<float>(weights[extra ? k - n : k]);
  };
  parallelChunks(n + m, threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t k = begin; k < end; ++k)
      {
        prefetch(k + Lookahead);
        fill(static_cast<std::size_t>(k));
      }
    });
  return samples;
}

template <int Dim>
Samples<Dim> cluster(const Samples<Dim>& samples, int halvings, int threads)
{
  const int shift = Dim * halvings;
  const auto n = static_cast<std::int64_t>(samples.size());
  const auto isFirst = [&](std::int64_t at)
  {
    const auto k = static_cast<std::size_t>(at);
    return k == 0 || samples[k].Key >> shift != samples[k - 1].Key >> shift;
  };
  // Clusters that begin in each chunk of the samples, then in those before it.
  std::vector<std::size_t> before(static_cast<std::size_t>(numberOfChunks(n)), 0);
  parallelChunks(n, threads,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t k = first; k < last; ++k)
      {
        before[static_cast<std::size_t>(first / VectorChunk)] += isFirst(k);
      }
    });
  std::size_t total = 0;
  for (std::size_t& count : before)
  {
    total += std::exchange(count, total);
  }
  BulkVector<std::size_t> begin(total + 1); // of each cluster
  begin.back() = samples.size();
  parallelChunks(n, threads,
    [&](std::int64_t first, std::int64_t last)
    {
      std::size_t next = before[static_cast<std::size_t>(first / VectorChunk)];
      for (std::int64_t k = first; k < last; ++k)
      {
        if (isFirst(k))
        {
          begin[next++] = static_cast<std::size_t>(k);
        }
      }
    });
  Samples<Dim> clusters(begin.size() - 1);
  parallelChunks(static_cast<std::int64_t>(clusters.size()), threads,
    [&](std::int64_t first, std::int64_t last)
    {
      for (auto c = static_cast<std::size_t>(first); c < static_cast<std::size_t>(last); ++c)
      {
        clusters[c] = meanOf(samples.data() + begin[c], samples.data() + begin[c + 1]);
      }
    });
  return clusters;
}

template Samples<2> sortedSamples<2>(const Lattice<2>&, const HermiteInput<2>&, int);
template Samples<3> sortedSamples<3>(const Lattice<3>&, const HermiteInput<3>&, int);
template Samples<2> cluster<2>(const Samples<2>&, int, int);
template Samples<3> cluster<3>(const Samples<3>&, int, int);
}
