// SPDX-License-Identifier: BSD-3-Clause
#include "ScanMotions.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

namespace ipia
{
namespace
{
using Twist = Eigen::Matrix<double, 6, 1>;
using TwistMatrix = Eigen::Matrix<double, 6, 6>;

/// Points of a scan in one cube count as at most so many: what they miss by is much the same.
constexpr double LargestCount = 8;
/// Median of absolute values to the scale beyond which they count little: three standard deviations
/// of a normal distribution.
constexpr double ScaleOfMedian = 3 / 0.6745;

/// What one scan shows in one cube.
struct Patch
{
  int Scan;
  double Weight;
  double Distance; ///< mean, then less that of the cube
};

struct Cube
{
  Twist Way = Twist::Zero(); ///< J_c, rotations in units of the radius
  std::vector<Patch> Patches;

  double weight() const
  {
    double sum = 0;
    for (const Patch& patch : this->Patches)
    {
      sum += patch.Weight;
    }
    return sum;
  }

  void centreDistances()
  {
    double mean = 0;
    for (const Patch& patch : this->Patches)
    {
      mean += patch.Weight * patch.Distance;
    }
    mean /= this->weight();
    for (Patch& patch : this->Patches)
    {
      patch.Distance -= mean;
    }
  }
};

/// The cube of a point, and which of six ways the surface faces.
using CubeKey = std::array<std::int64_t, 4>;

CubeKey keyOf(const ScanPoint& point, const Eigen::Vector3d& origin, double side)
{
  int axis = 0;
  point.Normal.cwiseAbs().maxCoeff(&axis);
  const Eigen::Vector3d at = (point.Position - origin) / side;
  return { static_cast<std::int64_t>(std::floor(at[0])),
    static_cast<std::int64_t>(std::floor(at[1])), static_cast<std::int64_t>(std::floor(at[2])),
    2 * axis + (point.Normal[axis] > 0) };
}

/// The cubes that more than one scan reaches.
std::vector<Cube> sharedCubes(
  const std::vector<ScanPoint>& points, const Eigen::Vector3d& centre, double radius, double side)
{
  // In an order that depends on the points alone.
  std::vector<std::tuple<CubeKey, int, std::size_t>> sorted;
  sorted.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    sorted.emplace_back(keyOf(points[k], centre, side), points[k].Scan, k);
  }
  std::sort(sorted.begin(), sorted.end());

  std::vector<Cube> cubes;
  for (std::size_t begin = 0; begin < sorted.size();)
  {
    Cube cube;
    std::size_t k = begin;
    for (; k < sorted.size() && std::get<0>(sorted[k]) == std::get<0>(sorted[begin]); ++k)
    {
      const ScanPoint& point = points[std::get<2>(sorted[k])];
      cube.Way.head<3>() += (point.Position - centre).cross(point.Normal) / radius;
      cube.Way.tail<3>() += point.Normal;
      if (cube.Patches.empty() || cube.Patches.back().Scan != point.Scan)
      {
        cube.Patches.push_back({ point.Scan, 0, 0 });
      }
      cube.Patches.back().Weight += 1;
      cube.Patches.back().Distance += point.Distance;
    }
    if (cube.Patches.size() > 1)
    {
      cube.Way /= static_cast<double>(k - begin);
      for (Patch& patch : cube.Patches)
      {
        patch.Distance /= patch.Weight;
        patch.Weight = std::min(patch.Weight, LargestCount);
      }
      cube.centreDistances();
      cubes.push_back(std::move(cube));
    }
    begin = k;
  }
  return cubes;
}

/// Lessens the weights of scans that are far from the others of their cube.
void trustAgreement(std::vector<Cube>& cubes)
{
  std::vector<double> distances;
  for (const Cube& cube : cubes)
  {
    for (const Patch& patch : cube.Patches)
    {
      distances.push_back(std::abs(patch.Distance));
    }
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const double scale = ScaleOfMedian * *middle;
  if (!(scale > 0))
  {
    return;
  }
  for (Cube& cube : cubes)
  {
    for (Patch& patch : cube.Patches)
    {
      const double relative = patch.Distance / scale;
      const double trust = 1 + relative * relative;
      patch.Weight /= trust * trust;
    }
    cube.centreDistances();
  }
}

/// The normal equations' matrix without the part that damps, by pairs of scans, first <= second.
using PairMatrices = std::map<std::pair<int, int>, TwistMatrix>;

std::vector<Twist> solve(const std::vector<Cube>& cubes, int numberOfScans)
{
  PairMatrices matrices;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * numberOfScans);
  for (const Cube& cube : cubes)
  {
    const TwistMatrix square = cube.Way * cube.Way.transpose();
    const double weight = cube.weight();
    for (std::size_t a = 0; a < cube.Patches.size(); ++a)
    {
      const Patch& first = cube.Patches[a];
      right.segment<6>(6 * first.Scan) -= first.Weight * first.Distance * cube.Way;
      for (std::size_t b = a; b < cube.Patches.size(); ++b)
      {
        const Patch& second = cube.Patches[b];
        const double own = a == b ? first.Weight : 0;
        const auto entry =
          matrices.try_emplace({ first.Scan, second.Scan }, TwistMatrix::Zero()).first;
        entry->second += (own - first.Weight * second.Weight / weight) * square;
      }
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < 6 * numberOfScans; ++i)
  {
    entries.emplace_back(i, i, 1.0);
  }
  for (const auto& [scans, matrix] : matrices)
  {
    for (int i = 0; i < 6; ++i)
    {
      for (int j = 0; j < 6; ++j)
      {
        entries.emplace_back(6 * scans.second + i, 6 * scans.first + j, matrix(j, i));
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(6 * numberOfScans, 6 * numberOfScans);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solution =
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  std::vector<Twist> twists;
  for (int scan = 0; scan < numberOfScans; ++scan)
  {
    twists.emplace_back(solution.segment<6>(6 * scan));
  }
  return twists;
}

double rootMeanSquare(const std::vector<Cube>& cubes)
{
  double squares = 0, weights = 0;
  for (const Cube& cube : cubes)
  {
    for (const Patch& patch : cube.Patches)
    {
      squares += patch.Weight * patch.Distance * patch.Distance;
      weights += patch.Weight;
    }
  }
  return weights > 0 ? std::sqrt(squares / weights) : 0;
}
}

ScanMotions findScanMotions(const std::vector<ScanPoint>& points, int numberOfScans,
  const Eigen::Vector3d& centre, double radius, double cubeSide)
{
  ScanMotions motions;
  motions.Twists.assign(static_cast<std::size_t>(numberOfScans), Twist::Zero());
  std::vector<Cube> cubes = sharedCubes(points, centre, radius, cubeSide);
  if (cubes.empty())
  {
    return motions;
  }
  trustAgreement(cubes);
  motions.Misfit = rootMeanSquare(cubes);
  motions.Twists = solve(cubes, numberOfScans);
  for (Cube& cube : cubes)
  {
    motions.Overlaps += static_cast<std::int64_t>(cube.Patches.size());
    for (Patch& patch : cube.Patches)
    {
      patch.Distance += cube.Way.dot(motions.Twists[static_cast<std::size_t>(patch.Scan)]);
    }
    cube.centreDistances();
  }
  motions.Predicted = rootMeanSquare(cubes);
  for (Twist& twist : motions.Twists)
  {
    twist.head<3>() /= radius;
  }
  return motions;
}
}
