// SPDX-License-Identifier: BSD-3-Clause
#include "IPIATrim.h"

#include "IPIAComponents.h"
#include "IPIADataSupport.h"
#include "IPIAPointCloud.h"

#include "vtkCellArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
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
/// A cut that would pass an edge's end by less than this share of the edge goes through the end.
constexpr double Snap = 0.1;
/// Of an unsupported part, this share of the vertices or more is in cells far from all data.
constexpr double FarShare = 0.25;
/// Occupied cells hold at least this many points on average, so that few cells among them are
/// empty.
constexpr double PointsPerCell = 1.5;
/// Knot cells are taken together until there are no more than this: a bound on memory.
constexpr std::int64_t MostCells = std::int64_t{ 1 } << 27;

Position positionOf(vtkPolyData* surface, vtkIdType id)
{
  Position x;
  surface->GetPoint(id, x.data());
  return x;
}

double distanceBetween(const Position& a, const Position& b)
{
  return std::sqrt(vtkMath::Distance2BetweenPoints(a.data(), b.data()));
}

Position between(const Position& a, const Position& b, double t)
{
  return { a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2]) };
}

/// Calls action(number of points, point ids) for every cell of an array.
template <typename Action>
void forCells(vtkCellArray* cells, const Action& action)
{
  vtkIdType n = 0;
  const vtkIdType* ids = nullptr;
  for (cells->InitTraversal(); cells->GetNextCell(n, ids);)
  {
    action(n, ids);
  }
}

/// Calls action(number of points, point ids) for every triangle and every segment of a polyline.
template <typename Action>
void forSimplices(vtkPolyData* surface, const Action& action)
{
  forCells(surface->GetPolys(), action);
  forCells(surface->GetLines(),
    [&](vtkIdType n, const vtkIdType* ids)
    {
      for (vtkIdType k = 0; k + 1 < n; ++k)
      {
        action(vtkIdType{ 2 }, ids + k);
      }
    });
}

/// Which cells have data in them or in a cell beside them: knot cells, or more of them together
/// where data are sparse.
class OccupiedCells
{
public:
  OccupiedCells(const TrimOptions& options, const SpacePoints& data)
  {
    const auto enough = static_cast<double>(data.size()) / PointsPerCell;
    std::int64_t together = 1, total = this->choose(options, together);
    std::vector<std::array<std::int64_t, 3>> occupied;
    for (;; total = this->choose(options, together *= 2))
    {
      if (total <= MostCells)
      {
        occupied = this->cellsOf(data, total);
        if (static_cast<double>(occupied.size()) <= enough || total == 1)
        {
          break;
        }
      }
    }
    this->Near.assign(static_cast<std::size_t>(total), false);
    for (const std::array<std::int64_t, 3>& cell : occupied)
    {
      const auto first = [&](std::size_t a) { return std::max<std::int64_t>(cell[a] - 1, 0); };
      const auto last = [&](std::size_t a) { return std::min(cell[a] + 1, this->Count[a] - 1); };
      for (std::int64_t k = first(2); k <= last(2); ++k)
      {
        for (std::int64_t j = first(1); j <= last(1); ++j)
        {
          for (std::int64_t i = first(0); i <= last(0); ++i)
          {
            this->Near[this->flat(i, j, k)] = true;
          }
        }
      }
    }
  }

  /// The flat index of the cell of a position.
  std::size_t indexOf(const Position& x) const
  {
    const std::array<std::int64_t, 3> cell = this->cellOf(x);
    return this->flat(cell[0], cell[1], cell[2]);
  }

  bool isNear(std::size_t index) const { return this->Near[index]; }

