// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAClip.h"

#include "IPIACells.h"

#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"

#include <algorithm>
#include <unordered_map>

namespace ipia
{
namespace
{
/// A cut that would pass an edge's end by less than this share of the edge goes through the end.
constexpr double Snap = 0.1;

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

std::vector<vtkIdType> clipBelowZero(vtkPolyData* surface, std::vector<double> level)
{
  return Clip(surface, std::move(level)).apply();
}
}
