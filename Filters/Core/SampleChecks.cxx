// SPDX-License-Identifier: BSD-3-Clause
#include "SampleChecks.h"

#include "Parallel.h"

namespace ipia
{
namespace
{
/// Samples farther from the zero set than so many knot spacings and standard deviations are
/// outliers; where more than this share is, the fit is what is wrong.
constexpr double OutlierSpacings = 1.5, OutlierDeviations = 4, MostOutliers = 0.3;
/// Where others were left out before, fewer spacings are enough, and so many times the distance
/// that this share of the samples keeps.
constexpr double LaterSpacings = 0.1, LaterDistances = 5, LaterShare = 0.9;
/// The deviation of a normal distribution by the median of its absolute values.
constexpr double DeviationOfMedian = 1.4826;
/// Neighbours are looked for in blocks, of which an occupied one holds at least so many samples.
constexpr double SamplesPerBlock = 2;
/// And this many times as many where more than this share of the normals point against the
/// gradient, so that chance decides less.
constexpr double WiderBlocks = 4, ManyAccused = 0.15;
/// A neighbour is beside a sample if its distance from the tangent plane is at most this share of
/// that from the sample.
constexpr double TangentShare = 0.4;
/// A normal that points against the gradient is flipped if the mean of n . m over so many
/// neighbours at least is below the first of these; where others were found so, or many are
/// accused, below the second, and any normal below the third.
constexpr double FewestNeighbours = 4, FlippedVote = -0.3, LaterVote = -0.1, AnyVote = -0.35;
/// With so large a share of faults all samples are looked at.
constexpr double ShareOfFaults = 0.005;
/// A sample is alone if it has less than this share of the usual number of neighbours, of which
/// less than the second share lie beside it with about the same normal, n . m at least the third.
constexpr double AloneShare = 0.1, LikeShare = 0.3, LikeNormal = 0.5;

/// The samples around one.
struct Neighbours
{
  double Count = 0;
  double Beside = 0; ///< those about in its tangent plane ...
  double Vote = 0;   ///< ... and their sum of n . m
  double Like = 0;   ///< of them with about the same normal

  bool contradict(double vote) const
  {
    return this->Beside >= FewestNeighbours && this->Vote < vote * this->Beside;
  }
};

/// Sorted samples by blocks of so many halvings of their sub-cells.
template <int Dim>
class Neighbourhood
{
public:
  Neighbourhood(const Samples<Dim>& samples, const std::vector<SampleFault>& faults, bool wide)
    : All(samples)
    , Faults(faults)
  {
    const double perBlock = SamplesPerBlock * (wide ? WiderBlocks : 1);
    do
    {
      ++this->Bits;
      this->Blocks.clear();
      for (std::size_t k = 0; k < samples.size(); ++k)
      {
        const std::uint64_t key = samples[k].Key >> (Dim * this->Bits);
        if (this->Blocks.empty() || this->Blocks.back().Key != key)
        {
          this->Blocks.push_back({ key, k });
        }
      }
    } while (static_cast<double>(samples.size()) <
        perBlock * static_cast<double>(this->Blocks.size()) &&
      this->Blocks.size() > 1);
  }

  /// What is around a sample.
  Neighbours around(std::size_t k) const
  {
    const Sample<Dim>& sample = this->All[k];
    Neighbours result;
    const auto look = [&](const Sample<Dim>& other)
    {
      const Point<Dim> d = other.Position - sample.Position;
      ++result.Count;
      if (std::abs(d.dot(sample.Normal)) <= TangentShare * d.norm())
      {
        const double along = other.Normal.dot(sample.Normal);
        result.Vote += along;
        ++result.Beside;
        result.Like += along >= LikeNormal;
      }
    };
    Index<Dim> block;
    for (int a = 0; a < Dim; ++a)
    {
      const double size = std::ldexp(1.0, this->Bits - SubCellBits);
      block[a] = static_cast<std::int64_t>(std::floor(sample.Position[a] / size));
    }
    for (int i = 0; i < (Dim == 2 ? 9 : 27); ++i)
    {
      Index<Dim> at = block;
      bool inside = true;
      for (int a = 0, rest = i; a < Dim; ++a, rest /= 3)
      {
        at[a] += rest % 3 - 1;
        inside = inside && at[a] >= 0;
      }
      const std::uint64_t key = inside ? mortonKey<Dim>(at) : 0;
      const auto found = std::lower_bound(this->Blocks.begin(), this->Blocks.end(), key,
        [](const Block& b, std::uint64_t value) { return b.Key < value; });
      if (!inside || found == this->Blocks.end() || found->Key != key)
      {
        continue;
      }
      const std::size_t end =
        found + 1 == this->Blocks.end() ? this->All.size() : (found + 1)->Begin;
      for (std::size_t j = found->Begin; j < end; ++j)
      {
        if (j != k && this->All[j].HasNormal && this->Faults[j] != SampleFault::Outlier)
        {
          look(this->All[j]);
        }
      }
    }
    return result;
  }

private:
  struct Block
  {
    std::uint64_t Key;
    std::size_t Begin;
  };

