// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAScanFeathering.h"

#include "Core/Parallel.h"
#include "IPIAPointCloud.h"
#include "IPIAPointTree.h"

#include "vtkBoundingBox.h"
#include "vtkMath.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace ipia
{
namespace
{
/// Neighbours of a point that tell how near the border of its scan it is, and the one whose
/// distance is the spacing.
constexpr std::size_t Neighbours = 32, SpacingNeighbour = 4;
/// The shift of their mean, over their radius, where confidence falls to 1/e.
constexpr double TypicalShift = 0.1;
/// The least confidence, and the least factor.
constexpr double LeastConfidence = 0.05;
/// Another scan covers a point if it has one within so many spacings that faces the same way.
constexpr double ReachInSpacings = 2, LeastAgreement = 0.5;
/// Indices that a thread takes at a time.
constexpr std::int64_t Grain = 256;

/// The points of a cloud, from the first to before the last, that one scan has.
struct Scan
{
  std::size_t Begin = 0, End = 0;
  std::unique_ptr<PointTree> Tree;
  vtkBoundingBox Box;
  double Reach = 0;
};

std::vector<Scan> scansOf(const PointCloud& cloud)
{
  std::vector<Scan> scans;
  vtkIdType lastId = 0;
  std::size_t begin = 0;
  for (const auto& block : cloud.Blocks)
  {
    lastId += block->GetNumberOfPoints();
    const auto end = static_cast<std::size_t>(
      std::lower_bound(cloud.Ids.begin(), cloud.Ids.end(), lastId) - cloud.Ids.begin());
    if (end > begin)
    {
      scans.emplace_back();
      scans.back().Begin = begin;
      scans.back().End = end;
    }
    begin = end;
  }
  return scans;
}

/// Calls action(k, scratch) for the points of a scan; every k is independent of the others.
template <typename Action>
void forPoints(const Scan& scan, const Action& action)
{
  const auto begin = static_cast<std::int64_t>(scan.Begin);
  const auto end = static_cast<std::int64_t>(scan.End);
#pragma omp parallel num_threads(resolveThreads(0))
  {
    std::vector<PointTree::Neighbour> scratch;
#pragma omp for schedule(dynamic, Grain)
    for (std::int64_t k = begin; k < end; ++k)
    {
      action(static_cast<std::size_t>(k), scratch);
    }
  }
}

/// The confidence of each point of a scan by its place in it; the scan's tree and reach.
void findConfidence(const PointCloud& cloud, Scan& scan, std::vector<double>& confidence)
{
  SpacePoints points;
  for (std::size_t k = scan.Begin; k < scan.End; ++k)
  {
    points.push_back(cloud.Positions[k]);
    scan.Box.AddPoint(points.back().data());
  }
  scan.Tree = std::make_unique<PointTree>(points);
  std::vector<double> spacings(points.size());
  forPoints(scan,
    [&](std::size_t k, std::vector<PointTree::Neighbour>& found)
    {
      const PointTree::Position& x = cloud.Positions[k];
      scan.Tree->nearest(x, Neighbours + 1, found); // with itself
      PointTree::Position shift{};
      for (const PointTree::Neighbour& next : found)
      {
        for (std::size_t a = 0; a < 3; ++a)
        {
          shift[a] += points[static_cast<std::size_t>(next.Id)][a] - x[a];
        }
      }
      const double radius = std::sqrt(found.back().Distance2);
      const double relative =
        radius > 0 ? vtkMath::Norm(shift.data()) / (static_cast<double>(found.size()) * radius) : 0;
      const double inside = std::exp(-std::pow(relative / TypicalShift, 2));
      confidence[k] = LeastConfidence + (1 - LeastConfidence) * inside;
      spacings[k - scan.Begin] =
        std::sqrt(found[std::min(SpacingNeighbour, found.size() - 1)].Distance2);
    });
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  scan.Reach = ReachInSpacings * *middle;
}

/// The largest confidence with which other scans cover a point; 0 if none does.
double coverOf(std::size_t k, const Scan& own, const std::vector<Scan>& scans,
  const PointCloud& cloud, const std::vector<double>& confidence,
  std::vector<PointTree::Neighbour>& found)
{
  const PointTree::Position& x = cloud.Positions[k];
  const auto& normal = cloud.Normals[k];
  double cover = 0;
  for (const Scan& other : scans)
  {
    vtkBoundingBox box = other.Box;
    box.Inflate(own.Reach);
    if (&other == &own || !box.ContainsPoint(x.data()))
    {
      continue;
    }
    other.Tree->nearest(x, 1, found, own.Reach);
    if (found.empty())
    {
      continue;
    }
    const std::size_t near = other.Begin + static_cast<std::size_t>(found.front().Id);
    const bool counts = cloud.Weights.empty() || cloud.Weights[near] > 0;
    const bool agrees = vtkMath::Dot(normal.data(), cloud.Normals[near].data()) >= LeastAgreement;
    cover = counts && agrees ? std::max(cover, confidence[near]) : cover;
  }
  return cover;
}
}

std::vector<double> featherFactors(const PointCloud& cloud)
{
  std::vector<Scan> scans = scansOf(cloud);
  if (scans.size() < 2)
  {
    return {};
  }
  std::vector<double> confidence(cloud.Positions.size()), factors(cloud.Positions.size());
  for (Scan& scan : scans)
  {
    findConfidence(cloud, scan, confidence);
  }
  for (const Scan& scan : scans)
  {
    forPoints(scan,
      [&](std::size_t k, std::vector<PointTree::Neighbour>& found)
      {
        const double cover = coverOf(k, scan, scans, cloud, confidence, found);
        factors[k] = std::max(LeastConfidence, confidence[k] / std::max(cover, confidence[k]));
      });
  }
  return factors;
}
}
