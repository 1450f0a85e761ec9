// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where data end, the surface ends, with a clean border; closed surfaces stay closed, and holes
 * filled. In space and in the plane, by every way to a surface.
 */
#include "IPIATestReconstruction.h"
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkSMPTools.h"
#include "vtkStaticCellLocator.h"

#include <omp.h>

#include <functional>
#include <limits>

namespace
{
using ipiatest::Checks;
using ipiatest::OrientedPoints;
using ipiatest::Text;
using ipiatest::Vector3;

using Change = std::function<void(vtkIPIASurfaceReconstruction*)>;

vtkSmartPointer<vtkIPIASurfaceReconstruction> Reconstruct(
  vtkDataObject* cloud, const Change& change = {})
{
  auto reconstruction = vtkSmartPointer<vtkIPIASurfaceReconstruction>::New();
  reconstruction->SetInputDataObject(cloud);
  reconstruction->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  // The single level warns of open surfaces.
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(reconstruction);
  if (change)
  {
    change(reconstruction);
  }
  reconstruction->Update();
  if (!messages->Errors.empty())
  {
    std::cout << "ERROR: " << messages->Errors.front() << std::endl;
  }
  return reconstruction;
}

vtkSmartPointer<vtkIPIASurfaceReconstruction> Reconstruct(
  const OrientedPoints& cloud, const Change& change = {})
{
  return Reconstruct(ipiatest::ToPolyData(cloud), change);
}

void WithoutTrim(vtkIPIASurfaceReconstruction* reconstruction)
{
  reconstruction->TrimUnsupportedOff();
}

/// The points of a cloud that a condition holds for.
OrientedPoints Where(
  const OrientedPoints& cloud, const std::function<bool(const Vector3&)>& condition)
{
  OrientedPoints some;
  for (std::size_t i = 0; i < cloud.Positions.size(); ++i)
  {
    if (condition(cloud.Positions[i]))
    {
      some.Add(cloud.Positions[i], cloud.Normals[i]);
    }
  }
  return some;
}

/// A point of a height field.
void AddHeight(OrientedPoints& cloud, double x, double y)
{
  Vector3 normal{ -0.6 * std::cos(4 * x) * std::cos(3 * y),
    0.45 * std::sin(4 * x) * std::sin(3 * y), 1 };
  vtkMath::Normalize(normal.data());
  cloud.Add({ x, y, 0.15 * std::sin(4 * x) * std::cos(3 * y) }, normal);
}

/// n x m points of a height field on the unit square.
OrientedPoints Terrain(int n, int m)
{
  OrientedPoints cloud;
  for (int j = 0; j < m; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      AddHeight(cloud, static_cast<double>(i) / (n - 1), static_cast<double>(j) / (m - 1));
    }
  }
  return cloud;
}

/// Jittered points of a height field inside a star.
OrientedPoints Star(double spacing)
{
  OrientedPoints cloud;
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(1);
  const auto jittered = [&](int k)
  {
    random->Next();
    return spacing * (k + random->GetRangeValue(-0.3, 0.3));
  };
  const int n = static_cast<int>(1.3 / spacing);
  for (int j = -n; j <= n; ++j)
  {
    for (int i = -n; i <= n; ++i)
    {
      const double x = jittered(i), y = jittered(j);
      if (std::hypot(x, y) < 1 + 0.2 * std::cos(5 * std::atan2(y, x)))
      {
        AddHeight(cloud, x, y);
      }
    }
  }
  return cloud;
}

OrientedPoints GyroidInItsBox()
{
  const double end = vtkMath::Pi();
  const ipiatest::ImplicitShape gyroid{ [](const Vector3& x)
    {
      return std::sin(x[0]) * std::cos(x[1]) + std::sin(x[1]) * std::cos(x[2]) +
        std::sin(x[2]) * std::cos(x[0]);
    },
    [](const Vector3& x)
    {
      return Vector3{ std::cos(x[0]) * std::cos(x[1]) - std::sin(x[2]) * std::sin(x[0]),
        std::cos(x[1]) * std::cos(x[2]) - std::sin(x[0]) * std::sin(x[1]),
        std::cos(x[2]) * std::cos(x[0]) - std::sin(x[1]) * std::sin(x[2]) };
    },
    { -end, -end, -end }, { end, end, end } };
  return ipiatest::PointsOn(gyroid, 8000);
}

