// SPDX-License-Identifier: BSD-3-Clause
#include "FarField.h"

#include "ImplicitSpline.h"
#include "Parallel.h"

namespace ipia
{
namespace
{
/// The centres of the boxes.
template <int Dim>
AxisPositions<Dim> boxCentres(const Lattice<Dim>& lattice)
{
  AxisPositions<Dim> positions;
  for (int a = 0; a < Dim; ++a)
  {
    for (std::int64_t i = 0; i < lattice.boxes(a); ++i)
    {
      positions[a].push_back(static_cast<double>(i) / 2 * lattice.Spacing[a]);
    }
  }
  return positions;
}

/// Where the rim of a region has both signs (the surface passes through it), the spline counts down
/// to this share of the threshold.
constexpr double MixedRegionShare = 0.04;

/// Finds the sign of every box. The boxes have one more at either end, so that each has neighbours.
template <int Dim>
class BoxClassifier
{
public:
  BoxClassifier(const Lattice<Dim>& lattice, const Vector& support, const Vector& coefficients,
    double threshold, int threads)
    : ControlLattice(lattice)
  {
    const AxisPositions<Dim> centres = boxCentres(lattice);
    std::vector<float> density(static_cast<std::size_t>(lattice.numberOfBoxes()));
    std::vector<float> values(density.size());
    ImplicitSpline<Dim>(lattice, support).sample(centres, density.data(), threads);
    ImplicitSpline<Dim>(lattice, coefficients).sample(centres, values.data(), threads);

    std::int64_t size = 1;
    for (int a = 0; a < Dim; ++a)
    {
      this->Stride[a] = size;
      size *= lattice.boxes(a) + 2;
    }
    this->State.assign(static_cast<std::size_t>(size), Border);
    this->Constant.assign(this->State.size(), 0);
    this->forRows(
      [&](std::size_t first, std::size_t padded, std::size_t count)
      {
        for (std::size_t i = 0; i < count; ++i)
        {
          const double s = density[first + i];
          this->State[padded + i] = static_cast<unsigned char>(
            (values[first + i] < 0 ? Negative : 0) | (s >= threshold ? Supported : 0) |
            (s >= MixedRegionShare * threshold ? WeaklySupported : 0));
        }
      });
  }

  /// The boxes at these positions are vouched for if they have support and the expected sign.
  void vouch(const Points<Dim>& positions, int expected)
  {
    for (std::int64_t k = 0; k < positions.cols(); ++k)
    {
      this->vouch(this->boxAt(positions.col(k)), expected);
    }
  }

  /// So are all that these reach through support without a change of sign.
  void spread()
  {
    while (!this->Front.empty())
    {
      const std::int64_t box = this->Front.back();
      this->Front.pop_back();
      const int expected = this->sign(box);
      this->forNeighbours(box, [&](std::int64_t neighbour) { this->vouch(neighbour, expected); });
    }
  }

  /// The spline counts in the boxes at these positions, whatever its sign.
  void keep(const Points<Dim>& positions)
  {
    for (std::int64_t k = 0; k < positions.cols(); ++k)
    {
      this->state(this->boxAt(positions.col(k))) |= Kept;
    }
  }

  /// Each connected region of the other boxes takes the sign of the larger share of the vouched
  /// ones around it.
  FarField signRegions()
  {
    FarField far;
    std::vector<std::int64_t> mixed;
    this->forUnknownRegions(
      [&](const std::vector<std::int64_t>& region, const Rim& rim)
      {
        if (rim.isMixed())
        {
          mixed.insert(mixed.end(), region.begin(), region.end());
        }
        else
        {
          this->giveSign(region, rim);
        }
      });
    if (!mixed.empty())
    {
      this->spreadThroughWeakSupport(mixed);
      this->forUnknownRegions(
        [&](const std::vector<std::int64_t>& region, const Rim& rim)
        {
          far.NumberOfMixedRegions += rim.isMixed();
          this->giveSign(region, rim);
        });
    }
    this->widen();
    far.Sign.resize(static_cast<std::size_t>(this->ControlLattice.numberOfBoxes()));
    this->forRows([&](std::size_t first, std::size_t padded, std::size_t count)
      { std::copy_n(this->Constant.data() + padded, count, far.Sign.data() + first); });
    return far;
  }

private:
  /// What is known of a box, as bits.
  enum Known : unsigned char
  {
    Negative = 1, ///< f < 0 at its centre
    Supported = 2,
    WeaklySupported = 4,
    Vouched = 8,
    Kept = 16,
    Seen = 32, ///< in a region
    Border = 64
  };

