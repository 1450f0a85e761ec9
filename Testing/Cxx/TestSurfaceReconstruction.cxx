// SPDX-License-Identifier: BSD-3-Clause
/**
 * The reconstruction in one step, with nothing set: the right pieces, facing outward, on the zero
 * set and on the shape, with the exact normals, in space, in the plane and far from the origin.
 */
#include "IPIATestReconstruction.h"
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkSMPTools.h"
#include "vtkTriangle.h"

#include <omp.h>

namespace
{
using ipiatest::Checks;
using ipiatest::OrientedPoints;
using ipiatest::Text;
using ipiatest::Vector3;

vtkSmartPointer<vtkIPIASurfaceReconstruction> Reconstruct(const OrientedPoints& cloud)
{
  auto reconstruction = vtkSmartPointer<vtkIPIASurfaceReconstruction>::New();
  reconstruction->SetInputData(ipiatest::ToPolyData(cloud));
  reconstruction->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  reconstruction->Update();
  return reconstruction;
}

/// The divergence theorem: positive where the triangles face outward.
double SignedVolume(vtkPolyData* surface)
{
  double volume = 0;
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (surface->GetPolys()->InitTraversal(); surface->GetPolys()->GetNextCell(size, ids);)
  {
    double a[3], b[3], c[3];
    surface->GetPoint(ids[0], a);
    surface->GetPoint(ids[1], b);
    surface->GetPoint(ids[2], c);
    volume += vtkMath::Determinant3x3(a, b, c) / 6;
  }
  return volume;
}

/// The share of the area whose triangles face against the normals of their points.
double TurnedArea(vtkPolyData* surface)
{
  double turned = 0, total = 0;
  vtkDataArray* normals = surface->GetPointData()->GetNormals();
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (surface->GetPolys()->InitTraversal(); surface->GetPolys()->GetNextCell(size, ids);)
  {
    double x[3][3], sum[3] = { 0, 0, 0 }, facing[3];
    for (int i = 0; i < 3; ++i)
    {
      surface->GetPoint(ids[i], x[i]);
      vtkMath::Add(sum, normals->GetTuple3(ids[i]), sum);
    }
    vtkTriangle::ComputeNormalDirection(x[0], x[1], x[2], facing);
    const double area = vtkMath::Norm(facing) / 2;
    turned += vtkMath::Dot(facing, sum) < 0 ? area : 0;
    total += area;
  }
  return turned / total;
}

/// In knot spacings, of a surface that is not cut.
constexpr double LargestValue = 1e-4;

void TestSurface(Checks& checks, const ipiatest::KnownSurface& surface, ipiatest::Choice choice)
{
  const std::string what = Text(surface.Name, ", ", surface.Cloud.Positions.size(),
    choice == ipiatest::Choice::Even ? " even points" : " random points");
  auto reconstruction = Reconstruct(surface.Cloud);
  vtkPolyData* output = reconstruction->GetOutput();
  checks.Equal(ipiatest::TopologyOf(output),
    ipiatest::Topology{ surface.Components, surface.Genus, 0, 0 }, what);
  checks.Equal(reconstruction->GetNumberOfComponentsLeftOut(), 0, what + ": left out");
  ipiatest::CheckVertices(checks, reconstruction, LargestValue, 1e-6, what);
  double distance = 0;
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    Vector3 x;
    output->GetPoint(i, x.data());
    distance = std::max(distance, surface.Distance(x));
  }
  const double h = ipiatest::KnotSpacing(reconstruction->GetFitter());
  // Twice what was measured. Between random points are gaps that only the fairing fills.
  checks.AtMost(distance / h, choice == ipiatest::Choice::Even ? 0.01 : 0.04,
    what + ": distance from the shape in knot spacings");
  checks.AtMost(TurnedArea(output), 1e-6, what + ": area that faces inward");
  checks.AtMost(std::abs(SignedVolume(output) / surface.Volume - 1), 1e-3, what + ": volume");
}

OrientedPoints Shifted(const OrientedPoints& cloud, double shift)
{
  OrientedPoints moved = cloud;
  for (Vector3& x : moved.Positions)
  {
    x = { x[0] + shift, x[1] + shift, x[2] + shift };
  }
  return moved;
}

void CheckSameCells(Checks& checks, vtkPolyData* a, vtkPolyData* b, const std::string& what)
{
  checks.That(ipiatest::SameArray(
                a->GetPolys()->GetConnectivityArray(), b->GetPolys()->GetConnectivityArray()) &&
      ipiatest::SameArray(
        a->GetLines()->GetConnectivityArray(), b->GetLines()->GetConnectivityArray()),
    what + ": same cells");
}