/// A sphere thirty times as dense at one pole as at the other.
OrientedPoints UnevenSphere()
{
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(1);
  return Where(ipiatest::SpherePoints(50000),
    [&](const Vector3& x)
    {
      random->Next();
      return random->GetValue() < std::pow(30., (x[2] - 1) / 2);
    });
}

/// A sphere without a cap of a tenth of its area.
OrientedPoints SphereWithoutCap(int n)
{
  return Where(ipiatest::SpherePoints(n),
    [](const Vector3& x) { return x[0] + x[1] + x[2] < 0.8 * std::sqrt(3.); });
}

/// The largest distance of a vertex from the points.
double FarthestVertex(vtkPolyData* surface, const OrientedPoints& cloud)
{
  auto data = ipiatest::ToPolyData(cloud);
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(data);
  locator->BuildLocator();
  double farthest = 0;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double x[3], p[3];
    surface->GetPoint(i, x);
    data->GetPoint(locator->FindClosestPoint(x), p);
    farthest = std::max(farthest, std::sqrt(vtkMath::Distance2BetweenPoints(x, p)));
  }
  return farthest;
}

/// The largest distance of a point from the surface.
double FarthestPoint(vtkPolyData* surface, const OrientedPoints& cloud)
{
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(surface);
  locator->BuildLocator();
  vtkNew<vtkGenericCell> cell;
  double farthest = 0;
  for (const Vector3& x : cloud.Positions)
  {
    double closest[3], distance2 = VTK_DOUBLE_MAX;
    vtkIdType id = -1;
    int sub = 0;
    locator->FindClosestPoint(x.data(), closest, cell, id, sub, distance2);
    farthest = std::max(farthest, std::sqrt(distance2));
  }
  return farthest;
}

double BorderLength(vtkPolyData* surface)
{
  auto border = ipiatest::Edges(surface, true);
  double length = 0;
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (border->GetLines()->InitTraversal(); border->GetLines()->GetNextCell(size, ids);)
  {
    double a[3], b[3];
    border->GetPoint(ids[0], a);
    border->GetPoint(ids[1], b);
    length += std::sqrt(vtkMath::Distance2BetweenPoints(a, b));
  }
  return length;
}

/// Also those of the cut.
void CheckVertices(
  Checks& checks, vtkIPIASurfaceReconstruction* reconstruction, const std::string& what)
{
  ipiatest::CheckVertices(checks, reconstruction, 1e-3, 1e-5, what);
}

struct OpenSurface
{
  std::string Name;
  OrientedPoints Cloud;
  double Spacing;
  double Border;        ///< the length of the border of the shape
  OrientedPoints Whole; ///< with what is to be filled
};

void TestOpenSurface(Checks& checks, const OpenSurface& open)
{
  auto reconstruction = Reconstruct(open.Cloud);
  vtkPolyData* surface = reconstruction->GetOutput();
  const ipiatest::Topology found = ipiatest::TopologyOf(surface);
  checks.Equal(found.Components, 1, open.Name + ": components");
  checks.Equal(found.NonManifoldEdges, vtkIdType(0), open.Name + ": non-manifold edges");
  checks.Equal(ipiatest::CountComponents(ipiatest::Edges(surface, true)), 1,
    open.Name + ": borders; inside all is covered");
  checks.That(reconstruction->GetNumberOfPartsTrimmed() > 0, open.Name + ": parts trimmed");
  checks.AtMost(FarthestVertex(surface, open.Whole) / open.Spacing, 2,
    open.Name + ": farthest vertex from the data, in spacings");
  checks.AtMost(FarthestPoint(surface, open.Cloud) / open.Spacing, 0.1,
    open.Name + ": farthest data from the surface, in spacings");
  // A staircase or teeth of triangles would make it longer by a fifth or more.
  checks.AtMost(BorderLength(surface) / open.Border, 1.1, open.Name + ": length of the border");
  CheckVertices(checks, reconstruction, open.Name);

  auto whole = Reconstruct(open.Cloud, WithoutTrim);
  checks.Equal(whole->GetNumberOfPartsTrimmed(), 0, open.Name + ", off: parts trimmed");
  checks.That(FarthestVertex(whole->GetOutput(), open.Whole) > 2 * open.Spacing,
    open.Name + ", off: goes on beyond the data");
}

