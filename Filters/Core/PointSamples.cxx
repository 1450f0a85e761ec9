// SPDX-License-Identifier: BSD-3-Clause
#include "PointSamples.h"

#include "Parallel.h"

namespace ipia
{
namespace
{
/// Positions are multiples of the inverse, in cells.
constexpr double PositionSteps = 1048576;

/// Sorts a power of two of chunks and merges neighbours until one is left.
template <typename T>
void sortOnThreads(std::vector<T>& values, int threads)
{
  constexpr std::int64_t chunks = 16;
  const auto at = [&](std::int64_t chunk)
  { return values.begin() + static_cast<std::int64_t>(values.size()) * chunk / chunks; };
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::int64_t k = 0; k < chunks; ++k)
  {
    std::sort(at(k), at(k + 1));
  }
  for (std::int64_t width = 1; width < chunks; width *= 2)
  {
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (std::int64_t k = 0; k < chunks; k += 2 * width)
    {
      std::inplace_merge(at(k), at(k + width), at(k + 2 * width));
    }
  }
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
std::uint64_t mortonKey(const Index<Dim>& i)
{
  std::uint64_t key = 0;
  for (int a = 0; a < Dim; ++a)
  {
    // Spreads the bits of one coordinate with gaps for the others.
    auto v = static_cast<std::uint64_t>(i[a]);
    if (Dim == 3)
    {
      v &= 0x1fffff;
      v = (v | v << 32) & 0x1f00000000ffff;
      v = (v | v << 16) & 0x1f0000ff0000ff;
      v = (v | v << 8) & 0x100f00f00f00f00f;
      v = (v | v << 4) & 0x10c30c30c30c30c3;
      v = (v | v << 2) & 0x1249249249249249;
    }
    else
    {
      v &= 0xffffffff;
      v = (v | v << 16) & 0x0000ffff0000ffff;
      v = (v | v << 8) & 0x00ff00ff00ff00ff;
      v = (v | v << 4) & 0x0f0f0f0f0f0f0f0f;
      v = (v | v << 2) & 0x3333333333333333;
      v = (v | v << 1) & 0x5555555555555555;
    }
    key |= v << a;
  }
  return key;
}

template <int Dim>
Samples<Dim> sortedSamples(const Lattice<Dim>& lattice, const HermiteInput<Dim>& input, int threads)
{
  const std::int64_t n = input.Positions.cols(), m = input.ExtraPositions.cols();
  std::vector<std::pair<std::uint64_t, std::int64_t>> order(static_cast<std::size_t>(n + m));
  // Rounded, so that noise of the last bits, such as from another unit or origin, does not choose
  // the cell of a point.
  const auto positionOf = [&](std::int64_t k) -> Point<Dim>
  {
    const Point<Dim> u = (k < n ? input.Positions.col(k) : input.ExtraPositions.col(k - n))
                           .cwiseQuotient(lattice.Spacing);
    return (u * PositionSteps).array().round() / PositionSteps;
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
          const auto at = static_cast<std::int64_t>(std::floor(u[a] * (1 << SubCellBits)));
          subCell[a] = std::min(std::max<std::int64_t>(at, 0), last);
        }
        order[static_cast<std::size_t>(k)] = { mortonKey<Dim>(subCell), k };
      }
    });
  sortOnThreads(order, threads);
  Samples<Dim> samples(order.size());
  const auto fill = [&](std::size_t at)
  {
    const std::int64_t k = order[at].second;
    Sample<Dim>& sample = samples[at];
    sample.Key = order[at].first;
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
        fill(static_cast<std::size_t>(k));
      }
    });
  return samples;
}

template <int Dim>
Samples<Dim> cluster(const Samples<Dim>& samples, int halvings, int threads)
{
  const int shift = Dim * halvings;
  std::vector<std::size_t> begin; // of each cluster
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    if (k == 0 || samples[k].Key >> shift != samples[k - 1].Key >> shift)
    {
      begin.push_back(k);
    }
  }
  begin.push_back(samples.size());
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

template std::uint64_t mortonKey<2>(const Index<2>&);
template std::uint64_t mortonKey<3>(const Index<3>&);
template Samples<2> sortedSamples<2>(const Lattice<2>&, const HermiteInput<2>&, int);
template Samples<3> sortedSamples<3>(const Lattice<3>&, const HermiteInput<3>&, int);
template Samples<2> cluster<2>(const Samples<2>&, int, int);
template Samples<3> cluster<3>(const Samples<3>&, int, int);
}
