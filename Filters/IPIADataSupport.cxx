// SPDX-License-Identifier: BSD-3-Clause
#include "IPIADataSupport.h"

#include "Core/Parallel.h"

#include "vtkMath.h"

#include <algorithm>
#include <cmath>

namespace ipia
{
namespace
{
/// Data points that may be the nearest one in local spacings.
constexpr std::size_t Candidates = 8;
/// Neighbours whose median spacing is taken, with the point itself.
constexpr std::size_t Median = 9;
/// Neighbours that are sorted into sectors; more where too few sectors have one: along the lines of
/// a scanner points may be twenty times as dense as across.
constexpr std::size_t FirstNeighbours = 16, MostNeighbours = 64;
constexpr std::size_t Sectors = 6, CountingSector = 3;
/// The neighbour that counts where there is no normal.
constexpr std::size_t CountingNeighbour = 4;
/// Indices that a thread takes at a time.
constexpr std::int64_t Grain = 128;

/// Calls action(k, scratch) for all k < n; every k is independent of the others.
template <typename Action>
void forAll(std::size_t n, const Action& action)
{
  const auto count = static_cast<std::int64_t>(n);
#pragma omp parallel num_threads(resolveThreads(0))
  {
    std::vector<PointTree::Neighbour> scratch;
#pragma omp for schedule(dynamic, Grain)
    for (std::int64_t k = 0; k < count; ++k)
    {
      action(static_cast<std::size_t>(k), scratch);
    }
  }
}

/// The ids whose value is still unknown (negative), each once; they are marked as coming.
std::vector<vtkIdType> takeUnknown(const std::vector<vtkIdType>& ids, std::vector<double>& values)
{
  std::vector<vtkIdType> unknown;
  for (const vtkIdType id : ids)
  {
    double& value = values[static_cast<std::size_t>(id)];
    if (value < 0)
    {
      value = 0;
      unknown.push_back(id);
    }
  }
  return unknown;
}
}

DataSupport::DataSupport(
  const SpacePoints& positions, const SpacePoints& normals, int flatAxis, double least)
  : Positions(positions)
  , Normals(normals)
  , FlatAxis(flatAxis)
  , Least(least)
  , Tree(positions)
  , Own(positions.size(), -1)
  , Spacing(positions.size(), -1)
{
}

std::vector<DataSupport::Reach> DataSupport::reach(const std::vector<Position>& x)
{
  const std::size_t most = std::min(Candidates, this->Positions.size());
  std::vector<vtkIdType> near(most * x.size());
  forAll(x.size(),
    [&](std::size_t k, std::vector<PointTree::Neighbour>& found)
    {
      this->Tree.nearest(x[k], most, found);
      for (std::size_t i = 0; i < most; ++i)
      {
        near[most * k + i] = found[i].Id;
      }
    });
  this->provideSpacings(near);
  std::vector<Reach> reaches(x.size());
  forAll(x.size(),
    [&](std::size_t k, std::vector<PointTree::Neighbour>&)
    {
      Reach& reach = reaches[k];
      reach = { VTK_DOUBLE_MAX, VTK_DOUBLE_MAX };
      for (std::size_t i = 0; i < most; ++i)
      {
        const auto p = static_cast<std::size_t>(near[most * k + i]);
        const double distance =
          std::sqrt(vtkMath::Distance2BetweenPoints(x[k].data(), this->Positions[p].data()));
        reach.Distance = std::min(reach.Distance, distance / this->Spacing[p]);
        reach.Room = std::min(reach.Room, distance - Margin * this->Spacing[p]);
      }
    });
  return reaches;
}

const DataSupport::Position& DataSupport::normalNear(const Position& x) const
{
  std::vector<PointTree::Neighbour> found;
  this->Tree.nearest(x, 1, found);
  return this->Normals[static_cast<std::size_t>(found.front().Id)];
}

void DataSupport::provideSpacings(const std::vector<vtkIdType>& points)
{
  const std::vector<vtkIdType> wanted = takeUnknown(points, this->Spacing);
  const std::size_t most = std::min(Median, this->Positions.size());
  std::vector<vtkIdType> around(most * wanted.size());
  forAll(wanted.size(),
    [&](std::size_t k, std::vector<PointTree::Neighbour>& found)
    {
      this->Tree.nearest(this->Positions[static_cast<std::size_t>(wanted[k])], most, found);
      for (std::size_t i = 0; i < most; ++i)
      {
        around[most * k + i] = found[i].Id;
      }
    });
  const std::vector<vtkIdType> own = takeUnknown(around, this->Own);
  forAll(own.size(),
    [&](std::size_t k, std::vector<PointTree::Neighbour>& found)
    { this->Own[static_cast<std::size_t>(own[k])] = this->ownSpacing(own[k], found); });
  forAll(wanted.size(),
    [&](std::size_t k, std::vector<PointTree::Neighbour>&)
    {
      std::array<double, Median> spacings{};
      for (std::size_t i = 0; i < most; ++i)
      {
        spacings[i] = this->Own[static_cast<std::size_t>(around[most * k + i])];
      }
      const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(most / 2);
      std::nth_element(
        spacings.begin(), middle, spacings.begin() + static_cast<std::ptrdiff_t>(most));
      this->Spacing[static_cast<std::size_t>(wanted[k])] = *middle;
    });
}

double DataSupport::ownSpacing(vtkIdType point, std::vector<PointTree::Neighbour>& found) const
{
  const bool plane = this->FlatAxis >= 0;
  const Position& x = this->Positions[static_cast<std::size_t>(point)];
  const Position& normal = this->Normals[static_cast<std::size_t>(point)];
  const bool hasNormal = vtkMath::Norm(normal.data()) > 0;
  double u[3], v[3] = { 0, 0, 0 };
  if (plane)
  {
    v[this->FlatAxis] = 1;
    vtkMath::Cross(normal.data(), v, u);
  }
  else if (hasNormal)
  {
    vtkMath::Perpendiculars(normal.data(), u, v, 0);
  }
  const std::size_t sectors = !hasNormal ? 1 : plane ? 2 : Sectors;
  const std::size_t counting = std::min(CountingSector, sectors);
  for (std::size_t neighbours = FirstNeighbours;; neighbours = MostNeighbours)
  {
    this->Tree.nearest(x, neighbours, found);
    std::array<double, Sectors> nearest;
    nearest.fill(VTK_DOUBLE_MAX);
    std::size_t others = 0, occupied = 0;
    for (const PointTree::Neighbour& next : found)
    {
      if (next.Distance2 == 0)
      {
        continue; // the point itself or another in its place
      }
      double to[3];
      vtkMath::Subtract(this->Positions[static_cast<std::size_t>(next.Id)].data(), x.data(), to);
      std::size_t sector = 0;
      if (hasNormal)
      {
        const double angle = std::atan2(vtkMath::Dot(to, v), vtkMath::Dot(to, u)) + vtkMath::Pi();
        sector = plane
          ? (vtkMath::Dot(to, u) < 0 ? 0 : 1)
          : std::min(sectors - 1,
              static_cast<std::size_t>(angle / (2 * vtkMath::Pi()) * static_cast<double>(sectors)));
      }
      ++others;
      // Without a normal, the given neighbour or the farthest of fewer.
      if (nearest[sector] == VTK_DOUBLE_MAX)
      {
        ++occupied;
        nearest[sector] = std::sqrt(next.Distance2);
      }
      else if (!hasNormal && others <= CountingNeighbour)
      {
        nearest[sector] = std::sqrt(next.Distance2);
      }
    }
    if (occupied >= counting || plane || neighbours == MostNeighbours)
    {
      if (occupied == 0)
      {
        return this->Least;
      }
      std::sort(nearest.begin(), nearest.end());
      return std::max(this->Least, nearest[std::min(counting, occupied) - 1]);
    }
  }
}
}
