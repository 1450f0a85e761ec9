// SPDX-License-Identifier: BSD-3-Clause
#include "IPIABrickContour.h"

#include "Core/Parallel.h"
#include "IPIAComponents.h"

#include "vtkCellArray.h"
#include "vtkFloatArray.h"
#include "vtkFlyingEdges3D.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <atomic>
#include <cmath>
#include <unordered_map>

namespace ipia
{
namespace
{
constexpr double LongestNewtonStep = 1. / 3;
constexpr double LeastSlope = 0.1;
/// Samples are kept this far from 0, in knot spacings, so that no vertex falls onto a sample and
/// each belongs to one edge of the grid.
constexpr double LeastSample = 1e-5;

using Block = BrickSpline<3>::Block;

/// The surface in the blocks of one part.
struct PartSurface
{
  std::vector<Point<3>> Points; ///< relative to the corner of the domain
  std::vector<Point<3>> Normals;
  std::vector<std::int64_t> Edges; ///< per point: its edge if it is on the border of a block, or -1
  std::vector<vtkIdType> Triangles;
};

/// Samples and contours one block after the other.
class BlockContour
{
public:
  BlockContour(const BrickSpline<3>& function)
    : Function(function)
    , Samples(samplesPerAxis(function.lattice()))
    , Newton(halfSpacing(function.lattice()).data())
  {
    this->Contour->SetInputData(this->Image);
    this->Contour->SetValue(0, 0);
    this->Contour->ComputeNormalsOff();
    this->Contour->ComputeScalarsOff();
    this->Image->GetPointData()->SetScalars(this->Values);
  }

  void append(const Block& block, PartSurface& surface)
  {
    const BrickSpline<3>::BlockFunction f = this->Function.blockFunction(block);
    AxisPositions<3> positions;
    std::array<int, 3> dimensions;
    std::int64_t size = 1;
    for (std::size_t a = 0; a < 3; ++a)
    {
      for (std::int64_t k = 2 * f.Begin[a]; k <= 2 * f.End[a]; ++k)
      {
        positions[a].push_back(0.5 * static_cast<double>(k));
      }
      dimensions[a] = static_cast<int>(positions[a].size());
      size *= dimensions[a];
    }
    this->Image->SetDimensions(dimensions.data());
    this->Values->SetNumberOfValues(size);
    float* values = this->Values->GetPointer(0);
    f.Spline.sample(positions, values, 1);
    const auto least = static_cast<float>(LeastSample * this->Function.lattice().Spacing.mean());
    bool negative = false, other = false;
    for (std::int64_t k = 0; k < size; ++k)
    {
      values[k] = values[k] < 0 ? std::min(values[k], -least) : std::max(values[k], least);
      negative = negative || values[k] < 0;
      other = other || !(values[k] < 0);
    }
    if (!(negative && other))
    {
      return;
    }
    this->Values->Modified();
    this->Image->Modified();
    this->Contour->Update();
    this->appendVertices(block, f, surface);
  }

private:
  static Index<3> samplesPerAxis(const Lattice<3>& lattice)
  {
    Index<3> n;
    for (int a = 0; a < 3; ++a)
    {
      n[static_cast<std::size_t>(a)] = 2 * lattice.cells(a) + 1;
    }
    return n;
  }

  static Point<3> halfSpacing(const Lattice<3>& lattice) { return 0.5 * lattice.Spacing; }

  void appendVertices(
    const Block& block, const BrickSpline<3>::BlockFunction& f, PartSurface& surface)
  {
    const Point<3>& spacing = this->Function.lattice().Spacing;
    vtkPolyData* found = this->Contour->GetOutput();
    vtkPoints* points = found->GetPoints();
    const auto first = static_cast<vtkIdType>(surface.Points.size());
    Point<3> corner, begin; // in cells
    for (int a = 0; a < 3; ++a)
    {
      corner[a] = static_cast<double>(f.Corner[static_cast<std::size_t>(a)]);
      begin[a] = static_cast<double>(f.Begin[static_cast<std::size_t>(a)]);
    }
    const vtkIdType n = points->GetNumberOfPoints();
    this->Positions.resize(3, n);
    for (vtkIdType i = 0; i < n; ++i)
    {
      Point<3> u; // in samples of the block
      points->GetPoint(i, u.data());
      surface.Edges.push_back(this->edgeOf(block, u));
      this->Positions.col(i) = begin + 0.5 * u;
    }
    f.Spline.valuesAndGradients(this->Positions, this->F, this->Gradients);
    for (vtkIdType i = 0; i < n; ++i)
    {
      const Point<3> g = this->Gradients.col(i).cwiseQuotient(spacing);
      const double slope = g.norm();
      const double step = this->Newton.along(this->F[i], slope);
      if (step != 0)
      {
        this->Positions.col(i) += (step / slope * g).cwiseQuotient(spacing);
      }
    }
    f.Spline.valuesAndGradients(this->Positions, this->F, this->Gradients);
    for (vtkIdType i = 0; i < n; ++i)
    {
      surface.Points.push_back((corner + this->Positions.col(i)).cwiseProduct(spacing));
      surface.Normals.push_back(this->Gradients.col(i).cwiseQuotient(spacing).normalized());
    }
    vtkCellArray* triangles = found->GetPolys();
    vtkIdType corners = 0;
    const vtkIdType* ids = nullptr;
    for (triangles->InitTraversal(); triangles->GetNextCell(corners, ids);)
    {
      // Flying edges' triangles face towards smaller values.
      surface.Triangles.push_back(first + ids[0]);
      surface.Triangles.push_back(first + ids[2]);
      surface.Triangles.push_back(first + ids[1]);
    }
  }