  /// The vouched boxes around a region, by sign.
  struct Rim
  {
    std::int64_t Positive = 0, Negative = 0;

    /// A few stray boxes on the rim are noise; a rim that meets both sides is not.
    bool isMixed() const
    {
      return 10 * std::min(this->Positive, this->Negative) > this->Positive + this->Negative;
    }
  };

  unsigned char& state(std::int64_t box) { return this->State[static_cast<std::size_t>(box)]; }

  bool isUnknown(std::int64_t box)
  {
    return (this->state(box) & (Vouched | Kept | Seen | Border)) == 0;
  }

  int sign(std::int64_t box) { return this->state(box) & Negative ? -1 : 1; }

  std::int64_t boxAt(const Point<Dim>& position) const
  {
    std::int64_t box = 0;
    for (int a = 0; a < Dim; ++a)
    {
      box += (this->ControlLattice.locateBox(position[a], a) + 1) * this->Stride[a];
    }
    return box;
  }

  template <typename Action>
  void forNeighbours(std::int64_t box, const Action& action) const
  {
    for (const std::int64_t stride : this->Stride)
    {
      action(box - stride);
      action(box + stride);
    }
  }

  /// Calls action(first box, the same with the border, number of boxes) for every row along x.
  template <typename Action>
  void forRows(const Action& action) const
  {
    const Index<Dim> n = this->ControlLattice.numberOfBoxesPerAxis();
    std::int64_t first = 0;
    for (std::int64_t z = 0; z < (Dim == 3 ? n[Dim - 1] : 1); ++z)
    {
      for (std::int64_t y = 0; y < n[1]; ++y, first += n[0])
      {
        const std::int64_t padded =
          1 + (y + 1) * this->Stride[1] + (Dim == 3 ? (z + 1) * this->Stride[Dim - 1] : 0);
        action(static_cast<std::size_t>(first), static_cast<std::size_t>(padded),
          static_cast<std::size_t>(n[0]));
      }
    }
  }

  void vouch(std::int64_t box, int expected)
  {
    if (this->isUnknown(box) && (this->state(box) & Supported) && this->sign(box) == expected)
    {
      this->state(box) |= Vouched;
      this->Front.push_back(box);
    }
  }

  /// Calls action(boxes, rim) for each connected region of boxes of which nothing is known.
  template <typename Action>
  void forUnknownRegions(const Action& action)
  {
    std::vector<std::int64_t> region;
    for (std::int64_t seed = 0; seed < static_cast<std::int64_t>(this->State.size()); ++seed)
    {
      if (!this->isUnknown(seed))
      {
        continue;
      }
      Rim rim;
      region.assign(1, seed);
      this->state(seed) |= Seen;
      for (std::size_t next = 0; next < region.size(); ++next)
      {
        this->forNeighbours(region[next],
          [&](std::int64_t neighbour)
          {
            if (this->isUnknown(neighbour))
            {
              this->state(neighbour) |= Seen;
              region.push_back(neighbour);
            }
            else if (this->state(neighbour) & Vouched)
            {
              ++(this->sign(neighbour) < 0 ? rim.Negative : rim.Positive);
            }
          });
      }
      action(region, rim);
    }
  }

  /// The spline counts on where it has support and the sign of the region.
  void giveSign(const std::vector<std::int64_t>& region, const Rim& rim)
  {
    const int regionSign = rim.Negative > rim.Positive ? -1 : 1;
    for (const std::int64_t box : region)
    {
      if (!(this->state(box) & Supported) || this->sign(box) != regionSign)
      {
        this->Constant[static_cast<std::size_t>(box)] = static_cast<std::int8_t>(regionSign);
      }
    }
  }

