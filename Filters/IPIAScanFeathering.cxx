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
/// Neighbours of a point that tell how near the border of its scan it is, and the one of them,
/// of those that are elsewhere, whose distance is the spacing.
constexpr std::size_t Neighbours = 32, SpacingNeighbour = 4;
/// The shift of their mean, over their radius, where confidence falls to 1/e.
constexpr double TypicalShift = 0.1;
/// The least confidence, and the least factor.
constexpr double LeastConfidence = 0.05;
/// Another scan covers a point if it has one within so many spacings, of the scan whose are wider,
/// that faces the same way.
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
  /// Those that may cover points of this one.
  std::vector<std::size_t> Others;
};

class Feathering
{
public:
  explicit Feathering(const PointCloud& cloud);
  std::vector<double> factors();

private:
  const PointCloud& Cloud;
  SpacePoints Positions; ///< the longest side is 1, so that squares are within range
  std::vector<Scan> Scans;
  std::vector<std::size_t> ScanOf;
  std::vector<double> Confidence;

  void findScans();
  void findConfidence();
  void findOthers();
  double coverOf(std::size_t k, std::vector<PointTree::Neighbour>& found) const;

  /// Calls action(k, scratch) for all points; every k is independent of the others.
  template <typename Action>
  void forPoints(const Action& action) const
  {
    const auto n = static_cast<std::int64_t>(this->Positions.size());
#pragma omp parallel num_threads(resolveThreads(0))
    {
      std::vector<PointTree::Neighbour> scratch;
#pragma omp for schedule(dynamic, Grain)
      for (std::int64_t k = 0; k < n; ++k)
      {
        action(static_cast<std::size_t>(k), scratch);
      }
    }
  }
};

Feathering::Feathering(const PointCloud& cloud)
  : Cloud(cloud)
  , Positions(cloud.Positions)
  , ScanOf(cloud.Positions.size())
  , Confidence(cloud.Positions.size())
{
  const double side = cloud.longestSide();
  for (PointTree::Position& x : this->Positions)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      x[a] = (x[a] - cloud.Bounds[2 * a]) / side;
    }
  }
}

void Feathering::findScans()
{
  vtkIdType lastId = 0;
  std::size_t begin = 0;
  for (const auto& block : this->Cloud.Blocks)
  {
    lastId += block->GetNumberOfPoints();
    const auto& ids = this->Cloud.Ids;
    const auto end = static_cast<std::size_t>(
      std::lower_bound(ids.begin() + static_cast<std::ptrdiff_t>(begin), ids.end(), lastId) -
      ids.begin());
    if (end == begin)
    {
      continue;
    }
    this->Scans.emplace_back();
    Scan& scan = this->Scans.back();
    scan.Begin = begin;
    scan.End = end;
    SpacePoints points;
    for (std::size_t k = begin; k < end; ++k)
    {
      points.push_back(this->Positions[k]);
      scan.Box.AddPoint(points.back().data());
      this->ScanOf[k] = this->Scans.size() - 1;
    }
    scan.Tree = std::make_unique<PointTree>(points);
    begin = end;
  }
}

/// The confidence of each point by its place in its scan, and the reaches of the scans.
void Feathering::findConfidence()
{
  std::vector<double> spacings(this->Positions.size());
  this->forPoints(
    [&](std::size_t k, std::vector<PointTree::Neighbour>& found)
    {
      const PointTree::Position& x = this->Positions[k];
      const Scan& scan = this->Scans[this->ScanOf[k]];
      scan.Tree->nearest(x, Neighbours + 1, found); // with itself
      PointTree::Position shift{};
      std::size_t elsewhere = 0;
      for (const PointTree::Neighbour& next : found)
      {
        const PointTree::Position& y =
          this->Positions[scan.Begin + static_cast<std::size_t>(next.Id)];
        for (std::size_t a = 0; a < 3; ++a)
        {
          shift[a] += y[a] - x[a];
        }
        elsewhere += next.Distance2 > 0 ? 1 : 0;
        if (elsewhere <= SpacingNeighbour)
        {
          spacings[k] = std::sqrt(next.Distance2);
        }
      }
      const double radius = static_cast<double>(found.size()) * std::sqrt(found.back().Distance2);
      const double relative = vtkMath::Norm(shift.data()) / radius;
      const double inside = radius > 0 ? std::exp(-std::pow(relative / TypicalShift, 2)) : 0;
      this->Confidence[k] = LeastConfidence + (1 - LeastConfidence) * inside;
    });
  for (Scan& scan : this->Scans)
  {
    const auto first = spacings.begin() + static_cast<std::ptrdiff_t>(scan.Begin);
    const auto last = spacings.begin() + static_cast<std::ptrdiff_t>(scan.End);
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last);
    scan.Reach = ReachInSpacings * *middle;
  }
}

void Feathering::findOthers()
{
  for (Scan& scan : this->Scans)
  {
    for (std::size_t other = 0; other < this->Scans.size(); ++other)
    {
      vtkBoundingBox box = this->Scans[other].Box;
      box.Inflate(std::max(scan.Reach, this->Scans[other].Reach));
      if (&this->Scans[other] != &scan && box.Intersects(scan.Box))
      {
        scan.Others.push_back(other);
      }
    }
  }
}

/// The largest confidence with which other scans cover a point; 0 if none does.
double Feathering::coverOf(std::size_t k, std::vector<PointTree::Neighbour>& found) const
{
  const Scan& own = this->Scans[this->ScanOf[k]];
  const auto& normals = this->Cloud.Normals;
  const auto& weights = this->Cloud.Weights;
  double cover = 0;
  for (const std::size_t index : own.Others)
  {
    const Scan& other = this->Scans[index];
    other.Tree->nearest(this->Positions[k], 1, found, std::max(own.Reach, other.Reach));
    if (found.empty())
    {
      continue;
    }
    const std::size_t near = other.Begin + static_cast<std::size_t>(found.front().Id);
    const bool counts = weights.empty() || weights[near] > 0;
    const bool agrees = vtkMath::Dot(normals[k].data(), normals[near].data()) >= LeastAgreement;
    cover = counts && agrees ? std::max(cover, this->Confidence[near]) : cover;
  }
  return cover;
}

std::vector<double> Feathering::factors()
{
  this->findScans();
  if (this->Scans.size() < 2)
  {
    return {};
  }
  this->findConfidence();
  this->findOthers();
  std::vector<double> factors(this->Positions.size());
  this->forPoints(
    [&](std::size_t k, std::vector<PointTree::Neighbour>& found)
    {
      const double own = this->Confidence[k];
      factors[k] = std::max(LeastConfidence, own / std::max(this->coverOf(k, found), own));
    });
  return factors;
}
}

std::vector<double> featherFactors(const PointCloud& cloud)
{
  return Feathering(cloud).factors();
}
}