  /// How many of the given cells, which may be repeated, touch each other at most.
  double largestCluster(std::vector<std::size_t> cells) const
  {
    std::sort(cells.begin(), cells.end());
    std::vector<std::size_t> distinct;
    std::vector<double> times;
    for (const std::size_t cell : cells)
    {
      if (distinct.empty() || distinct.back() != cell)
      {
        distinct.push_back(cell);
        times.push_back(0);
      }
      ++times.back();
    }
    // Rows of cells, and what is beside them; a cell at the end of a row may be joined with one at
    // the beginning of the next, which makes clusters no smaller than they are.
    DisjointSets sets(static_cast<vtkIdType>(distinct.size()));
    const auto row = static_cast<std::size_t>(this->Count[0]);
    const std::size_t slice = row * static_cast<std::size_t>(this->Count[1]);
    for (const std::size_t step : { std::size_t{ 0 }, row, slice - row, slice, slice + row })
    {
      // Both move upwards together.
      std::size_t other = 0;
      for (std::size_t k = 0; k < distinct.size(); ++k)
      {
        const std::size_t middle = distinct[k] + step;
        while (other < distinct.size() && distinct[other] + 1 < middle)
        {
          ++other;
        }
        for (std::size_t i = other; i < distinct.size() && distinct[i] <= middle + 1; ++i)
        {
          sets.unite(static_cast<vtkIdType>(k), static_cast<vtkIdType>(i));
        }
      }
    }
    const std::vector<vtkIdType> label = sets.labels();
    std::vector<double> size(distinct.size(), 0);
    for (std::size_t k = 0; k < label.size(); ++k)
    {
      size[static_cast<std::size_t>(label[k])] += times[k];
    }
    return size.empty() ? 0 : *std::max_element(size.begin(), size.end());
  }

private:
  /// Sets cells of so many knot cells per axis. Returns their number.
  std::int64_t choose(const TrimOptions& options, std::int64_t together)
  {
    std::int64_t total = 1;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const std::int64_t cells = options.Cells[a];
      this->Count[a] = std::max<std::int64_t>(1, (cells + together - 1) / together);
      this->Lower[a] = options.Domain[2 * a];
      this->PerLength[a] = cells > 0 ? static_cast<double>(cells) /
          (options.Domain[2 * a + 1] - options.Domain[2 * a]) / static_cast<double>(together)
                                     : 0;
      total *= this->Count[a];
    }
    return total;
  }

  /// Those that hold data, each once.
  std::vector<std::array<std::int64_t, 3>> cellsOf(
    const SpacePoints& data, std::int64_t total) const
  {
    std::vector<bool> seen(static_cast<std::size_t>(total));
    std::vector<std::array<std::int64_t, 3>> cells;
    for (const Position& x : data)
    {
      const std::array<std::int64_t, 3> cell = this->cellOf(x);
      const std::size_t index = this->flat(cell[0], cell[1], cell[2]);
      if (!seen[index])
      {
        seen[index] = true;
        cells.push_back(cell);
      }
    }
    return cells;
  }

  std::array<std::int64_t, 3> cellOf(const Position& x) const
  {
    std::array<std::int64_t, 3> cell;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double at = std::floor((x[a] - this->Lower[a]) * this->PerLength[a]);
      cell[a] = static_cast<std::int64_t>(
        std::min(std::max(at, 0.0), static_cast<double>(this->Count[a] - 1)));
    }
    return cell;
  }

  std::size_t flat(std::int64_t i, std::int64_t j, std::int64_t k) const
  {
    return static_cast<std::size_t>((k * this->Count[1] + j) * this->Count[0] + i);
  }

  std::array<std::int64_t, 3> Count{};
  Position Lower{}, PerLength{};
  std::vector<bool> Near;
};

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

