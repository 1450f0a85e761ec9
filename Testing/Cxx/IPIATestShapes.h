// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Oriented points on shapes that are known exactly.
 */
#ifndef IPIATestShapes_h
#define IPIATestShapes_h

#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkFlyingEdges3D.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkMassProperties.h"
#include "vtkMath.h"
#include "vtkMinimalStandardRandomSequence.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStaticPointLocator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace ipiatest
{
using Vector3 = std::array<double, 3>;

/// Points with unit normals.
struct OrientedPoints
{
  std::vector<Vector3> Positions, Normals;

  void Add(const Vector3& position, const Vector3& normal)
  {
    this->Positions.push_back(position);
    this->Normals.push_back(normal);
  }

  void Append(const OrientedPoints& other)
  {
    this->Positions.insert(this->Positions.end(), other.Positions.begin(), other.Positions.end());
    this->Normals.insert(this->Normals.end(), other.Normals.begin(), other.Normals.end());
  }
};

/// As vtkPolyData with active point normals, both of the given floating type.
inline vtkSmartPointer<vtkPolyData> ToPolyData(const OrientedPoints& cloud, int type = VTK_DOUBLE)
{
  const auto n = static_cast<vtkIdType>(cloud.Positions.size());
  vtkNew<vtkPoints> points;
  points->SetDataType(type);
  points->SetNumberOfPoints(n);
  auto normals = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    points->SetPoint(i, cloud.Positions[static_cast<std::size_t>(i)].data());
    normals->SetTuple(i, cloud.Normals[static_cast<std::size_t>(i)].data());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->GetPointData()->SetNormals(normals);
  return data;
}

/// Even points on a sphere, along a spiral of the golden angle.
inline OrientedPoints SpherePoints(
  int n, double radius = 1, const Vector3& centre = { 0, 0, 0 }, double side = 1)
{
  OrientedPoints cloud;
  const double golden = vtkMath::Pi() * (1 + std::sqrt(5.));
  for (int i = 0; i < n; ++i)
  {
    const double z = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - z * z), angle = golden * (i + 0.5);
    const Vector3 u{ r * std::cos(angle), r * std::sin(angle), z };
    cloud.Add({ centre[0] + radius * u[0], centre[1] + radius * u[1], centre[2] + radius * u[2] },
      { side * u[0], side * u[1], side * u[2] });
  }
  return cloud;
}

/// The upper part of an ellipsoid, of n points in all, with or without two holes for the eyes.
inline OrientedPoints MaskPoints(int n, bool eyes)
{
  OrientedPoints cloud;
  const Vector3 axes{ 1, 1.3, 0.6 };
  for (const Vector3& u : SpherePoints(n).Positions)
  {
    const Vector3 x{ axes[0] * u[0], axes[1] * u[1], axes[2] * u[2] };
    Vector3 normal{ u[0] / axes[0], u[1] / axes[1], u[2] / axes[2] };
    vtkMath::Normalize(normal.data());
    if (x[2] > 0.15 && !(eyes && std::hypot(std::abs(x[0]) - 0.35, x[1] - 0.3) < 0.14))
    {
      cloud.Add(x, normal);
    }
  }
  return cloud;
}

inline vtkSmartPointer<vtkPolyData> SphereCloud(
  int n = 600, double radius = 1, const Vector3& centre = { 0, 0, 0 })
{
  return ToPolyData(SpherePoints(n, radius, centre));
}

/// Points of the unit sphere, moved along their normals by up to @a noise either way.
inline OrientedPoints NoisySphere(int n, double noise)
{
  OrientedPoints cloud = SpherePoints(n);
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(1);
  for (Vector3& x : cloud.Positions)
  {
    random->Next();
    const double radius = 1 + random->GetRangeValue(-noise, noise);
    x = { radius * x[0], radius * x[1], radius * x[2] };
  }
  return cloud;
}