  /// Identifies the edge of the whole grid that a vertex on the border of a block lies on.
  std::int64_t edgeOf(const Block& block, const Point<3>& u) const
  {
    bool border = false;
    std::int64_t axis = 0, index = 0;
    for (int a = 2; a >= 0; --a)
    {
      const auto i = static_cast<std::size_t>(a);
      const double below = std::floor(u[a]);
      if (below != u[a])
      {
        axis = a;
      }
      else
      {
        // At its upper end a block may be cut off by the domain, where nothing is to be joined.
        border = border || below == 0 || below == 2. * BrickSpline<3>::BlockCells;
      }
      index = index * this->Samples[i] + 2 * block.Cell[i] + static_cast<std::int64_t>(below);
    }
    return border ? 3 * index + axis : -1;
  }

  const BrickSpline<3>& Function;
  Index<3> Samples;
  NewtonStep Newton;
  vtkNew<vtkImageData> Image;
  vtkNew<vtkFloatArray> Values;
  vtkNew<vtkFlyingEdges3D> Contour;
  // Of the vertices of one block, in cells of its spline.
  ipia::Points<3> Positions, Gradients;
  Vector F;
};

/// Joins the parts: vertices on the same edge become one. Returns the component of each vertex.
std::vector<vtkIdType> join(const std::vector<PartSurface>& parts, const Placement<3>& place,
  int pointType, vtkPolyData* surface)
{
  DisjointSets components;
  vtkNew<vtkPoints> points;
  points->SetDataType(pointType);
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  vtkNew<vtkCellArray> triangles;
  vtkIdType most = 0, count = 0;
  for (const PartSurface& part : parts)
  {
    most += static_cast<vtkIdType>(part.Points.size());
    count += static_cast<vtkIdType>(part.Triangles.size() / 3);
  }
  points->Allocate(most);
  normals->Allocate(3 * most);
  triangles->AllocateExact(count, 3 * count);
  std::unordered_map<std::int64_t, vtkIdType> onBorder;
  std::vector<vtkIdType> ids;
  for (const PartSurface& part : parts)
  {
    ids.clear();
    for (std::size_t k = 0; k < part.Points.size(); ++k)
    {
      vtkIdType id = points->GetNumberOfPoints();
      if (part.Edges[k] >= 0)
      {
        id = onBorder.emplace(part.Edges[k], id).first->second;
      }
      ids.push_back(id);
      if (id == points->GetNumberOfPoints())
      {
        const Point<3>& x = part.Points[k];
        points->InsertNextPoint(
          place.Origin[0] + x[0], place.Origin[1] + x[1], place.Origin[2] + x[2]);
        normals->InsertNextTuple(part.Normals[k].data());
        components.add();
      }
    }
    for (std::size_t t = 0; t < part.Triangles.size(); t += 3)
    {
      const vtkIdType corners[3] = { ids[static_cast<std::size_t>(part.Triangles[t])],
        ids[static_cast<std::size_t>(part.Triangles[t + 1])],
        ids[static_cast<std::size_t>(part.Triangles[t + 2])] };
      triangles->InsertNextCell(3, corners);
      components.unite(corners[0], corners[1]);
      components.unite(corners[0], corners[2]);
    }
  }
  surface->SetPoints(points);
  surface->SetPolys(triangles);
  surface->GetPointData()->SetNormals(normals);
  return components.labels();
}
}

NewtonStep::NewtonStep(const double sampleSpacing[3])
  : Longest(LongestNewtonStep * std::min({ sampleSpacing[0], sampleSpacing[1], sampleSpacing[2] }))
{
}

double NewtonStep::along(double f, double slope) const
{
  return slope > LeastSlope ? std::min(std::max(-f / slope, -this->Longest), this->Longest) : 0.0;
}

bool contourBricks(const BrickSpline<3>& function, const Placement<3>& place, int pointType,
  const ProgressCallback& progress, vtkPolyData* surface, std::vector<vtkIdType>& component)
{
  component.clear();
  surface->Initialize();
  const int threads = resolveThreads(0);
  const std::vector<Block> parts = function.zeroSetParts();
  std::vector<PartSurface> surfaces(parts.size());
  // Filters are made by one thread and used by one each.
  std::vector<std::unique_ptr<BlockContour>> contours;
  for (int t = 0; t < threads; ++t)
  {
    contours.push_back(std::make_unique<BlockContour>(function));
  }
  const auto count = static_cast<std::int64_t>(parts.size());
  std::atomic<std::int64_t> done{ 0 };
  std::atomic<bool> aborted{ false };
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::int64_t k = 0; k < count; ++k)
  {
    if (aborted)
    {
      continue;
    }
    const int thread = omp_get_thread_num();
    function.forZeroSetBlocks(parts[static_cast<std::size_t>(k)],
      [&](const Block& block)
      {
        contours[static_cast<std::size_t>(thread)]->append(
          block, surfaces[static_cast<std::size_t>(k)]);
      });
    const std::int64_t finished = ++done;
    if (thread == 0 && progress &&
      !progress(static_cast<double>(finished) / static_cast<double>(count)))
    {
      aborted = true;
    }
  }
  if (aborted)
  {
    return false;
  }
  component = join(surfaces, place, pointType, surface);
  return true;
}
}