void TestOpenSurfaces(Checks& checks)
{
  const auto lengthOf = [](const std::function<double(double)>& speed)
  {
    constexpr int n = 10000;
    double length = 0;
    for (int k = 0; k < n; ++k)
    {
      length += speed(2 * vtkMath::Pi() * (k + 0.5) / n) * 2 * vtkMath::Pi() / n;
    }
    return length;
  };
  // Along the border of the square and of the star, with the slope of the height field.
  const auto along = [](double x, double y, double dx, double dy)
  {
    const double dz =
      0.6 * std::cos(4 * x) * std::cos(3 * y) * dx - 0.45 * std::sin(4 * x) * std::sin(3 * y) * dy;
    return std::sqrt(dx * dx + dy * dy + dz * dz);
  };
  const double square = lengthOf(
    [&](double t)
    {
      const double s = t / (2 * vtkMath::Pi()), speed = 1 / (2 * vtkMath::Pi());
      return along(s, 0, speed, 0) + along(s, 1, speed, 0) + along(0, s, 0, speed) +
        along(1, s, 0, speed);
    });
  const double star = lengthOf(
    [&](double t)
    {
      const double r = 1 + 0.2 * std::cos(5 * t), dr = -std::sin(5 * t), c = std::cos(t),
                   s = std::sin(t);
      return along(r * c, r * s, dr * c - r * s, dr * s + r * c);
    });
  const double rim = std::sqrt(1 - 0.25 * 0.25); // of the ellipsoid at 0.15, by its semi-axes
  const double mask =
    lengthOf([&](double t) { return rim * std::hypot(std::sin(t), 1.3 * std::cos(t)); });
  const OrientedPoints terrain = Terrain(80, 80), points = Star(0.025);
  const OrientedPoints half =
    Where(ipiatest::SpherePoints(10000), [](const Vector3& x) { return x[2] > 0; });
  TestOpenSurface(checks, { "terrain", terrain, 1. / 79, square, terrain });
  TestOpenSurface(checks, { "star", points, 0.025, star, points });
  TestOpenSurface(checks, { "half a sphere", half, 0.0355, 2 * vtkMath::Pi(), half });
  TestOpenSurface(checks,
    { "mask", ipiatest::MaskPoints(20000, true), 0.025, mask, ipiatest::MaskPoints(20000, false) });
}

/// It ends at its box; its border runs over all six faces.
void TestGyroid(Checks& checks)
{
  const OrientedPoints cloud = GyroidInItsBox();
  const double spacing = std::sqrt(122. / 8000);
  for (bool trim : { true, false })
  {
    auto reconstruction =
      Reconstruct(cloud, [=](vtkIPIASurfaceReconstruction* r) { r->SetTrimUnsupported(trim); });
    vtkPolyData* surface = reconstruction->GetOutput();
    double beyond = 0;
    for (int k = 0; k < 6; ++k)
    {
      beyond = std::max(beyond, std::abs(surface->GetBounds()[k]) - vtkMath::Pi());
    }
    if (trim)
    {
      checks.AtMost(beyond / spacing, 2, "gyroid: farthest beyond its box, in spacings");
      checks.Equal(ipiatest::TopologyOf(surface).Components, 1, "gyroid: components");
      checks.AtMost(FarthestPoint(surface, cloud) / spacing, 0.1,
        "gyroid: farthest data from the surface, in spacings");
      CheckVertices(checks, reconstruction, "gyroid");
    }
    else
    {
      checks.That(beyond > 2 * spacing, "gyroid, off: goes on beyond its box");
    }
  }
}

bool SameSurface(vtkPolyData* a, vtkPolyData* b)
{
  return a->GetNumberOfPoints() > 0 &&
    ipiatest::SameArray(a->GetPoints()->GetData(), b->GetPoints()->GetData()) &&
    ipiatest::SameArray(a->GetPointData()->GetNormals(), b->GetPointData()->GetNormals()) &&
    ipiatest::SameArray(
      a->GetPolys()->GetConnectivityArray(), b->GetPolys()->GetConnectivityArray()) &&
    ipiatest::SameArray(
      a->GetLines()->GetConnectivityArray(), b->GetLines()->GetConnectivityArray());
}