/// A surface F = 0 with F < 0 inside, in a box that holds it.
struct ImplicitShape
{
  std::function<double(const Vector3&)> Value;
  std::function<Vector3(const Vector3&)> Gradient;
  Vector3 Lower, Upper;
};

inline ImplicitShape Sphere(double radius, const Vector3& c)
{
  const double r = 1.1 * radius;
  return { [=](const Vector3& x)
    {
      const double d[3] = { x[0] - c[0], x[1] - c[1], x[2] - c[2] };
      return vtkMath::Norm(d) - radius;
    },
    [=](const Vector3& x)
    {
      Vector3 g{ x[0] - c[0], x[1] - c[1], x[2] - c[2] };
      vtkMath::Normalize(g.data());
      return g;
    },
    { c[0] - r, c[1] - r, c[2] - r }, { c[0] + r, c[1] + r, c[2] + r } };
}

/// A torus about the z axis.
inline ImplicitShape Torus(double ring, double tube)
{
  const double r = 1.05 * (ring + tube);
  return { [=](const Vector3& x) { return std::hypot(std::hypot(x[0], x[1]) - ring, x[2]) - tube; },
    [=](const Vector3& x)
    {
      const double rho = std::hypot(x[0], x[1]);
      const double d = std::hypot(rho - ring, x[2]);
      return Vector3{ (rho - ring) / d * x[0] / rho, (rho - ring) / d * x[1] / rho, x[2] / d };
    },
    { -r, -r, -1.2 * tube }, { r, r, 1.2 * tube } };
}

/// (x (x - 1)^2 (x - 2) + y^2)^2 + z^2 = thickness^2: the neighbourhood of a figure of eight.
inline ImplicitShape DoubleTorus(double thickness)
{
  const auto quartic = [](const Vector3& x)
  {
    const double u = x[0] - 1;
    return u * u * (u * u - 1) + x[1] * x[1];
  };
  return { [=](const Vector3& x)
    { return quartic(x) * quartic(x) + x[2] * x[2] - thickness * thickness; },
    [=](const Vector3& x)
    {
      const double u = x[0] - 1, q = quartic(x);
      return Vector3{ 2 * q * (4 * u * u * u - 2 * u), 4 * q * x[1], 2 * x[2] };
    },
    { -0.3, -0.9, -1.2 * thickness }, { 2.3, 0.9, 1.2 * thickness } };
}

/// A fine triangulation of a shape: the contour of n samples per axis.
inline vtkSmartPointer<vtkPolyData> Triangulate(const ImplicitShape& shape, int n = 121)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(n, n, n);
  image->SetOrigin(shape.Lower.data());
  image->SetSpacing((shape.Upper[0] - shape.Lower[0]) / (n - 1),
    (shape.Upper[1] - shape.Lower[1]) / (n - 1), (shape.Upper[2] - shape.Lower[2]) / (n - 1));
  vtkNew<vtkDoubleArray> values;
  values->SetNumberOfTuples(image->GetNumberOfPoints());
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    Vector3 x;
    image->GetPoint(i, x.data());
    values->SetValue(i, shape.Value(x));
  }
  image->GetPointData()->SetScalars(values);
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image);
  contour->SetValue(0, 0.0);
  contour->ComputeNormalsOff();
  contour->Update();
  return contour->GetOutput();
}

/// How points are chosen among the vertices of a triangulation.
enum class Choice
{
  Even,  ///< as discs that are thrown at the surface until none fits
  Random ///< any of them, so that gaps and clusters occur
};

