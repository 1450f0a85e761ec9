// SPDX-License-Identifier: BSD-3-Clause
#include "FarField.h"

#include "ImplicitSpline.h"
#include "Parallel.h"

namespace ipia
{
namespace
{
/// Sample positions at (i + shift) / perCell of the knot cells, both ends of the domain included if
/// they fall on them.
template <int Dim>
AxisPositions<Dim> gridPositions(const Lattice<Dim>& lattice, int perCell, double shift)
{
  AxisPositions<Dim> positions;
  for (int a = 0; a < Dim; ++a)
  {
    const std::int64_t n = lattice.cells(a) * perCell + (shift == 0 ? 1 : 0);
    for (std::int64_t i = 0; i < n; ++i)
    {
      positions[a].push_back((static_cast<double>(i) + shift) / perCell * lattice.Spacing[a]);
    }
  }
  return positions;
}

/// Index arithmetic on a grid of any size, x fastest.
template <int Dim>
struct Grid
{
  Index<Dim> Count;

  std::int64_t size() const
  {
    std::int64_t n = 1;
    for (std::int64_t count : this->Count)
    {
      n *= count;
    }
    return n;
  }

  std::int64_t flat(const Index<Dim>& i) const
  {
    std::int64_t index = 0;
    for (int a = Dim - 1; a >= 0; --a)
    {
      index = index * this->Count[a] + i[a];
    }
    return index;
  }

  Index<Dim> position(std::int64_t index) const
  {
    Index<Dim> i;
    for (int a = 0; a < Dim; ++a)
    {
      i[a] = index % this->Count[a];
      index /= this->Count[a];
    }
    return i;
  }