/// The points that cells join each point with; the same one may be listed twice.
class Neighbours
{
public:
  explicit Neighbours(vtkPolyData* surface)
    : Begin(static_cast<std::size_t>(surface->GetNumberOfPoints()) + 1, 0)
  {
    const auto forEnds = [surface](const auto& action)
    {
      forSimplices(surface,
        [&](vtkIdType n, const vtkIdType* ids)
        {
          for (vtkIdType i = 0; i < n; ++i)
          {
            for (vtkIdType j = 0; j < n; ++j)
            {
              if (i != j)
              {
                action(static_cast<std::size_t>(ids[i]), static_cast<std::size_t>(ids[j]));
              }
            }
          }
        });
    };
    forEnds([this](std::size_t from, std::size_t) { ++this->Begin[from + 1]; });
    for (std::size_t k = 1; k < this->Begin.size(); ++k)
    {
      this->Begin[k] += this->Begin[k - 1];
    }
    this->Ids.resize(this->Begin.back());
    std::vector<std::size_t> next(this->Begin.begin(), this->Begin.end() - 1);
    forEnds([&](std::size_t from, std::size_t to)
      { this->Ids[next[from]++] = static_cast<std::uint32_t>(to); });
  }

  template <typename Action>
  void forAll(std::size_t point, const Action& action) const
  {
    for (std::size_t k = this->Begin[point]; k < this->Begin[point + 1]; ++k)
    {
      action(std::size_t{ this->Ids[k] });
    }
  }

private:
  std::vector<std::size_t> Begin;
  std::vector<std::uint32_t> Ids;
};

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
    const OccupiedCells occupied(this->Options, data.Positions);
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
  int choose()
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
    this->Cut.assign(this->Distance.size(), 0);
    for (std::size_t i = 0; i < this->Distance.size(); ++i)
    {
      if (this->isUnsupported(i) && isOnSide(this->at(i), this->Options))
      {
        cut[part[i]] = true;
      }
    }
    for (std::size_t i = 0; i < this->Distance.size(); ++i)
    {
      this->Cut[i] = this->isUnsupported(i) && cut[part[i]];
    }
    return static_cast<int>(
      std::count_if(cut.begin(), cut.end(), [](const auto& entry) { return entry.second; }));
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

/// Keeps what is not below 0 of a function on the vertices.
class Clip
{
public:
  Clip(vtkPolyData* surface, std::vector<double> level)
    : Surface(surface)
    , Level(std::move(level))
    , NewId(this->Level.size(), -1)
  {
    this->Points->SetDataType(surface->GetPoints()->GetDataType());
    this->Attributes->InterpolateAllocate(surface->GetPointData(), surface->GetNumberOfPoints());
    this->snap();
  }

  std::vector<vtkIdType> apply()
  {
    vtkNew<vtkCellArray> polys, lines;
    forCells(this->Surface->GetPolys(),
      [&](vtkIdType, const vtkIdType* ids) { this->clipTriangle(ids, polys); });
    forCells(this->Surface->GetLines(),
      [&](vtkIdType n, const vtkIdType* ids) { this->clipPolyline(n, ids, lines); });
    this->Surface->SetPoints(this->Points);
    this->Surface->SetPolys(polys);
    this->Surface->SetLines(lines);
    this->Surface->GetPointData()->ShallowCopy(this->Attributes);
    return std::move(this->NewPoints);
  }

private:
  double level(vtkIdType id) const { return this->Level[static_cast<std::size_t>(id)]; }

  /// Lets the cut pass through vertices that it almost passes through, so that no sliver is left.
  void snap()
  {
    std::vector<vtkIdType> ends;
    forSimplices(this->Surface,
      [&](vtkIdType n, const vtkIdType* ids)
      {
        for (vtkIdType i = 0; i < n; ++i)
        {
          for (vtkIdType j = 0; j < n; ++j)
          {
            const double above = this->level(ids[i]), below = this->level(ids[j]);
            if (above > 0 && below < 0)
            {
              const double t = above / (above - below);
              if (t < Snap || t > 1 - Snap)
              {
                ends.push_back(t < Snap ? ids[i] : ids[j]);
              }
            }
          }
        }
      });
    for (const vtkIdType id : ends)
    {
      this->Level[static_cast<std::size_t>(id)] = 0;
    }
  }

  vtkIdType keep(vtkIdType id)
  {
    vtkIdType& kept = this->NewId[static_cast<std::size_t>(id)];
    if (kept < 0)
    {
      kept = this->Points->InsertNextPoint(this->Surface->GetPoint(id));
      this->Attributes->CopyData(this->Surface->GetPointData(), id, kept);
    }
    return kept;
  }