/// All points of a data set in random order.
inline std::vector<vtkIdType> ShuffledPoints(vtkPolyData* data)
{
  std::vector<std::pair<double, vtkIdType>> order;
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(1);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    random->Next();
    order.emplace_back(random->GetValue(), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<vtkIdType> ids;
  for (const auto& entry : order)
  {
    ids.push_back(entry.second);
  }
  return ids;
}

/// Points of a data set of which none are nearer to each other than a radius; every point left out
/// is nearer to one of them.
inline std::vector<vtkIdType> ThinnedPoints(vtkPolyData* data, double radius)
{
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(data);
  locator->BuildLocator();
  std::vector<char> covered(static_cast<std::size_t>(data->GetNumberOfPoints()), 0);
  std::vector<vtkIdType> chosen;
  vtkNew<vtkIdList> near;
  for (vtkIdType next : ShuffledPoints(data))
  {
    if (!covered[static_cast<std::size_t>(next)])
    {
      chosen.push_back(next);
      locator->FindPointsWithinRadius(radius, data->GetPoint(next), near);
      for (vtkIdType k = 0; k < near->GetNumberOfIds(); ++k)
      {
        covered[static_cast<std::size_t>(near->GetId(k))] = 1;
      }
    }
  }
  return chosen;
}

inline std::vector<vtkIdType> ChoosePoints(vtkPolyData* surface, vtkIdType n, Choice choice)
{
  if (choice == Choice::Random)
  {
    auto ids = ShuffledPoints(surface);
    ids.resize(std::min(ids.size(), static_cast<std::size_t>(n)));
    return ids;
  }
  vtkNew<vtkMassProperties> area;
  area->SetInputData(surface);
  area->Update();
  // Discs thrown until none fits are about 0.7 / radius^2 to a unit of area.
  return ThinnedPoints(surface, std::sqrt(0.7 * area->GetSurfaceArea() / static_cast<double>(n)));
}

/**
 * About n points of a shape: vertices of a fine triangulation, brought onto the shape by Newton's
 * method, with the exact normals times @a side.
 */
inline OrientedPoints PointsOn(
  const ImplicitShape& shape, vtkIdType n, double side = 1, Choice choice = Choice::Even)
{
  auto surface = Triangulate(shape);
  OrientedPoints cloud;
  for (vtkIdType id : ChoosePoints(surface, n, choice))
  {
    Vector3 x;
    surface->GetPoint(id, x.data());
    for (int step = 0; step < 5; ++step)
    {
      const Vector3 g = shape.Gradient(x);
      const double t = shape.Value(x) / vtkMath::Dot(g.data(), g.data());
      x = { x[0] - t * g[0], x[1] - t * g[1], x[2] - t * g[2] };
    }
    Vector3 normal = shape.Gradient(x);
    vtkMath::Normalize(normal.data());
    cloud.Add(x, { side * normal[0], side * normal[1], side * normal[2] });
  }
  return cloud;
}

/// A closed surface and what is true of it.
struct KnownSurface
{
  std::string Name;
  OrientedPoints Cloud;
  int Components, Genus;
  std::vector<ImplicitShape> Shapes; ///< that it is made of
  double Volume;                     ///< inside

  /// Distance to the nearest of the shapes, to first order where F is no distance.
  double Distance(const Vector3& x) const
  {
    double nearest = VTK_DOUBLE_MAX;
    for (const ImplicitShape& shape : this->Shapes)
    {
      const Vector3 g = shape.Gradient(x);
      nearest = std::min(nearest, std::abs(shape.Value(x)) / vtkMath::Norm(g.data()));
    }
    return nearest;
  }
};

/// The shapes of the topology tests, about n points each.
inline std::vector<KnownSurface> KnownSurfaces(vtkIdType n, Choice choice = Choice::Even)
{
  const ImplicitShape ball = Sphere(1, { 0, 0, 0 }), torus = Torus(1, 0.4);
  const ImplicitShape eight = DoubleTorus(std::sqrt(0.03));
  const ImplicitShape neighbour = Sphere(1, { 3, 0, 0 }); // the gap is one radius
  const ImplicitShape hollow = Sphere(0.5, { 0, 0, 0 });
  constexpr double pi = 3.14159265358979323846, full = 4 * pi / 3;
  OrientedPoints apart = PointsOn(ball, n / 2, 1, choice);
  apart.Append(PointsOn(neighbour, n / 2, 1, choice));
  OrientedPoints nested = PointsOn(ball, n * 4 / 5, 1, choice);
  nested.Append(PointsOn(hollow, n / 5, -1, choice));
  return {
    { "sphere", PointsOn(ball, n, 1, choice), 1, 0, { ball }, full },
    { "torus", PointsOn(torus, n, 1, choice), 1, 1, { torus }, 2 * pi * pi * 0.4 * 0.4 },
    { "double torus", PointsOn(eight, n, 1, choice), 1, 2, { eight },
      0.540627 }, // the integral of 2 sqrt(thickness^2 - q^2), by quadrature
    { "two spheres", apart, 2, 0, { ball, neighbour }, 2 * full },
    { "nested spheres", nested, 2, 0, { ball, hollow }, full * 7 / 8 },
  };
}

/// A closed curve about the origin of the plane: its radius and the derivative of that by angle.
struct PolarCurve
{
  std::function<double(double)> Radius, Slope;
};

inline PolarCurve Circle(double radius)
{
  return { [=](double) { return radius; }, [](double) { return 0.0; } };
}

inline PolarCurve Flower()
{
  return { [](double t) { return 1 + 0.3 * std::cos(6 * t); },
    [](double t) { return -1.8 * std::sin(6 * t); } };
}

inline PolarCurve Butterfly()
{
  return { [](double t)
    {
      return 8 - std::sin(t) + 2 * std::sin(3 * t) + 2 * std::sin(5 * t) - std::sin(7 * t) +
        3 * std::cos(2 * t) - 2 * std::cos(4 * t);
    },
    [](double t)
    {
      return -std::cos(t) + 6 * std::cos(3 * t) + 10 * std::cos(5 * t) - 7 * std::cos(7 * t) -
        6 * std::sin(2 * t) + 8 * std::sin(4 * t);
    } };
}

/// n points of a polar curve at equal arc lengths, with the exact outward normals.
inline OrientedPoints PointsOn(
  const PolarCurve& curve, int n, double centreX = 0, double centreY = 0)
{
  const auto speed = [&](double t) { return std::hypot(curve.Radius(t), curve.Slope(t)); };
  constexpr int fine = 200000;
  constexpr double dt = 2 * 3.14159265358979323846 / fine;
  double total = 0;
  for (int i = 0; i < fine; ++i)
  {
    total += speed((i + 0.5) * dt) * dt;
  }
  OrientedPoints cloud;
  double length = 0;
  for (int i = 0; i < fine; ++i)
  {
    if (length >= static_cast<double>(cloud.Positions.size()) * total / n)
    {
      const double t = i * dt, r = curve.Radius(t), s = curve.Slope(t), v = speed(t);
      const double c = std::cos(t), d = std::sin(t);
      cloud.Add(
        { centreX + r * c, centreY + r * d, 0 }, { (r * c + s * d) / v, (r * d - s * c) / v, 0 });
    }
    length += speed((i + 0.5) * dt) * dt;
  }
  return cloud;
}

/// The same points in the plane of the axes @a first and @a second, at @a height on the third axis.
inline OrientedPoints InPlane(const OrientedPoints& flat, int first, int second, double height)
{
  OrientedPoints moved = flat;
  const int third = 3 - first - second;
  for (std::size_t i = 0; i < flat.Positions.size(); ++i)
  {
    for (auto list : { &OrientedPoints::Positions, &OrientedPoints::Normals })
    {
      const Vector3 from = (flat.*list)[i];
      Vector3& to = (moved.*list)[i];
      to[static_cast<std::size_t>(first)] = from[0];
      to[static_cast<std::size_t>(second)] = from[1];
      to[static_cast<std::size_t>(third)] = list == &OrientedPoints::Positions ? height : 0;
    }
  }
  return moved;
}
}

#endif
