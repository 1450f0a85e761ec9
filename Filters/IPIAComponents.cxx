// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAComponents.h"

#include "IPIACells.h"

#include "vtkBoundingBox.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStaticPointLocator.h"

#include <algorithm>

namespace ipia
{
namespace
{
/// A component stays if it has this share of the data points that its size makes one expect.
constexpr double LeastShareOfData = 0.02;
/// And at least so many, of a hundred times as many in all: what a blob of the size of one basis
/// function's slope, two and a half knot spacings, carries.
constexpr double LeastData = 24;

/// How many data points are nearer to the component than to any other.
double dataOf(vtkPolyData* surface, const std::vector<vtkIdType>& component, vtkIdType label,
  const vtkBoundingBox& extent, const SpacePoints& data, double reach)
{
  vtkBoundingBox near(extent), around(extent);
  near.Inflate(reach);
  around.Inflate(2 * reach);
  // What lies farther away than a component can not be nearest to data this near to it.
  vtkNew<vtkPoints> candidates;
  std::vector<vtkIdType> labels;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double x[3];
    surface->GetPoint(i, x);
    if (around.ContainsPoint(x))
    {
      candidates->InsertNextPoint(x);
      labels.push_back(component[static_cast<std::size_t>(i)]);
    }
  }
  vtkNew<vtkPolyData> points;
  points->SetPoints(candidates);
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(points);
  locator->BuildLocator();
  double count = 0;
  for (const auto& x : data)
  {
    if (near.ContainsPoint(x.data()))
    {
      const vtkIdType nearest = locator->FindClosestPoint(x.data());
      count += labels[static_cast<std::size_t>(nearest)] == label;
    }
  }
  return count;
}

/// Keeps the cells whose component stays, and their points.
void keep(
  vtkPolyData* surface, const std::vector<vtkIdType>& component, const std::vector<char>& stays)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(surface->GetPoints()->GetDataType());
  vtkNew<vtkPointData> attributes;
  attributes->CopyAllocate(surface->GetPointData(), surface->GetNumberOfPoints());
  std::vector<vtkIdType> newId(component.size(), -1);
  const auto copyCells = [&](vtkCellArray* from)
  {
    auto to = vtkSmartPointer<vtkCellArray>::New();
    std::vector<vtkIdType> cell;
    forCells(from,
      [&](vtkIdType n, const vtkIdType* ids)
      {
        if (!stays[static_cast<std::size_t>(component[static_cast<std::size_t>(ids[0])])])
        {
          return;
        }
        cell.clear();
        for (vtkIdType k = 0; k < n; ++k)
        {
          vtkIdType& id = newId[static_cast<std::size_t>(ids[k])];
          if (id < 0)
          {
            id = points->InsertNextPoint(surface->GetPoint(ids[k]));
            attributes->CopyData(surface->GetPointData(), ids[k], id);
          }
          cell.push_back(id);
        }
        to->InsertNextCell(n, cell.data());
      });
    return to;
  };
  auto polys = copyCells(surface->GetPolys()), lines = copyCells(surface->GetLines());
  surface->SetPoints(points);
  surface->SetPolys(polys);
  surface->SetLines(lines);
  surface->GetPointData()->ShallowCopy(attributes);
}
}

DisjointSets::DisjointSets(vtkIdType size)
{
  for (vtkIdType i = 0; i < size; ++i)
  {
    this->add();
  }
}

vtkIdType DisjointSets::root(vtkIdType a)
{
  while (this->Parent[static_cast<std::size_t>(a)] != a)
  {
    vtkIdType& parent = this->Parent[static_cast<std::size_t>(a)];
    parent = this->Parent[static_cast<std::size_t>(parent)];
    a = parent;
  }
  return a;
}

void DisjointSets::unite(vtkIdType a, vtkIdType b)
{
  a = this->root(a);
  b = this->root(b);
  this->Parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

std::vector<vtkIdType> DisjointSets::labels()
{
  std::vector<vtkIdType> label(this->Parent.size());
  vtkIdType next = 0;
  for (std::size_t k = 0; k < label.size(); ++k)
  {
    // The root of a set is its first point.
    const vtkIdType r = this->root(static_cast<vtkIdType>(k));
    label[k] = r == static_cast<vtkIdType>(k) ? next++ : label[static_cast<std::size_t>(r)];
  }
  return label;
}

std::vector<vtkIdType> componentsOf(vtkPolyData* surface)
{
  DisjointSets sets(surface->GetNumberOfPoints());
  for (vtkCellArray* cells : { surface->GetPolys(), surface->GetLines() })
  {
    forCells(cells,
      [&](vtkIdType n, const vtkIdType* ids)
      {
        for (vtkIdType k = 1; k < n; ++k)
        {
          sets.unite(ids[0], ids[k]);
        }
      });
  }
  return sets.labels();
}

int leaveOutComponents(vtkPolyData* surface, const std::vector<vtkIdType>& component,
  const SpacePoints& data, double reach)
{
  const vtkIdType n =
    component.empty() ? 0 : 1 + *std::max_element(component.begin(), component.end());
  if (n < 2)
  {
    return 0;
  }
  std::vector<vtkIdType> vertices(static_cast<std::size_t>(n), 0);
  std::vector<vtkBoundingBox> extents(vertices.size());
  for (std::size_t i = 0; i < component.size(); ++i)
  {
    const auto k = static_cast<std::size_t>(component[i]);
    ++vertices[k];
    double x[3];
    surface->GetPoint(static_cast<vtkIdType>(i), x);
    extents[k].AddPoint(x);
  }
  const auto largest = std::max_element(vertices.begin(), vertices.end()) - vertices.begin();
  const double perVertex = static_cast<double>(data.size()) / static_cast<double>(component.size());
  const double least = std::min(LeastData, static_cast<double>(data.size()) / 100);
  std::vector<char> stays(vertices.size(), 1);
  for (std::size_t k = 0; k < stays.size(); ++k)
  {
    const double expected = perVertex * static_cast<double>(vertices[k]);
    stays[k] = static_cast<std::ptrdiff_t>(k) == largest ||
      dataOf(surface, component, static_cast<vtkIdType>(k), extents[k], data, reach) >=
        std::max(LeastShareOfData * expected, least);
  }
  const auto leftOut = static_cast<int>(std::count(stays.begin(), stays.end(), 0));
  if (leftOut > 0)
  {
    keep(surface, component, stays);
  }
  return leftOut;
}
}