  /// The point of the cut on an edge, one for all of its cells.
  vtkIdType cut(vtkIdType a, vtkIdType b)
  {
    if (b < a)
    {
      std::swap(a, b);
    }
    const std::int64_t edge = a * this->Surface->GetNumberOfPoints() + b;
    const auto [entry, isNew] = this->OnEdge.emplace(edge, this->Points->GetNumberOfPoints());
    if (isNew)
    {
      const double t = this->level(a) / (this->level(a) - this->level(b));
      this->Points->InsertNextPoint(
        between(positionOf(this->Surface, a), positionOf(this->Surface, b), t).data());
      this->Attributes->InterpolateEdge(this->Surface->GetPointData(), entry->second, a, b, t);
      this->NewPoints.push_back(entry->second);
    }
    return entry->second;
  }

  void clipTriangle(const vtkIdType* ids, vtkCellArray* to)
  {
    const double levels[3] = { this->level(ids[0]), this->level(ids[1]), this->level(ids[2]) };
    if (std::none_of(levels, levels + 3, [](double v) { return v > 0; }))
    {
      return;
    }
    vtkIdType corners[4];
    vtkIdType n = 0;
    for (int k = 0; k < 3; ++k)
    {
      const int next = (k + 1) % 3;
      if (levels[k] >= 0)
      {
        corners[n++] = this->keep(ids[k]);
      }
      if (levels[k] * levels[next] < 0)
      {
        corners[n++] = this->cut(ids[k], ids[next]);
      }
    }
    if (n == 4 && this->length(corners[1], corners[3]) < this->length(corners[0], corners[2]))
    {
      std::rotate(corners, corners + 1, corners + 4);
    }
    for (vtkIdType k = 2; k < n; ++k)
    {
      const vtkIdType triangle[3] = { corners[0], corners[k - 1], corners[k] };
      to->InsertNextCell(3, triangle);
    }
  }

  double length(vtkIdType a, vtkIdType b) const
  {
    double x[3], y[3];
    this->Points->GetPoint(a, x);
    this->Points->GetPoint(b, y);
    return vtkMath::Distance2BetweenPoints(x, y);
  }

  void clipPolyline(vtkIdType n, const vtkIdType* ids, vtkCellArray* to)
  {
    std::vector<vtkIdType> way(ids, ids + n);
    const auto isBelow = [this](vtkIdType id) { return this->level(id) < 0; };
    const auto first = std::find_if(way.begin(), way.end(), isBelow);
    if (n > 1 && way.front() == way.back() && first != way.end())
    {
      // A loop begins and ends where it is cut off.
      way.pop_back();
      std::rotate(way.begin(), first, way.end());
      way.push_back(way.front());
    }
    std::vector<vtkIdType> piece;
    const auto finish = [&]
    {
      if (piece.size() > 1)
      {
        to->InsertNextCell(static_cast<vtkIdType>(piece.size()), piece.data());
      }
      piece.clear();
    };
    for (std::size_t k = 0; k < way.size(); ++k)
    {
      if (k > 0 && this->level(way[k - 1]) * this->level(way[k]) < 0)
      {
        piece.push_back(this->cut(way[k - 1], way[k]));
      }
      if (isBelow(way[k]))
      {
        finish();
      }
      else
      {
        piece.push_back(this->keep(way[k]));
      }
    }
    finish();
  }

  vtkPolyData* Surface;
  std::vector<double> Level;
  std::vector<vtkIdType> NewId;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkPointData> Attributes;
  std::unordered_map<std::int64_t, vtkIdType> OnEdge;
  std::vector<vtkIdType> NewPoints;
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
    result.Parts = trim.choose();
    if (result.Parts == 0)
    {
      return result;
    }
    level = trim.levels(support, neighbours);
  }
  result.NewPoints = Clip(surface, std::move(level)).apply();
  return result;
}
}