  /// Signs reach half a box beyond the node that shows them: boxes beside a constant take it too,
  /// but for those of data points and those beside the surface.
  void widen()
  {
    std::array<std::int64_t, Dim == 2 ? 9 : 27> around{};
    for (std::size_t k = 0; k < around.size(); ++k)
    {
      auto rest = static_cast<std::int64_t>(k);
      for (const std::int64_t stride : this->Stride)
      {
        around[k] += (rest % 3 - 1) * stride;
        rest /= 3;
      }
    }
    const auto finalSign = [&](std::int64_t box)
    {
      const int constant = this->Constant[static_cast<std::size_t>(box)];
      return constant != 0 ? constant : this->sign(box);
    };
    std::vector<std::int64_t> widened;
    for (std::int64_t box = 0; box < static_cast<std::int64_t>(this->State.size()); ++box)
    {
      if ((this->state(box) & (Border | Kept)) ||
        this->Constant[static_cast<std::size_t>(box)] != 0)
      {
        continue;
      }
      const int own = this->sign(box);
      bool beside = false, alike = true;
      for (const std::int64_t step : around)
      {
        const std::int64_t other = box + step;
        if (!(this->state(other) & Border))
        {
          beside = beside || this->Constant[static_cast<std::size_t>(other)] != 0;
          alike = alike && finalSign(other) == own;
        }
      }
      if (beside && alike)
      {
        widened.push_back(box);
      }
    }
    for (const std::int64_t box : widened)
    {
      this->Constant[static_cast<std::size_t>(box)] = static_cast<std::int8_t>(this->sign(box));
    }
  }

  /// Makes the boxes unknown again, and weak support enough for what the rim vouches for.
  void spreadThroughWeakSupport(const std::vector<std::int64_t>& region)
  {
    for (const std::int64_t box : region)
    {
      unsigned char& known = this->state(box);
      known =
        static_cast<unsigned char>((known & ~Seen) | (known & WeaklySupported ? Supported : 0));
      this->forNeighbours(box,
        [&](std::int64_t neighbour)
        {
          if (this->state(neighbour) & Vouched)
          {
            this->Front.push_back(neighbour);
          }
        });
    }
    this->spread();
  }

  const Lattice<Dim>& ControlLattice;
  Index<Dim> Stride{};
  std::vector<unsigned char> State;
  std::vector<std::int8_t> Constant; ///< the sign where the spline does not count
  std::vector<std::int64_t> Front;   ///< vouched for, neighbours not yet seen
};
}

template <int Dim>
double medianSupport(
  const Lattice<Dim>& lattice, const Vector& support, const Points<Dim>& dataPoints, int threads)
{
  if (dataPoints.cols() == 0)
  {
    return 0;
  }
  const ImplicitSpline<Dim> spline(lattice, support);
  std::vector<double> values(static_cast<std::size_t>(dataPoints.cols()));
  parallelChunks(dataPoints.cols(), threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t k = begin; k < end; ++k)
      {
        values[static_cast<std::size_t>(k)] = spline.value(dataPoints.col(k));
      }
    });
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <int Dim>
FarField computeFarField(const Lattice<Dim>& lattice, const Vector& support,
  const Vector& coefficients, const Points<Dim>& outside, const Points<Dim>& inside,
  const Points<Dim>& dataPoints, const FarFieldOptions& options)
{
  BoxClassifier<Dim> boxes(
    lattice, support, coefficients, options.Threshold, resolveThreads(options.Threads));
  boxes.vouch(outside, 1);
  boxes.vouch(inside, -1);
  boxes.spread();
  boxes.keep(dataPoints);
  FarField far = boxes.signRegions();
  far.Magnitude = options.Magnitude;
  return far;
}

template double medianSupport<2>(const Lattice<2>&, const Vector&, const Points<2>&, int);
template double medianSupport<3>(const Lattice<3>&, const Vector&, const Points<3>&, int);
template FarField computeFarField<2>(const Lattice<2>&, const Vector&, const Vector&,
  const Points<2>&, const Points<2>&, const Points<2>&, const FarFieldOptions&);
template FarField computeFarField<3>(const Lattice<3>&, const Vector&, const Vector&,
  const Points<3>&, const Points<3>&, const Points<3>&, const FarFieldOptions&);
}
