// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a surface or curve is made of: pieces, handles, borders.
 */
#ifndef IPIATestTopology_h
#define IPIATestTopology_h

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkConnectivityFilter.h"
#include "vtkFeatureEdges.h"
#include "vtkFlyingEdges3D.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <ostream>
#include <vector>

namespace ipiatest
{
/// Of a triangulated surface. Genus (the handles of all components) holds for manifolds.
struct Topology
{
  int Components;
  int Genus;
  vtkIdType BoundaryEdges;
  vtkIdType NonManifoldEdges;

  bool operator==(const Topology& other) const
  {
    return this->Components == other.Components && this->Genus == other.Genus &&
      this->BoundaryEdges == other.BoundaryEdges &&
      this->NonManifoldEdges == other.NonManifoldEdges;
  }
};

inline std::ostream& operator<<(std::ostream& os, const Topology& t)
{
  return os << t.Components << " component(s), genus " << t.Genus << ", " << t.BoundaryEdges
            << " boundary and " << t.NonManifoldEdges << " non-manifold edge(s)";
}

inline int CountComponents(vtkPolyData* data)
{
  vtkNew<vtkConnectivityFilter> components;
  components->SetInputData(data);
  components->SetExtractionModeToAllRegions();
  components->Update();
  return components->GetNumberOfExtractedRegions();
}

/// The edges of one triangle alone, or those of more than two.
inline vtkSmartPointer<vtkPolyData> Edges(vtkPolyData* surface, bool boundary)
{
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(surface);
  edges->FeatureEdgesOff();
  edges->ManifoldEdgesOff();
  edges->SetBoundaryEdges(boundary);
  edges->SetNonManifoldEdges(!boundary);
  edges->Update();
  return edges->GetOutput();
}

inline vtkIdType CountEdges(vtkPolyData* surface, bool boundary)
{
  return Edges(surface, boundary)->GetNumberOfCells();
}

inline Topology TopologyOf(vtkPolyData* surface)
{
  const int components = CountComponents(surface);
  const auto boundary = Edges(surface, true);
  const vtkIdType loops = boundary->GetNumberOfCells() > 0 ? CountComponents(boundary) : 0;
  const vtkIdType faces = surface->GetNumberOfPolys();
  // Every triangle has three edges, of which those inside belong to two.
  const vtkIdType edges = (3 * faces + boundary->GetNumberOfCells()) / 2;
  const vtkIdType euler = surface->GetNumberOfPoints() - edges + faces;
  return { components, static_cast<int>(components - (euler + loops) / 2),
    boundary->GetNumberOfCells(), CountEdges(surface, false) };
}

/// The zero surface of the function in port 0 of an algorithm, which is brought up to date.
inline vtkSmartPointer<vtkPolyData> ZeroSurface(vtkAlgorithm* function)
{
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputConnection(function->GetOutputPort());
  contour->SetValue(0, 0.0);
  contour->ComputeNormalsOff();
  contour->Update();
  return contour->GetOutput();
}

/// True if every point of the lines is the end of exactly two segments.
inline bool IsClosedCurve(vtkPolyData* lines)
{
  std::vector<int> ends(static_cast<std::size_t>(lines->GetNumberOfPoints()), 0);
  vtkCellArray* cells = lines->GetLines();
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (cells->InitTraversal(); cells->GetNextCell(size, ids);)
  {
    for (vtkIdType i = 0; i + 1 < size; ++i)
    {
      ++ends[static_cast<std::size_t>(ids[i])];
      ++ends[static_cast<std::size_t>(ids[i + 1])];
    }
  }
  return !ends.empty() && std::all_of(ends.begin(), ends.end(), [](int n) { return n == 2; });
}
}

#endif