/// Nothing is changed, whatever the sampling.
void TestClosedSurfaces(Checks& checks)
{
  const ipiatest::ImplicitShape ball = ipiatest::Sphere(1, { 0, 0, 0 });
  struct Closed
  {
    std::string Name;
    OrientedPoints Cloud;
    int Genus;
  };
  const Closed closed[] = { { "sphere", ipiatest::SpherePoints(5000), 0 },
    { "sphere of random points", ipiatest::PointsOn(ball, 5000, 1, ipiatest::Choice::Random), 0 },
    { "torus", ipiatest::PointsOn(ipiatest::Torus(1, 0.4), 5000), 1 },
    { "uneven sphere", UnevenSphere(), 0 },
    // One percent of the diagonal of its box.
    { "noisy sphere", ipiatest::NoisySphere(10000, 0.0346), 0 },
    { "sphere without a cap", SphereWithoutCap(5000), 0 } };
  for (const Closed& surface : closed)
  {
    auto trimmed = Reconstruct(surface.Cloud);
    checks.Equal(ipiatest::TopologyOf(trimmed->GetOutput()),
      ipiatest::Topology{ 1, surface.Genus, 0, 0 }, surface.Name);
    checks.Equal(trimmed->GetNumberOfPartsTrimmed(), 0, surface.Name + ": parts trimmed");
    checks.That(
      SameSurface(trimmed->GetOutput(), Reconstruct(surface.Cloud, WithoutTrim)->GetOutput()),
      surface.Name + ": as without trimming");
  }
}

/// A filled hole is cut out where it is larger than HoleSize, its share of the supported area.
void TestHoleSize(Checks& checks)
{
  const OrientedPoints cloud = SphereWithoutCap(5000);
  for (const double size : { 0., 0.05, 0.2 })
  {
    auto reconstruction =
      Reconstruct(cloud, [=](vtkIPIASurfaceReconstruction* r) { r->SetHoleSize(size); });
    vtkPolyData* surface = reconstruction->GetOutput();
    const std::string what = Text("cap with HoleSize ", size);
    checks.Equal(reconstruction->GetNumberOfPartsTrimmed(), size < 0.1 ? 1 : 0, what);
    checks.Equal(ipiatest::CountEdges(surface, true) > 0, size < 0.1, what + " is open");
    if (size < 0.1)
    {
      checks.AtMost(FarthestVertex(surface, cloud) / 0.05, 2, what + ": farthest vertex");
      checks.AtMost(BorderLength(surface) / (2 * vtkMath::Pi() * 0.6), 1.1, what + ": border");
    }
  }
}

/// The ground around a house and its roof, seen from above, with a gap in the ground.
OrientedPoints GroundAndRoof()
{
  OrientedPoints seen;
  for (int i = 0; i < 60; ++i)
  {
    for (int j = 0; j < 60; ++j)
    {
      const bool isGap = i >= 5 && i < 14 && j >= 5 && j < 14;
      const bool isRoof = i >= 22 && i < 42 && j >= 22 && j < 42;
      if (!isGap)
      {
        seen.Add({ double(i), double(j), isRoof ? 10. : 0. }, { 0, 0, 1 });
      }
    }
  }
  return seen;
}

/// A block with a tower, whose walls have no points, with or without the bottom.
OrientedPoints BlockWithTower(bool hasBottom)
{
  OrientedPoints seen;
  const int size = 40, height = 12;
  for (int i = 0; i <= size; ++i)
  {
    for (int j = 0; j <= size; ++j)
    {
      const bool isRoof = i >= 12 && i <= 28 && j >= 12 && j <= 28;
      seen.Add({ double(i), double(j), isRoof ? 10. : 0. }, { 0, 0, 1 });
      if (hasBottom)
      {
        seen.Add({ double(i), double(j), double(-height) }, { 0, 0, -1 });
      }
    }
    for (int k = -height; k <= 0; ++k)
    {
      seen.Add({ 0., double(i), double(k) }, { -1, 0, 0 });
      seen.Add({ double(size), double(i), double(k) }, { 1, 0, 0 });
      seen.Add({ double(i), 0., double(k) }, { 0, -1, 0 });
      seen.Add({ double(i), double(size), double(k) }, { 0, 1, 0 });
    }
  }
  return seen;
}