  const Samples<Dim>& All;
  const std::vector<SampleFault>& Faults;
  int Bits = 0;
  std::vector<Block> Blocks;
};

/// The distance that a share of the samples keeps.
double quantile(std::vector<float>& distances, double share)
{
  const auto at = distances.begin() +
    static_cast<std::ptrdiff_t>(share * static_cast<double>(distances.size()));
  std::nth_element(distances.begin(), at, distances.end());
  return *at;
}

/// The distance beyond which samples are outliers.
template <int Dim>
double farthestInlier(
  const Samples<Dim>& samples, const std::vector<SampleCheck>& checks, bool afterOutliers)
{
  std::vector<float> distances;
  distances.reserve(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    if (!samples[k].IsExtra)
    {
      distances.push_back(std::abs(checks[k].Distance));
    }
  }
  if (distances.empty())
  {
    return 0;
  }
  const double deviations = OutlierDeviations * DeviationOfMedian * quantile(distances, 0.5);
  const double spacings = afterOutliers
    ? std::min(
        std::max(LaterSpacings, LaterDistances * quantile(distances, LaterShare)), OutlierSpacings)
    : OutlierSpacings;
  return std::max(spacings, deviations);
}

/// The neighbours of the given samples.
template <int Dim>
std::vector<Neighbours> neighboursOf(const Samples<Dim>& samples,
  const std::vector<SampleFault>& faults, const std::vector<std::size_t>& of, bool wide,
  int threads)
{
  std::vector<Neighbours> found(of.size());
  const Neighbourhood<Dim> neighbourhood(samples, faults, wide);
  const auto n = static_cast<std::int64_t>(of.size());
#pragma omp parallel for schedule(dynamic, 64) num_threads(threads)
  for (std::int64_t i = 0; i < n; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    found[k] = neighbourhood.around(of[k]);
  }
  return found;
}

/// Looks at all samples that are not yet known for outliers or flipped.
template <int Dim>
void findMoreFaults(const Samples<Dim>& samples, const std::vector<SampleCheck>& checks,
  EarlierFaults earlier, bool wide, int threads, SampleFaults& result)
{
  std::vector<std::size_t> rest;
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    if (!samples[k].IsExtra && result.Faults[k] == SampleFault::None)
    {
      rest.push_back(k);
    }
  }
  const std::vector<Neighbours> neighbours = neighboursOf(samples, result.Faults, rest, wide, threads);
  std::vector<float> counts;
  for (const Neighbours& around : neighbours)
  {
    counts.push_back(static_cast<float>(around.Count));
  }
  double few = 0;
  if (!counts.empty())
  {
    const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
    std::nth_element(counts.begin(), middle, counts.end());
    few = AloneShare * *middle;
  }
  const auto n = static_cast<double>(samples.size());
  const bool outliers =
    earlier == EarlierFaults::Outliers || result.Outliers >= ShareOfFaults * n;
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    const Neighbours& around = neighbours[i];
    const std::size_t k = rest[i];
    if (outliers && around.Count < few && around.Like <= LikeShare * around.Count)
    {
      result.Faults[k] = SampleFault::Outlier;
      ++result.Outliers;
    }
    else if (samples[k].HasNormal &&
      around.contradict(checks[k].Agreement < 0 ? LaterVote : AnyVote))
    {
      result.Faults[k] = SampleFault::Flipped;
      ++result.Flipped;
    }
  }
}
}

template <int Dim>
SampleFaults findFaults(const Samples<Dim>& samples, const std::vector<SampleCheck>& checks,
  EarlierFaults earlier, int threads)
{
  SampleFaults result;
  result.Faults.assign(samples.size(), SampleFault::None);
  std::vector<std::size_t> accused;
  const double farthest = farthestInlier(samples, checks, earlier == EarlierFaults::Outliers);
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    if (!samples[k].IsExtra && std::abs(checks[k].Distance) > farthest)
    {
      result.Faults[k] = SampleFault::Outlier;
      ++result.Outliers;
    }
    else if (samples[k].HasNormal && checks[k].Agreement < 0)
    {
      accused.push_back(k);
    }
  }
  const auto n = static_cast<double>(samples.size());
  if (result.Outliers > MostOutliers * n)
  {
    return {};
  }
  const bool wide = static_cast<double>(accused.size()) > ManyAccused * n;
  if (!accused.empty())
  {
    const std::vector<Neighbours> neighbours =
      neighboursOf(samples, result.Faults, accused, wide, threads);
    for (std::size_t i = 0; i < accused.size(); ++i)
    {
      if (neighbours[i].contradict(wide ? LaterVote : FlippedVote))
      {
        result.Faults[accused[i]] = SampleFault::Flipped;
        ++result.Flipped;
      }
    }
  }
  if (earlier != EarlierFaults::None || result.Outliers + result.Flipped >= ShareOfFaults * n)
  {
    findMoreFaults(samples, checks, earlier, wide, threads, result);
  }
  return result;
}

template SampleFaults findFaults<2>(const Samples<2>&, const std::vector<SampleCheck>&, EarlierFaults, int);
template SampleFaults findFaults<3>(const Samples<3>&, const std::vector<SampleCheck>&, EarlierFaults, int);
}
