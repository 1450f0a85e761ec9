// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Going through the cells of a surface or curve.
 */
#ifndef IPIACells_h
#define IPIACells_h

#include "vtkCellArray.h"
#include "vtkPolyData.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ipia
{
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

inline std::array<double, 3> positionOf(vtkPolyData* surface, vtkIdType id)
{
  std::array<double, 3> x;
  surface->GetPoint(id, x.data());
  return x;
}

/// The position at t from a (0) to b (1).
inline std::array<double, 3> between(
  const std::array<double, 3>& a, const std::array<double, 3>& b, double t)
{
  return { a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2]) };
}

/// The points that cells join each point with; the same one may be listed twice. Of fewer
/// than 2^32 points.
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

}

#endif