/// Hidden walls of a model that is closed elsewhere stay, those of an open one go.
void TestHiddenPartsOfModels(Checks& checks)
{
  for (const bool isClosed : { true, false })
  {
    auto reconstruction = Reconstruct(BlockWithTower(isClosed));
    vtkPolyData* surface = reconstruction->GetOutput();
    const std::string what = isClosed ? "closed block: " : "open block: ";
    checks.Equal(ipiatest::CountComponents(surface), isClosed ? 1 : 2, what + "components");
    // Of the bottom, of the block's top around the tower, and of the tower's roof.
    checks.Equal(ipiatest::CountComponents(ipiatest::Edges(surface, true)), isClosed ? 0 : 3,
      what + "borders");
  }
}

/// Walls that were not seen from above are cut out, whatever their size; a gap is a hole.
void TestHiddenParts(Checks& checks)
{
  const OrientedPoints cloud = GroundAndRoof();
  const auto verticesOfWalls = [](vtkPolyData* surface)
  {
    vtkIdType count = 0;
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
    {
      const double z = surface->GetPoint(i)[2];
      count += z > 4 && z < 6 ? 1 : 0;
    }
    return count;
  };
  checks.That(
    verticesOfWalls(Reconstruct(cloud, WithoutTrim)->GetOutput()) > 100, "walls untrimmed");
  for (const double size : { 0.15, 10. })
  {
    auto reconstruction =
      Reconstruct(cloud, [=](vtkIPIASurfaceReconstruction* r) { r->SetHoleSize(size); });
    vtkPolyData* surface = reconstruction->GetOutput();
    const std::string what = Text("roof, HoleSize ", size);
    checks.Equal(verticesOfWalls(surface), vtkIdType{ 0 }, what + ": no walls");
    checks.Equal(ipiatest::CountComponents(surface), 2, what + ": ground and roof");
    checks.Equal(ipiatest::CountComponents(ipiatest::Edges(surface, true)), 3,
      what + ": borders of the ground and of the roof, none of the gap");
  }
}

/// A wide domain, in which the surface closes behind the data.
void TestWideDomain(Checks& checks)
{
  const OrientedPoints cloud =
    Where(ipiatest::SpherePoints(5000), [](const Vector3& x) { return x[2] > 0; });
  auto reconstruction =
    Reconstruct(cloud, [](vtkIPIASurfaceReconstruction* r) { r->GetFitter()->SetPadding(0.5); });
  checks.AtMost(FarthestVertex(reconstruction->GetOutput(), cloud) / 0.05, 2,
    "half a sphere in a wide domain: farthest vertex from the data, in spacings");
}

/// A domain that ends where the data end leaves nothing to trim.
void TestTightDomain(Checks& checks)
{
  auto reconstruction = Reconstruct(Terrain(60, 60),
    [](vtkIPIASurfaceReconstruction* r) { r->GetFitter()->SetModelBounds(0, 1, 0, 1, -0.3, 0.3); });
  checks.Equal(reconstruction->GetNumberOfPartsTrimmed(), 0, "tight ModelBounds: parts trimmed");
  checks.AtMost(reconstruction->GetOutput()->GetBounds()[0], 1e-6, "tight ModelBounds: lower end");
}

/// Dense along lines, a tenth as dense across, as from a scanner.
void TestScanLines(Checks& checks)
{
  const OrientedPoints cloud = Terrain(400, 40);
  auto reconstruction = Reconstruct(cloud);
  vtkPolyData* surface = reconstruction->GetOutput();
  checks.Equal(ipiatest::CountComponents(surface), 1, "scan lines: components");
  checks.Equal(ipiatest::CountComponents(ipiatest::Edges(surface, true)), 1,
    "scan lines: borders; no gap between lines is cut out");
  checks.AtMost(FarthestVertex(surface, cloud) * 39, 2,
    "scan lines: farthest vertex, in distances of the lines");
}

