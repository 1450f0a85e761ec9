// SPDX-License-Identifier: BSD-3-Clause
#include "IPIABrickContour.h"

#include "Core/Parallel.h"
#include "IPIAComponents.h"

#include "vtkCellArray.h"
#include "vtkFloatArray.h"
#include "vtkFlyingEdges3D.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
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
  std::vector<std::array<float, 3>> Normals;
  std::vector<std::int64_t> Edges; ///< per point: its edge if it is on the border of a block, or -1
  std::vector<std::array<std::int32_t, 3>> Triangles;

  // For the surface of all parts.
  std::vector<vtkIdType> Components; ///< per point, of this part alone
  std::vector<vtkIdType> Ids;        ///< per point, in the whole
  vtkIdType FirstId = 0;             ///< of the points that no part before this has
  vtkIdType FirstTriangle = 0, FirstComponent = 0;

  void findComponents()
  {
    DisjointSets sets(static_cast<vtkIdType>(this->Points.size()));
    for (const auto& corners : this->Triangles)
    {
      sets.unite(corners[0], corners[1]);
      sets.unite(corners[0], corners[2]);
    }
    this->Components = sets.labels();
  }
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
    const auto first = static_cast<std::int32_t>(surface.Points.size());
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
      const Point<3> normal = this->Gradients.col(i).cwiseQuotient(spacing).normalized();
      surface.Normals.push_back({ static_cast<float>(normal[0]), static_cast<float>(normal[1]),
        static_cast<float>(normal[2]) });
    }
    vtkCellArray* triangles = found->GetPolys();
    vtkIdType corners = 0;
    const vtkIdType* ids = nullptr;
    for (triangles->InitTraversal(); triangles->GetNextCell(corners, ids);)
    {
      // Flying edges' triangles face towards smaller values.
      surface.Triangles.push_back({ first + static_cast<std::int32_t>(ids[0]),
        first + static_cast<std::int32_t>(ids[2]), first + static_cast<std::int32_t>(ids[1]) });
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

/// Numbers the points and components of all parts: vertices on the same edge become one. Returns
/// the number of points, and the component in the whole of each component of a part.
std::pair<vtkIdType, std::vector<vtkIdType>> number(std::vector<PartSurface>& parts)
{
  struct Vertex
  {
    vtkIdType Id, Component;
  };
  std::unordered_map<std::int64_t, Vertex> onBorder;
  DisjointSets components;
  vtkIdType points = 0, triangles = 0, numberOfComponents = 0;
  for (PartSurface& part : parts)
  {
    part.FirstId = points;
    part.FirstTriangle = triangles;
    part.FirstComponent = numberOfComponents;
    triangles += static_cast<vtkIdType>(part.Triangles.size());
    part.Ids.resize(part.Points.size());
    for (std::size_t k = 0; k < part.Ids.size(); ++k)
    {
      Vertex vertex{ points, part.FirstComponent + part.Components[k] };
      for (; numberOfComponents <= vertex.Component; ++numberOfComponents)
      {
        components.add();
      }
      if (part.Edges[k] >= 0)
      {
        const Vertex& first = onBorder.emplace(part.Edges[k], vertex).first->second;
        components.unite(first.Component, vertex.Component);
        vertex = first;
      }
      part.Ids[k] = vertex.Id;
      points += vertex.Id == points;
    }
  }
  return { points, components.labels() };
}

/// Joins the parts. Returns the component of each vertex.
std::vector<vtkIdType> join(std::vector<PartSurface>& parts, const Placement<3>& place,
  int pointType, int threads, vtkPolyData* surface)
{
  const auto count = static_cast<std::int64_t>(parts.size());
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::int64_t p = 0; p < count; ++p)
  {
    parts[static_cast<std::size_t>(p)].findComponents();
  }
  const auto [numberOfPoints, componentOf] = number(parts);
  const vtkIdType numberOfTriangles = parts.empty()
    ? 0
    : parts.back().FirstTriangle + static_cast<vtkIdType>(parts.back().Triangles.size());

  vtkNew<vtkPoints> points;
  points->SetDataType(pointType);
  points->SetNumberOfPoints(numberOfPoints);
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(numberOfPoints);
  vtkNew<vtkIdTypeArray> offsets, corners;
  offsets->SetNumberOfValues(numberOfTriangles + 1);
  corners->SetNumberOfValues(3 * numberOfTriangles);
  offsets->SetValue(numberOfTriangles, 3 * numberOfTriangles);
  std::vector<vtkIdType> component(static_cast<std::size_t>(numberOfPoints));
  const std::vector<vtkIdType>& labels = componentOf;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::int64_t p = 0; p < count; ++p)
  {
    const PartSurface& part = parts[static_cast<std::size_t>(p)];
    vtkIdType next = part.FirstId;
    for (std::size_t k = 0; k < part.Ids.size(); ++k)
    {
      // The others are those of an earlier point.
      if (part.Ids[k] == next)
      {
        double x[3];
        vtkMath::Add(place.Origin.data(), part.Points[k].data(), x);
        points->SetPoint(next, x);
        normals->SetTypedTuple(next, part.Normals[k].data());
        component[static_cast<std::size_t>(next)] =
          labels[static_cast<std::size_t>(part.FirstComponent + part.Components[k])];
        ++next;
      }
    }
    vtkIdType triangle = part.FirstTriangle;
    for (const auto& local : part.Triangles)
    {
      offsets->SetValue(triangle, 3 * triangle);
      for (int k = 0; k < 3; ++k)
      {
        corners->SetValue(
          3 * triangle + k, part.Ids[static_cast<std::size_t>(local[static_cast<std::size_t>(k)])]);
      }
      ++triangle;
    }
  }
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(offsets, corners);
  surface->SetPoints(points);
  surface->SetPolys(triangles);
  surface->GetPointData()->SetNormals(normals);
  return component;
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
  component = join(surfaces, place, pointType, threads, surface);
  return true;
}
}