/// Single precision would round map coordinates to half a unit.
void TestMapCoordinates(Checks& checks)
{
  constexpr double shift = 5e6, size = 2.8;
  const auto torus = ipiatest::PointsOn(ipiatest::Torus(1, 0.4), 5000);
  auto plain = Reconstruct(torus);
  vtkNew<vtkIPIASurfaceReconstruction> moved;
  moved->SetInputData(ipiatest::ToPolyData(Shifted(torus, shift)));
  moved->Update();
  vtkPoints* points = moved->GetOutput()->GetPoints();
  checks.Equal(points->GetDataType(), VTK_DOUBLE, "type of points at map coordinates");
  if (checks.Equal(points->GetNumberOfPoints(), plain->GetOutput()->GetNumberOfPoints(),
        "points at map coordinates"))
  {
    double largest = 0;
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
    {
      for (int a = 0; a < 3; ++a)
      {
        largest = std::max(
          largest, std::abs(points->GetPoint(i)[a] - shift - plain->GetOutput()->GetPoint(i)[a]));
      }
    }
    checks.AtMost(largest / size, 1e-6, "difference at map coordinates by the size");
    CheckSameCells(checks, moved->GetOutput(), plain->GetOutput(), "map coordinates");
  }
  ipiatest::CheckVertices(checks, moved, LargestValue, 1e-6, "map coordinates");
}

void TestPrecision(Checks& checks)
{
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(ipiatest::SphereCloud());
  for (auto precision : { std::make_pair(vtkAlgorithm::DEFAULT_PRECISION, VTK_FLOAT),
         std::make_pair(vtkAlgorithm::SINGLE_PRECISION, VTK_FLOAT),
         std::make_pair(vtkAlgorithm::DOUBLE_PRECISION, VTK_DOUBLE) })
  {
    reconstruction->SetOutputPointsPrecision(precision.first);
    reconstruction->Update();
    checks.Equal(reconstruction->GetOutput()->GetPoints()->GetDataType(), precision.second,
      Text("type of points with OutputPointsPrecision ", precision.first));
  }
}

struct Outline
{
  std::string Name;
  OrientedPoints Cloud;
  int Loops;
};

/// In each axis plane.
void TestOutlines(Checks& checks)
{
  using ipiatest::PointsOn;
  OrientedPoints pair = PointsOn(ipiatest::Circle(1), 200);
  pair.Append(PointsOn(ipiatest::Circle(1), 200, 3, 0.4));
  const Outline outlines[] = { { "circle", PointsOn(ipiatest::Circle(1), 200), 1 },
    { "two circles", pair, 2 }, { "flower", PointsOn(ipiatest::Flower(), 400), 1 } };
  constexpr double height = 7;
  for (const Outline& outline : outlines)
  {
    for (int across : { 0, 1, 2 })
    {
      const int first = across == 0 ? 1 : 0, second = across == 2 ? 1 : 2;
      auto reconstruction = Reconstruct(ipiatest::InPlane(outline.Cloud, first, second, height));
      vtkPolyData* curve = reconstruction->GetOutput();
      const std::string what = Text(outline.Name, " across axis ", across);
      checks.Equal(ipiatest::CountComponents(curve), outline.Loops, what + ": loops");
      checks.Equal(curve->GetNumberOfLines(), vtkIdType(outline.Loops), what + ": polylines");
      checks.That(ipiatest::IsClosedCurve(curve), what + ": every loop is closed");
      checks.Equal(curve->GetBounds()[2 * across], height, what + ": lower height");
      checks.Equal(curve->GetBounds()[2 * across + 1], height, what + ": upper height");
      ipiatest::CheckVertices(checks, reconstruction, LargestValue, 1e-6, what);
    }
  }
}

/// The same bits on any number of threads.
void TestThreads(Checks& checks)
{
  const auto cloud = ipiatest::PointsOn(ipiatest::DoubleTorus(std::sqrt(0.03)), 10000);
  vtkSmartPointer<vtkIPIASurfaceReconstruction> first;
  for (int threads : { 1, 2, 4 })
  {
    omp_set_num_threads(threads);
    vtkSMPTools::Initialize(threads);
    auto next = Reconstruct(cloud);
    if (!first)
    {
      first = next;
    }
    const std::string what = Text(threads, " thread(s)");
    vtkPolyData *a = first->GetOutput(), *b = next->GetOutput();
    checks.That(ipiatest::SameArray(a->GetPoints()->GetData(), b->GetPoints()->GetData()),
      what + ": same points");
    checks.That(
      ipiatest::SameArray(a->GetPointData()->GetNormals(), b->GetPointData()->GetNormals()),
      what + ": same normals");
    CheckSameCells(checks, a, b, what);
  }
  vtkSMPTools::Initialize();
}

/// A sphere of many points, and far from it a bubble of radius 0.4 with few, which extra rows
/// raise.
vtkSmartPointer<vtkIPIASurfaceReconstruction> SphereWithBubble(double shift, int many, int few)
{
  OrientedPoints cloud = ipiatest::SpherePoints(many);
  cloud.Append(ipiatest::SpherePoints(few, 0.4, { 2.5, 0, 0 }));
  OrientedPoints shells;
  vtkNew<vtkDoubleArray> values;
  for (double radius : { 0.2, 0.6 })
  {
    shells.Append(ipiatest::SpherePoints(400, radius, { 2.5, 0, 0 }));
    while (values->GetNumberOfTuples() < static_cast<vtkIdType>(shells.Positions.size()))
    {
      values->InsertNextValue(radius - 0.4);
    }
  }
  auto rows = ipiatest::ToPolyData(Shifted(shells, shift));
  rows->GetPointData()->SetScalars(values);
  auto reconstruction = vtkSmartPointer<vtkIPIASurfaceReconstruction>::New();
  reconstruction->SetInputData(ipiatest::ToPolyData(Shifted(cloud, shift)));
  reconstruction->SetExtraRowsData(rows);
  reconstruction->GetFitter()->SetModelBounds(
    shift - 1.3, shift + 3.7, shift - 1.3, shift + 1.3, shift - 1.3, shift + 1.3);
  return reconstruction;
}