/// Offset rows on a single level, and samples of an image.
void TestOtherWays(Checks& checks)
{
  const OrientedPoints cloud = Terrain(80, 80);
  struct Way
  {
    std::string Name;
    Change Set;
  };
  const Way ways[] = { { "single level",
                         [](vtkIPIASurfaceReconstruction* r)
                         {
                           r->GetFitter()->SetNumberOfLevels(1);
                           r->GetFitter()->SetNormalConstraintToTwoSidedOffset();
                         } },
    { "samples",
      [](vtkIPIASurfaceReconstruction* r) { r->GetFitter()->SetSampleDimensions(120, 120, 60); } },
    { "given grid",
      [](vtkIPIASurfaceReconstruction* r) { r->GetFitter()->SetGridSize(40, 40, 40); } } };
  for (const Way& way : ways)
  {
    auto reconstruction = Reconstruct(cloud, way.Set);
    vtkPolyData* surface = reconstruction->GetOutput();
    checks.AtMost(FarthestVertex(surface, cloud) * 79, 2, way.Name + ": farthest vertex");
    checks.AtMost(FarthestPoint(surface, cloud) * 79, 0.2, way.Name + ": farthest data");
    checks.Equal(
      ipiatest::CountComponents(ipiatest::Edges(surface, true)), 1, way.Name + ": borders");
  }
}

/// Two blocks as one, and the same bits on any number of threads.
void TestInputsAndThreads(Checks& checks)
{
  const OrientedPoints cloud = Star(0.04);
  auto alone = Reconstruct(cloud);
  OrientedPoints first, second;
  for (std::size_t i = 0; i < cloud.Positions.size(); ++i)
  {
    (2 * i < cloud.Positions.size() ? first : second).Add(cloud.Positions[i], cloud.Normals[i]);
  }
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, ipiatest::ToPolyData(first));
  blocks->SetBlock(1, ipiatest::ToPolyData(second));
  const auto unfeathered =
    Reconstruct(blocks, [](vtkIPIASurfaceReconstruction* r) { r->GetFitter()->FeatherScansOff(); });
  checks.That(SameSurface(alone->GetOutput(), unfeathered->GetOutput()),
    "two blocks, not feathered, give what one data set gives");
  for (int threads : { 1, 2, 4 })
  {
    omp_set_num_threads(threads);
    vtkSMPTools::Initialize(threads);
    checks.That(SameSurface(alone->GetOutput(), Reconstruct(cloud)->GetOutput()),
      Text("same bits on ", threads, " thread(s)"));
  }
  omp_set_num_threads(omp_get_num_procs());
  vtkSMPTools::Initialize();
}

/// Far from the origin, where single precision would show.
void TestMapCoordinates(Checks& checks)
{
  constexpr double shift = 5e6;
  const OrientedPoints cloud = Star(0.04);
  OrientedPoints moved = cloud;
  for (Vector3& x : moved.Positions)
  {
    x = { x[0] + shift, x[1] + shift, x[2] + shift };
  }
  auto near = Reconstruct(cloud),
       far = Reconstruct(moved,
         [](vtkIPIASurfaceReconstruction*r)
         { r->SetOutputPointsPrecision(vtkAlgorithm::DEFAULT_PRECISION); });
  vtkPolyData *a = near->GetOutput(), *b = far->GetOutput();
  checks.Equal(b->GetPoints()->GetDataType(), VTK_DOUBLE, "map coordinates: type of points");
  if (checks.Equal(b->GetNumberOfPoints(), a->GetNumberOfPoints(), "map coordinates: points"))
  {
    double largest = 0;
    for (vtkIdType i = 0; i < a->GetNumberOfPoints(); ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        largest = std::max(largest, std::abs(b->GetPoint(i)[k] - shift - a->GetPoint(i)[k]));
      }
    }
    checks.AtMost(largest, 1e-5, "map coordinates: largest difference");
  }
}

