// SPDX-License-Identifier: BSD-3-Clause
#include "IPIATrim.h"

#include "IPIACells.h"
#include "IPIAClip.h"
#include "IPIAComponents.h"
#include "IPIADataSupport.h"
#include "IPIAOccupiedCells.h"
#include "IPIAPointCloud.h"

#include "vtkMath.h"
#include "vtkTriangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <unordered_map>

namespace ipia
{
namespace
{
using Position = DataSupport::Position;

/// A vertex this near to a side of the domain lies on it, in sample spacings: Newton's step moved
/// it.
constexpr double OnSide = 0.5;
/// Of an unsupported part, this share of the vertices or more is in cells far from all data.
constexpr double FarShare = 0.25;
/// Data around a hole face one way where the mean of their normals is at least this long.
constexpr double LeastAgreementOfRim = 0.7;
/// A part of a surface is hidden from where these data were seen if it faces that way with less
/// than this share of its area.
constexpr double MostHidden = 0.5;

double distanceBetween(const Position& a, const Position& b)
{
  return std::sqrt(vtkMath::Distance2BetweenPoints(a.data(), b.data()));
}

bool isOnSide(const Position& x, const TrimOptions& options)
{
  for (std::size_t a = 0; a < 3; ++a)
  {
    const double reach = OnSide * options.SampleSpacing[a];
    if (options.Cells[a] > 0 &&
      (x[a] < options.Domain[2 * a] + reach || x[a] > options.Domain[2 * a + 1] - reach))
    {
      return true;
    }
  }
  return false;
}

/// Finds the parts to cut off, and a function on the vertices that is negative there and 0 on the
/// line of the cut.
class Trim
{
public:
  Trim(vtkPolyData* surface, const TrimOptions& options)
    : Surface(surface)
    , Options(options)
  {
  }

  /// Where the search for unsupported parts begins: far from all occupied cells, and on the sides
  /// of the domain. None if no part can be large and none can reach a side.
  std::vector<std::size_t> seeds(const PointCloud& data) const
  {
    const OccupiedCells occupied(this->Options.Domain, this->Options.Cells, data.Positions);
    const auto n = static_cast<std::size_t>(this->Surface->GetNumberOfPoints());
    std::vector<std::size_t> found, farCells;
    for (std::size_t i = 0; i < n; ++i)
    {
      const Position x = this->at(i);
      const std::size_t cell = occupied.indexOf(x);
      const bool isFar = !occupied.isNear(cell);
      if (isFar || isOnSide(x, this->Options))
      {
        found.push_back(i);
      }
      if (isFar)
      {
        farCells.push_back(cell);
      }
    }
    const auto all = static_cast<double>(n), far = static_cast<double>(farCells.size());
    const bool noneOnSide = found.size() == farCells.size() &&
      std::none_of(found.begin(), found.end(),
        [this](std::size_t i) { return isOnSide(this->at(i), this->Options); });
    if (noneOnSide &&
      occupied.largestCluster(std::move(farCells)) <=
        this->Options.HoleSize * (FarShare * all - far))
    {
      found.clear();
    }
    return found;
  }

  /// All unsupported vertices that are connected with the seeds.
  void spread(std::vector<std::size_t> front, DataSupport& support, const Neighbours& neighbours)
  {
    const auto n = static_cast<std::size_t>(this->Surface->GetNumberOfPoints());
    this->Distance.assign(n, Unknown);
    this->Unsupported.assign(n, 0);
    while (!front.empty())
    {
      std::vector<Position> positions;
      for (const std::size_t i : front)
      {
        positions.push_back(this->at(i));
      }
      const std::vector<DataSupport::Reach> reaches = support.reach(positions);
      for (std::size_t k = 0; k < front.size(); ++k)
      {
        const double limit = isOnSide(positions[k], this->Options) ? this->Options.DistanceOnSide
                                                                   : this->Options.Distance;
        this->Distance[front[k]] = reaches[k].Distance;
        this->Unsupported[front[k]] = reaches[k].Distance > limit;
      }
      std::vector<std::size_t> next;
      for (const std::size_t i : front)
      {
        if (this->isUnsupported(i))
        {
          neighbours.forAll(i,
            [&](std::size_t j)
            {
              if (this->Distance[j] == Unknown)
              {
                this->Distance[j] = Coming;
                next.push_back(j);
              }
            });
        }
      }
      front.swap(next);
    }
  }

