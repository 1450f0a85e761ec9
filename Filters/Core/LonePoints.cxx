// SPDX-License-Identifier: BSD-3-Clause
#include "LonePoints.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace ipia
{
namespace
{
/// Side of the cubes in spacings (of squares three times that), and the most of them along the
/// longest side: a bound on memory.
constexpr double CubeSpacings = 2, MostCubes = 160;
/// Lone points have less than this share of the usual number of neighbours.
constexpr double LoneShare = 1. / 9;
/// Shares of lone points that matter, and that are an exception.
constexpr double FewLone = 0.003, ManyLone = 0.2;
/// The spacing without lone points is smaller, and shows more of them.
constexpr int SpacingRounds = 2;
}

template <int Dim>
Points<Dim> withoutLonePoints(const Points<Dim>& positions, const Box<Dim>& box, double spacing)
{
  const double longest = box.sides().maxCoeff();
  const double side = std::max(CubeSpacings * (Dim == 2 ? 3 : 1) * spacing, longest / MostCubes);
  if (!(side > 0))
  {
    return positions;
  }
  // A layer of empty cubes all around saves looking for the ends.
  Index<Dim> size;
  std::size_t total = 1;
  for (int a = 0; a < Dim; ++a)
  {
    size[a] = static_cast<std::int64_t>(box.sides()[a] / side) + 3;
    total *= static_cast<std::size_t>(size[a]);
  }
  const auto cubeOf = [&](std::int64_t k)
  {
    std::int64_t cube = 0;
    for (int a = Dim; a-- > 0;)
    {
      const auto at = static_cast<std::int64_t>((positions(a, k) - box.Lower[a]) / side);
      cube = cube * size[a] + at + 1;
    }
    return static_cast<std::size_t>(cube);
  };
  using Count = std::uint8_t;
  constexpr Count full = std::numeric_limits<Count>::max();
  std::vector<Count> counts(total, 0);
  double occupied = 0;
  for (std::int64_t k = 0; k < positions.cols(); ++k)
  {
    Count& count = counts[cubeOf(k)];
    occupied += count == 0;
    count = static_cast<Count>(count + (count < full));
  }
  // A surface crosses nine of 27 cubes about its points, a curve three of nine.
  const double usual = std::pow(3, Dim - 1) * static_cast<double>(positions.cols()) / occupied;
  const int most = static_cast<int>(std::min(LoneShare * usual, full - 1.));
  std::vector<std::int64_t> kept;
  kept.reserve(static_cast<std::size_t>(positions.cols()));
  for (std::int64_t k = 0; k < positions.cols(); ++k)
  {
    const std::size_t cube = cubeOf(k);
    int sum = 0;
    if (counts[cube] <= most)
    {
      for (int i = 0; i < (Dim == 2 ? 9 : 27) && sum <= most; ++i)
      {
        std::ptrdiff_t offset = 0, stride = 1;
        for (int a = 0, rest = i; a < Dim; ++a, rest /= 3)
        {
          offset += (rest % 3 - 1) * stride;
          stride *= size[a];
        }
        sum += counts[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cube) + offset)];
      }
    }
    else
    {
      sum = counts[cube];
    }
    if (sum > most)
    {
      kept.push_back(k);
    }
  }
  const auto n = static_cast<double>(positions.cols());
  const double lone = n - static_cast<double>(kept.size());
  if (lone < FewLone * n || lone > ManyLone * n)
  {
    return positions;
  }
  Points<Dim> others(Dim, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t k = 0; k < kept.size(); ++k)
  {
    others.col(static_cast<Eigen::Index>(k)) = positions.col(kept[k]);
  }
  return others;
}

template <int Dim>
double robustPointSpacing(const Points<Dim>& positions, const Box<Dim>& box, int threads)
{
  double spacing = pointSpacing(positions, box, threads);
  for (int round = 0; round < SpacingRounds; ++round)
  {
    const Points<Dim> others = withoutLonePoints(positions, box, spacing);
    if (others.cols() == positions.cols())
    {
      break;
    }
    spacing = pointSpacing(others, box, threads);
  }
  return spacing;
}

template Points<2> withoutLonePoints<2>(const Points<2>&, const Box<2>&, double);
template Points<3> withoutLonePoints<3>(const Points<3>&, const Box<3>&, double);
template double robustPointSpacing<2>(const Points<2>&, const Box<2>&, int);
template double robustPointSpacing<3>(const Points<3>&, const Box<3>&, int);
}