  /// Calls action with the nodes that differ from @a index by one step along one axis.
  template <typename Action>
  void forNeighbours(std::int64_t index, const Action& action) const
  {
    std::int64_t stride = 1;
    for (int a = 0; a < Dim; ++a)
    {
      const std::int64_t at = index / stride % this->Count[a];
      if (at > 0)
      {
        action(index - stride);
      }
      if (at + 1 < this->Count[a])
      {
        action(index + stride);
      }
      stride *= this->Count[a];
    }
  }
};

/// Where the rim of a region has both signs (the surface passes through it), the spline counts down
/// to this share of the threshold.
constexpr double MixedRegionShare = 0.04;

/// Step 1: each connected region of unsupported cells takes the sign of its rim.
template <int Dim>
void signUnsupportedRegions(const Lattice<Dim>& lattice, const Vector& support,
  const Vector& coefficients, double threshold, int threads, FarField& far)
{
  const Grid<Dim> cells{ lattice.numberOfCellsPerAxis() };
  const AxisPositions<Dim> centres = gridPositions(lattice, 1, 0.5);
  std::vector<double> density(static_cast<std::size_t>(cells.size())), values(density.size());
  ImplicitSpline<Dim>(lattice, support).sample(centres, density.data(), threads);
  ImplicitSpline<Dim>(lattice, coefficients).sample(centres, values.data(), threads);

  constexpr std::int8_t unvisited = 2, again = 3;
  far.Sign.resize(values.size());
  for (std::size_t c = 0; c < density.size(); ++c)
  {
    far.Sign[c] = density[c] < threshold ? unvisited : 0;
  }
  std::vector<std::int64_t> region;
  const auto signRegions = [&](bool last)
  {
    for (std::size_t seed = 0; seed < far.Sign.size(); ++seed)
    {
      if (far.Sign[seed] != unvisited)
      {
        continue;
      }
      std::int64_t positive = 0, negative = 0;
      region.assign(1, static_cast<std::int64_t>(seed));
      far.Sign[seed] = 1;
      for (std::size_t next = 0; next < region.size(); ++next)
      {
        cells.forNeighbours(region[next],
          [&](std::int64_t neighbour)
          {
            const auto c = static_cast<std::size_t>(neighbour);
            if (far.Sign[c] == unvisited)
            {
              far.Sign[c] = 1;
              region.push_back(neighbour);
            }
            else if (far.Sign[c] == 0)
            {
              positive += values[c] > 0;
              negative += values[c] < 0;
            }
          });
      }
      // A few stray cells on the rim are noise; a rim that meets both sides is not.
      const bool mixed = 10 * std::min(positive, negative) > positive + negative;
      far.NumberOfMixedRegions += mixed && last;
      for (const std::int64_t cell : region)
      {
        const auto c = static_cast<std::size_t>(cell);
        if (mixed && !last)
        {
          far.Sign[c] = density[c] < MixedRegionShare * threshold ? again : 0;
        }
        else if (negative > positive)
        {
          far.Sign[c] = -1;
        }
      }
    }
  };
  signRegions(false);
  std::replace(far.Sign.begin(), far.Sign.end(), again, unvisited);
  signRegions(true);
}

/// Step 2: regions of one sign that no data point vouches for take the other.
template <int Dim>
void flipUnvouchedRegions(const Lattice<Dim>& lattice, const Vector& coefficients,
  const Points<Dim>& outside, const Points<Dim>& inside, const Points<Dim>& dataPoints, int threads,
  FarField& far)
{
  const Grid<Dim> cells{ lattice.numberOfCellsPerAxis() };
  Grid<Dim> nodes;
  for (int a = 0; a < Dim; ++a)
  {
    nodes.Count[a] = 2 * cells.Count[a] + 1;
  }
  std::vector<std::int8_t> sign(static_cast<std::size_t>(nodes.size()));
  {
    std::vector<float> values(sign.size());
    const ImplicitSpline<Dim> function(lattice, coefficients, far);
    function.sample(gridPositions(lattice, 2, 0), values.data(), threads);
    std::transform(values.begin(), values.end(), sign.begin(),
      [](float v) { return static_cast<std::int8_t>(v < 0 ? -1 : 1); });
  }

  // Everything that a vouching position reaches without a change of sign is vouched for.
  std::vector<char> vouched(sign.size(), 0);
  std::vector<std::int64_t> front;
  const auto vouch = [&](const Points<Dim>& positions, int expected)
  {
    for (std::int64_t k = 0; k < positions.cols(); ++k)
    {
      Index<Dim> at;
      for (int a = 0; a < Dim; ++a)
      {
        const auto nearest =
          static_cast<std::int64_t>(std::lround(2 * positions(a, k) / lattice.Spacing[a]));
        at[a] = std::min(std::max<std::int64_t>(nearest, 0), nodes.Count[a] - 1);
      }
      const std::int64_t node = nodes.flat(at);
      if (sign[static_cast<std::size_t>(node)] == expected &&
        !vouched[static_cast<std::size_t>(node)])
      {
        vouched[static_cast<std::size_t>(node)] = 1;
        front.push_back(node);
      }
    }
  };
  vouch(outside, 1);
  vouch(inside, -1);
  while (!front.empty())
  {
    const std::int64_t node = front.back();
    front.pop_back();
    nodes.forNeighbours(node,
      [&](std::int64_t neighbour)
      {
        const auto n = static_cast<std::size_t>(neighbour);
        if (!vouched[n] && sign[n] == sign[static_cast<std::size_t>(node)])
        {
          vouched[n] = 1;
          front.push_back(neighbour);
        }
      });
  }

  std::vector<char> holdsData(static_cast<std::size_t>(cells.size()), 0);
  for (std::int64_t k = 0; k < dataPoints.cols(); ++k)
  {
    Index<Dim> cell;
    for (int a = 0; a < Dim; ++a)
    {
      cell[a] = lattice.locate(dataPoints(a, k), a).Cell;
    }
    holdsData[static_cast<std::size_t>(cells.flat(cell))] = 1;
  }
  for (std::int64_t c = 0; c < cells.size(); ++c)
  {
    if (holdsData[static_cast<std::size_t>(c)])
    {
      continue;
    }
    const Index<Dim> cell = cells.position(c);
    int flip = 0;              // the sign of the unvouched nodes, negated
    bool ambiguous = false;    // a vouched node of their sign, or unvouched ones of both
    std::array<int, 3> seen{}; // whether vouched nodes of sign -1 and +1 occur
    int strides = 1;
    for (int a = 0; a < Dim; ++a)
    {
      strides *= 3;
    }
    for (int k = 0; k < strides; ++k)
    {
      Index<Dim> node;
      for (int a = 0, rest = k; a < Dim; ++a, rest /= 3)
      {
        node[a] = 2 * cell[a] + rest % 3;
      }
      const auto n = static_cast<std::size_t>(nodes.flat(node));
      if (vouched[n])
      {
        seen[static_cast<std::size_t>(sign[n] + 1)] = 1;
      }
      else
      {
        ambiguous = ambiguous || flip == sign[n];
        flip = -sign[n];
      }
    }
    if (flip != 0 && !ambiguous && !seen[static_cast<std::size_t>(1 - flip)])
    {
      far.Sign[static_cast<std::size_t>(c)] = static_cast<std::int8_t>(flip);
    }
  }
}
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
  FarField far;
  far.Magnitude = options.Magnitude;
  const int threads = resolveThreads(options.Threads);
  signUnsupportedRegions(lattice, support, coefficients, options.Threshold, threads, far);
  flipUnvouchedRegions(lattice, coefficients, outside, inside, dataPoints, threads, far);
  return far;
}

template double medianSupport<2>(const Lattice<2>&, const Vector&, const Points<2>&, int);
template double medianSupport<3>(const Lattice<3>&, const Vector&, const Points<3>&, int);
template FarField computeFarField<2>(const Lattice<2>&, const Vector&, const Vector&,
  const Points<2>&, const Points<2>&, const Points<2>&, const FarFieldOptions&);
template FarField computeFarField<3>(const Lattice<3>&, const Vector&, const Vector&,
  const Points<3>&, const Points<3>&, const Points<3>&, const FarFieldOptions&);
}