  /// Chooses among the connected unsupported parts. Returns how many are to be cut off.
  int choose(const DataSupport& support)
  {
    DisjointSets sets(static_cast<vtkIdType>(this->Distance.size()));
    forSimplices(this->Surface,
      [&](vtkIdType n, const vtkIdType* ids)
      {
        for (vtkIdType i = 0; i < n; ++i)
        {
          for (vtkIdType j = i + 1; j < n; ++j)
          {
            if (this->isUnsupported(ids[i]) && this->isUnsupported(ids[j]))
            {
              sets.unite(ids[i], ids[j]);
            }
          }
        }
      });
    const std::vector<vtkIdType> part = sets.labels();
    std::unordered_map<vtkIdType, double> sizes;
    std::unordered_map<vtkIdType, bool> cut;
    double supported = 0;
    forSimplices(this->Surface,
      [&](vtkIdType n, const vtkIdType* ids)
      {
        const double share = this->sizeOf(n, ids) / static_cast<double>(n);
        for (vtkIdType k = 0; k < n; ++k)
        {
          (this->isUnsupported(ids[k]) ? sizes[part[static_cast<std::size_t>(ids[k])]]
                                       : supported) += share;
        }
      });
    for (const auto& [label, size] : sizes)
    {
      cut[label] = size > this->Options.HoleSize * supported;
    }
    for (std::size_t i = 0; i < this->Distance.size(); ++i)
    {
      if (this->isUnsupported(i) && isOnSide(this->at(i), this->Options))
      {
        cut[part[i]] = true;
      }
    }
    const auto isCut = [](const auto& entry) { return entry.second; };
    if (std::any_of(cut.begin(), cut.end(), isCut))
    {
      // The data are open: a closed surface stays closed.
      for (const auto& [label, facing] : this->facingsOf(part, support))
      {
        cut[label] = cut[label] || facing.isHidden();
      }
    }
    this->Cut.assign(this->Distance.size(), 0);
    for (std::size_t i = 0; i < this->Distance.size(); ++i)
    {
      this->Cut[i] = this->isUnsupported(i) && cut[part[i]];
    }
    return static_cast<int>(std::count_if(cut.begin(), cut.end(), isCut));
  }

  /// A function that is negative at what is to be cut off: the distance from where support ends,
  /// along the surface, less the room that there is up to the margin of the data.
  std::vector<double> levels(DataSupport& support, const Neighbours& neighbours) const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<Edge> edges; // across the end of support
    std::vector<Position> ends;
    for (std::size_t i = 0; i < this->Cut.size(); ++i)
    {
      if (this->Cut[i])
      {
        neighbours.forAll(i,
          [&](std::size_t j)
          {
            if (!this->Cut[j])
            {
              edges.push_back({ i, j });
              ends.push_back(this->endOfSupport(i, j));
            }
          });
      }
    }
    const std::vector<DataSupport::Reach> rooms = support.reach(ends);
    const auto levelAt = [&](std::size_t point, std::size_t end)
    { return distanceBetween(this->at(point), ends[end]) - rooms[end].Room; };

    std::vector<double> level(this->Cut.size(), infinity);
    std::priority_queue<Step, std::vector<Step>, std::greater<Step>> queue;
    const auto offer = [&](std::size_t point, std::size_t end)
    {
      const double next = levelAt(point, end);
      if (!this->Cut[point] && next < level[point])
      {
        level[point] = next;
        queue.push({ next, point, end });
      }
    };
    for (std::size_t end = 0; end < edges.size(); ++end)
    {
      offer(edges[end].Outside, end);
    }
    while (!queue.empty() && queue.top().Level < 0)
    {
      const Step step = queue.top();
      queue.pop();
      if (step.Level == level[step.Point])
      {
        neighbours.forAll(step.Point, [&](std::size_t j) { offer(j, step.End); });
      }
    }
    for (std::size_t i = 0; i < level.size(); ++i)
    {
      level[i] = this->Cut[i] ? -infinity : level[i];
    }
    for (std::size_t end = 0; end < edges.size(); ++end)
    {
      // As much below the level of the end as it lies beyond it.
      const std::size_t i = edges[end].Inside;
      level[i] = std::max(level[i], -rooms[end].Room - distanceBetween(this->at(i), ends[end]));
    }
    return level;
  }

private:
  static constexpr double Unknown = -1, Coming = -2;

  struct Edge
  {
    std::size_t Inside, Outside; ///< of what is cut off
  };

  /// The level of a point, by the end of support that it was reached from.
  struct Step
  {
    double Level;
    std::size_t Point, End;

    bool operator>(const Step& other) const
    {
      return std::tie(this->Level, this->Point, this->End) >
        std::tie(other.Level, other.Point, other.End);
    }
  };