void TestComponentWithoutData(Checks& checks)
{
  for (double shift : { 0., 5e6 })
  {
    const std::string what = Text("bubble at ", shift);
    auto reconstruction = SphereWithBubble(shift, 2000, 0);
    reconstruction->ComponentFilterOff();
    reconstruction->Update();
    checks.Equal(
      ipiatest::TopologyOf(reconstruction->GetOutput()), ipiatest::Topology{ 2, 0, 0, 0 }, what);
    checks.Equal(reconstruction->GetNumberOfComponentsLeftOut(), 0, what + ": left out when off");
    reconstruction->ComponentFilterOn();
    reconstruction->Update();
    vtkPolyData* surface = reconstruction->GetOutput();
    checks.Equal(ipiatest::TopologyOf(surface), ipiatest::Topology{ 1, 0, 0, 0 },
      what + ", left out (a vertex of it that stays would count in the genus)");
    checks.Equal(reconstruction->GetNumberOfComponentsLeftOut(), 1, what + ": left out");
    checks.AtMost(surface->GetBounds()[1], shift + 1.1, what + ": farthest vertex that is left");
    checks.Equal(surface->GetPoints()->GetDataType(), shift > 0 ? VTK_DOUBLE : VTK_FLOAT,
      what + ": type of points");
    checks.AtMost(TurnedArea(surface), 1e-6, what + ": area that faces inward");
    checks.Equal(surface->GetPointData()->GetNumberOfArrays(), 1, what + ": arrays");
    checks.That(
      surface->GetFieldData()->GetArray("ResidualHistory") != nullptr, what + ": field data");
    ipiatest::CheckVertices(checks, reconstruction, LargestValue, shift > 0 ? 1e-6 : 1e-5, what);
  }
}

/// The bubble is left out below a fiftieth of the points that its share of the vertices makes one
/// expect.
void TestComponentWithFewData(Checks& checks)
{
  constexpr int many = 6000;
  for (bool leftOut : { false, true })
  {
    const int few = leftOut ? 8 : 40;
    auto reconstruction = SphereWithBubble(0, many, few);
    reconstruction->Update();
    const std::string what = Text("bubble of ", few, " points");
    checks.Equal(reconstruction->GetNumberOfComponentsLeftOut(), leftOut ? 1 : 0, what);
    checks.Equal(ipiatest::TopologyOf(reconstruction->GetOutput()),
      ipiatest::Topology{ leftOut ? 1 : 2, 0, 0, 0 }, what);

    reconstruction->ComponentFilterOff();
    reconstruction->Update();
    vtkPolyData* both = reconstruction->GetOutput();
    checks.Equal(ipiatest::TopologyOf(both), ipiatest::Topology{ 2, 0, 0, 0 }, what + ", both");
    double vertices = 0;
    for (vtkIdType i = 0; i < both->GetNumberOfPoints(); ++i)
    {
      vertices += both->GetPoint(i)[0] > 1.5;
    }
    const double share = vertices / static_cast<double>(both->GetNumberOfPoints());
    checks.Equal(static_cast<double>(few) / (many + few) < share / 50, leftOut,
      Text(what, " with a share of ", share, " of the vertices is below the limit"));
  }
}

/// A small component with data stays, one of fewer than 24 points does not.
void TestSmallComponent(Checks& checks)
{
  for (int few : { 60, 20 })
  {
    OrientedPoints cloud = ipiatest::SpherePoints(6000);
    cloud.Append(ipiatest::SpherePoints(few, 0.1, { 1.5, 0, 0 }));
    const std::string what = Text("small sphere of ", few, " points beside a large one");
    auto reconstruction = Reconstruct(cloud);
    checks.Equal(ipiatest::TopologyOf(reconstruction->GetOutput()),
      ipiatest::Topology{ few < 24 ? 1 : 2, 0, 0, 0 }, what);
    checks.Equal(reconstruction->GetNumberOfComponentsLeftOut(), few < 24 ? 1 : 0, what);
  }
}
}

int TestSurfaceReconstruction(int, char*[])
{
  Checks checks;
  for (auto choice : { ipiatest::Choice::Even, ipiatest::Choice::Random })
  {
    for (const auto& surface : ipiatest::KnownSurfaces(10000, choice))
    {
      TestSurface(checks, surface, choice);
    }
  }
  TestMapCoordinates(checks);
  TestPrecision(checks);
  TestOutlines(checks);
  TestThreads(checks);
  TestComponentWithoutData(checks);
  TestComponentWithFewData(checks);
  TestSmallComponent(checks);
  return checks.Result();
}
