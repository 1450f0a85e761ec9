// SPDX-License-Identifier: BSD-3-Clause
#include "SampleChecks.h"

#include "MortonOrder.h"
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
constexpr double LaterSpacings = 0.03, LaterDistances = 5, LaterShare = 0.9;
/// The deviation of a normal distribution by the median of its absolute values.
constexpr double DeviationOfMedian = 1.4826;
/// Neighbours are looked for in blocks, of which an occupied one holds at least so many samples of
/// a surface, nine of which lie around one; of a curve three do, with three times as many.
constexpr double SamplesPerBlock = 2;
/// And this many times as many where more than this share of the normals point against the
/// gradient, so that chance decides less.
constexpr double WiderBlocks = 4, ManyAccused = 0.15;
/// A neighbour is beside a sample if its distance from the tangent plane is at most this share of
/// that from the sample.
constexpr double TangentShare = 0.4;
/// A normal that points against the gradient is flipped if the mean of n . m over the neighbours
/// beside it is below this ...
constexpr double FlippedVote = -0.3;
/// ... or, where many are, below the first of these times the size that this mean usually has, and
/// any other normal below the second. Where chance flips many this is small for all, but not where
/// noise mixes the sides of thin parts.
constexpr double AccusedVote = -0.5, AnyVote = -0.7;
/// Either is beyond so many deviations of the sum that chance alone gives.
constexpr double VoteDeviations = 3;
/// The same where others were turned before.
constexpr double LaterAccusedVote = -0.15, LaterAnyVote = -0.5, LaterDeviations = 0.5;
/// Smaller shares of outliers and of flipped normals count for none: a few that the fit misjudges.
constexpr double LeastOutliers = 5e-4, LeastFlipped = 5e-3;
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

  double meanVote() const { return this->Vote / std::max(this->Beside, 1.0); }

  bool contradict(double vote, double deviations) const
  {
    return this->meanVote() < vote && this->Vote < -deviations * std::sqrt(this->Beside);
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
    const double perBlock = SamplesPerBlock * (Dim == 2 ? 3 : 1) * (wide ? WiderBlocks : 1);
    this->Blocks.reserve(samples.size());
    for (std::size_t k = 0; k < samples.size(); ++k)
    {
      this->Blocks.push_back({ samples[k].Key, k });
    }
    do
    {
      ++this->Bits;
      std::size_t kept = 0;
      for (Block block : this->Blocks)
      {
        block.Key >>= Dim;
        if (kept == 0 || this->Blocks[kept - 1].Key != block.Key)
        {
          this->Blocks[kept++] = block;
        }
      }
      this->Blocks.resize(kept);
    } while (
      static_cast<double>(samples.size()) < perBlock * static_cast<double>(this->Blocks.size()) &&
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
  const auto at =
    distances.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(distances.size()));
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

/// Forgets the outliers or the flipped normals that were found.
void forget(SampleFault fault, double& count, SampleFaults& result)
{
  std::replace(result.Faults.begin(), result.Faults.end(), fault, SampleFault::None);
  count = 0;
}

/// Looks at all samples that are not known for outliers, also at those that seem flipped.
template <int Dim>
void findMoreFaults(const Samples<Dim>& samples, const std::vector<SampleCheck>& checks,
  const EarlierFaults& earlier, bool wide, int threads, SampleFaults& result)
{
  const bool outliers = earlier.Outliers || result.Outliers > 0;
  const bool flipped = earlier.Flipped || result.Flipped > 0;
  forget(SampleFault::Flipped, result.Flipped, result);
  std::vector<std::size_t> rest;
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    if (!samples[k].IsExtra && result.Faults[k] != SampleFault::Outlier)
    {
      rest.push_back(k);
    }
  }
  if (rest.empty())
  {
    return;
  }
  const std::vector<Neighbours> neighbours =
    neighboursOf(samples, result.Faults, rest, wide, threads);
  std::vector<float> counts, votes;
  for (const Neighbours& around : neighbours)
  {
    counts.push_back(static_cast<float>(around.Count));
    votes.push_back(static_cast<float>(std::abs(around.meanVote())));
  }
  const double few = AloneShare * quantile(counts, 0.5), usual = quantile(votes, 0.5);
  const double accused = usual * (earlier.Flipped ? LaterAccusedVote : AccusedVote),
               any = usual * (earlier.Flipped ? LaterAnyVote : AnyVote),
               deviations = earlier.Flipped ? LaterDeviations : VoteDeviations;
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    const Neighbours& around = neighbours[i];
    const std::size_t k = rest[i];
    if (outliers && around.Count < few && around.Like <= LikeShare * around.Count)
    {
      result.Faults[k] = SampleFault::Outlier;
      ++result.Outliers;
    }
    else if (flipped && samples[k].HasNormal &&
      around.contradict(checks[k].Agreement < 0 ? accused : any, deviations))
    {
      result.Faults[k] = SampleFault::Flipped;
      ++result.Flipped;
    }
  }
}
}

template <int Dim>
SampleFaults findFaults(const Samples<Dim>& samples, const std::vector<SampleCheck>& checks,
  const EarlierFaults& earlier, int threads)
{
  SampleFaults result;
  result.Faults.assign(samples.size(), SampleFault::None);
  std::vector<std::size_t> accused;
  const double farthest = farthestInlier(samples, checks, earlier.Outliers);
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    if (!samples[k].IsExtra && std::abs(checks[k].Distance) > farthest)
    {
      result.Faults[k] = SampleFault::Outlier;
      ++result.Outliers;
    }
    else if (samples[k].HasNormal && checks[k].Agreement < 0 && !earlier.NoFlips)
    {
      accused.push_back(k);
    }
  }
  const auto n = static_cast<double>(samples.size());
  if (result.Outliers > MostOutliers * n ||
    (!earlier.Outliers && result.Outliers < LeastOutliers * n))
  {
    forget(SampleFault::Outlier, result.Outliers, result);
  }
  const bool wide = static_cast<double>(accused.size()) > ManyAccused * n;
  if (!accused.empty())
  {
    const std::vector<Neighbours> neighbours =
      neighboursOf(samples, result.Faults, accused, wide, threads);
    for (std::size_t i = 0; i < accused.size(); ++i)
    {
      if (neighbours[i].contradict(wide ? 0 : FlippedVote, VoteDeviations))
      {
        result.Faults[accused[i]] = SampleFault::Flipped;
        ++result.Flipped;
      }
    }
  }
  if (!earlier.Flipped && result.Flipped < LeastFlipped * n)
  {
    forget(SampleFault::Flipped, result.Flipped, result);
  }
  if (result.Outliers + result.Flipped > 0 || earlier.Outliers || earlier.Flipped)
  {
    findMoreFaults(samples, checks, earlier, wide, threads, result);
  }
  return result;
}

template SampleFaults findFaults<2>(
  const Samples<2>&, const std::vector<SampleCheck>&, const EarlierFaults&, int);
template SampleFaults findFaults<3>(
  const Samples<3>&, const std::vector<SampleCheck>&, const EarlierFaults&, int);
}