  /// The place on an edge, from an unsupported to a supported vertex, where support ends.
  Position endOfSupport(std::size_t i, std::size_t j) const
  {
    const double limit = this->Options.Distance, di = this->Distance[i], dj = this->Distance[j];
    const double t = di > limit && dj < limit ? (di - limit) / (di - dj) : 0;
    return between(this->at(i), this->at(j), t);
  }

  Position at(std::size_t i) const { return positionOf(this->Surface, static_cast<vtkIdType>(i)); }

  template <typename Id>
  bool isUnsupported(Id i) const
  {
    return this->Unsupported[static_cast<std::size_t>(i)] != 0;
  }

  /// Which ways an unsupported part and the data around it face.
  struct Facing
  {
    Position Part{}; ///< sum of the areas with their normals
    double Area = 0;
    Position Rim{}; ///< sum of the normals of the data nearest to its border
    double RimSize = 0;

    /// Whether data that mostly face one way surround a part that does not.
    bool isHidden() const
    {
      const double rim = vtkMath::Norm(this->Rim.data());
      return rim > LeastAgreementOfRim * this->RimSize &&
        vtkMath::Dot(this->Part.data(), this->Rim.data()) < MostHidden * this->Area * rim;
    }
  };

  /// Of every unsupported part of triangles.
  std::unordered_map<vtkIdType, Facing> facingsOf(
    const std::vector<vtkIdType>& part, const DataSupport& support) const
  {
    std::unordered_map<vtkIdType, Facing> facings;
    std::vector<std::pair<vtkIdType, vtkIdType>> rim; // parts and vertices beside them
    forCells(this->Surface->GetPolys(),
      [&](vtkIdType n, const vtkIdType* ids)
      {
        const Position corners[3] = { this->at(ids[0]), this->at(ids[1]), this->at(ids[2]) };
        Position area;
        vtkTriangle::ComputeNormalDirection(
          corners[0].data(), corners[1].data(), corners[2].data(), area.data());
        for (vtkIdType k = 0; k < n; ++k)
        {
          if (!this->isUnsupported(ids[k]))
          {
            continue;
          }
          const vtkIdType label = part[static_cast<std::size_t>(ids[k])];
          Facing& facing = facings[label];
          vtkMath::Add(facing.Part.data(), area.data(), facing.Part.data());
          facing.Area += vtkMath::Norm(area.data());
          for (vtkIdType other = 0; other < n; ++other)
          {
            if (!this->isUnsupported(ids[other]))
            {
              rim.emplace_back(label, ids[other]);
            }
          }
        }
      });
    std::sort(rim.begin(), rim.end());
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    for (const auto& [label, vertex] : rim)
    {
      Facing& facing = facings[label];
      const Position& normal = support.normalNear(this->at(static_cast<std::size_t>(vertex)));
      vtkMath::Add(facing.Rim.data(), normal.data(), facing.Rim.data());
      facing.RimSize += vtkMath::Norm(normal.data());
    }
    return facings;
  }

  double sizeOf(vtkIdType n, const vtkIdType* ids) const
  {
    const Position a = positionOf(this->Surface, ids[0]), b = positionOf(this->Surface, ids[1]);
    return n == 2
      ? distanceBetween(a, b)
      : vtkTriangle::TriangleArea(a.data(), b.data(), positionOf(this->Surface, ids[2]).data());
  }

  vtkPolyData* Surface;
  const TrimOptions& Options;
  std::vector<double> Distance; ///< in local spacings; negative where it was not asked for
  std::vector<char> Unsupported, Cut;
};

}

TrimResult trimUnsupported(vtkPolyData* surface, const PointCloud& data, const TrimOptions& options)
{
  TrimResult result;
  if (surface->GetNumberOfPoints() > std::numeric_limits<std::uint32_t>::max())
  {
    return result;
  }
  Trim trim(surface, options);
  std::vector<std::size_t> seeds = trim.seeds(data);
  if (seeds.empty())
  {
    return result;
  }
  std::vector<double> level;
  {
    const Neighbours neighbours(surface);
    const auto across = std::find(options.Cells.begin(), options.Cells.end(), 0);
    const auto flatAxis =
      across == options.Cells.end() ? -1 : static_cast<int>(across - options.Cells.begin());
    // Vertices can not follow a border any finer.
    const double least =
      *std::max_element(options.SampleSpacing.begin(), options.SampleSpacing.end());
    DataSupport support(data.Positions, data.Normals, flatAxis, least);
    trim.spread(std::move(seeds), support, neighbours);
    result.Parts = trim.choose(support);
    if (result.Parts == 0)
    {
      return result;
    }
    level = trim.levels(support, neighbours);
  }
  result.NewPoints = clipBelowZero(surface, std::move(level));
  return result;
}
}