/// The ends of a polyline lie at the ends of the data; a circle stays closed.
void TestCurves(Checks& checks)
{
  constexpr int n = 200;
  const double spacing = 2 * vtkMath::Pi() / n;
  const OrientedPoints circle = ipiatest::PointsOn(ipiatest::Circle(1), n);
  const OrientedPoints half = Where(circle, [](const Vector3& x) { return x[1] > -1e-9; });
  for (int across : { 0, 1, 2 })
  {
    const std::string what = Text("half a circle across axis ", across);
    const int first = across == 0 ? 1 : 0, second = across == 2 ? 1 : 2;
    const OrientedPoints cloud = ipiatest::InPlane(half, first, second, 7);
    for (bool classic : { false, true })
    {
      auto reconstruction = Reconstruct(cloud,
        [=](vtkIPIASurfaceReconstruction* r)
        {
          if (classic)
          {
            r->GetFitter()->SetNumberOfLevels(1);
            r->GetFitter()->SetNormalConstraintToTwoSidedOffset();
          }
        });
      vtkPolyData* curve = reconstruction->GetOutput();
      checks.Equal(curve->GetNumberOfLines(), vtkIdType(1), what + ": polylines");
      checks.That(!ipiatest::IsClosedCurve(curve), what + ": open");
      checks.AtMost(FarthestVertex(curve, cloud) / spacing, 2, what + ": farthest vertex");
      checks.AtMost(FarthestPoint(curve, cloud) / spacing, 0.1, what + ": farthest data");
      CheckVertices(checks, reconstruction, what);
    }
    checks.That(FarthestVertex(Reconstruct(cloud, WithoutTrim)->GetOutput(), cloud) > 2 * spacing,
      what + ", off: goes on beyond the data");
    auto closed = Reconstruct(ipiatest::InPlane(circle, first, second, 7));
    checks.That(ipiatest::IsClosedCurve(closed->GetOutput()), "a circle stays closed");
    checks.Equal(closed->GetNumberOfPartsTrimmed(), 0, "a circle: parts trimmed");
  }
}

void TestParameters(Checks& checks)
{
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  checks.Equal(reconstruction->GetTrimUnsupported(), true, "TrimUnsupported by default");
  checks.Equal(reconstruction->GetTrimDistance(), 3., "TrimDistance by default");
  checks.Equal(reconstruction->GetHoleSize(), 0.15, "HoleSize by default");
  reconstruction->SetTrimDistance(0);
  checks.Equal(reconstruction->GetTrimDistance(), 1., "least TrimDistance");
  reconstruction->SetHoleSize(-1);
  checks.Equal(reconstruction->GetHoleSize(), 0., "least HoleSize");
  std::ostringstream os;
  reconstruction->Print(os);
  for (const char* name :
    { "TrimUnsupported: 1", "TrimDistance: 1", "HoleSize: 0", "NumberOfPartsTrimmed: 0" })
  {
    checks.That(os.str().find(name) != std::string::npos, Text("PrintSelf has ", name));
  }

  const OrientedPoints cloud = Terrain(40, 40);
  for (const double distance : { 1., 10., VTK_DOUBLE_MAX })
  {
    for (const double size : { 0., VTK_DOUBLE_MAX })
    {
      auto extreme = Reconstruct(cloud,
        [=](vtkIPIASurfaceReconstruction* r)
        {
          r->SetTrimDistance(distance);
          r->SetHoleSize(size);
        });
      const std::string what = Text("TrimDistance ", distance, ", HoleSize ", size);
      checks.That(extreme->GetOutput()->GetNumberOfPoints() > 0, what + ": not empty");
      checks.That(
        ipiatest::IsFinite(extreme->GetOutput()->GetPoints()->GetData()), what + ": finite points");
      checks.AtMost(FarthestVertex(extreme->GetOutput(), cloud) * 39, 2,
        what + ": the sides of an automatic domain are trimmed");
    }
  }

  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const Change& change : { Change([=](auto* r) { r->SetTrimDistance(none); }),
         Change([=](auto* r) { r->SetHoleSize(none); }) })
  {
    vtkNew<vtkIPIASurfaceReconstruction> refused;
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(refused);
    refused->SetInputData(ipiatest::ToPolyData(cloud));
    change(refused);
    refused->Update();
    checks.Equal(
      messages->Errors.size(), std::size_t(1), "errors for a parameter that is no number");
    checks.That(ipiatest::IsEmpty(refused->GetOutput()), "no number: empty output");
  }
}
}

int TestSurfaceReconstructionOpen(int, char*[])
{
  Checks checks;
  TestOpenSurfaces(checks);
  TestGyroid(checks);
  TestClosedSurfaces(checks);
  TestHoleSize(checks);
  TestHiddenParts(checks);
  TestHiddenPartsOfModels(checks);
  TestWideDomain(checks);
  TestTightDomain(checks);
  TestScanLines(checks);
  TestOtherWays(checks);
  TestInputsAndThreads(checks);
  TestMapCoordinates(checks);
  TestCurves(checks);
  TestParameters(checks);
  return checks.Result();
}
