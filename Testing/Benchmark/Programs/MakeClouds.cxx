// SPDX-License-Identifier: BSD-3-Clause
// Clouds and their true surfaces.
//
//   MakeClouds folder [meshes]   the clouds of the comparison, those of scans from a folder of
//   meshes MakeClouds bumps count file  points of a torus with bumps, for the scaling
//
// The first prints one line of JSON for each cloud. Noise moves each point by normal deviates of
// 0.25 % of the diagonal of the surface's bounding box on each axis and turns its normal by about
// 10 degrees.
#include "IPIATestScans.h"
#include "IPIATestShapes.h"
#include "Job.h"
#include "PolyDataFiles.h"
#include "SurfaceSamples.h"

#include <iostream>

namespace
{
using benchmarks::Vector3;
using ipiatest::ImplicitShape;
using ipiatest::OrientedPoints;

constexpr double NoiseOfDiagonal = 0.0025, NoiseOfNormalsInDegrees = 10;

/// Samples per axis of the contour that is the true surface.
constexpr int TruthResolution = 261;

/**
 * A gyroid, one and a half periods to a unit, within the unit ball, with rounded edges: the softmax
 * log(exp(k g) + exp(k s)) / k of the gyroid's function g and the ball's s.
 */
ImplicitShape gyroidInBall()
{
  constexpr double wave = 1.5 * 3.14159265358979323846, sharpness = 25;
  struct Parts
  {
    double Value;
    Vector3 Gradient;
  };
  const auto parts = [](const Vector3& p) -> Parts
  {
    // Not 0 in the middle, where the direction outwards has no meaning and no weight.
    const double radius = std::max(vtkMath::Norm(p.data()), 1e-12);
    Vector3 sine{}, cosine{};
    for (std::size_t a = 0; a < 3; ++a)
    {
      sine[a] = std::sin(wave * p[a]);
      cosine[a] = std::cos(wave * p[a]);
    }
    double gyroid = 0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      gyroid += sine[a] * cosine[(a + 1) % 3] / wave;
    }
    // softmax without overflow
    const double ball = radius - 1, highest = std::max(gyroid, ball);
    const double ofGyroid = std::exp(sharpness * (gyroid - highest));
    const double ofBall = std::exp(sharpness * (ball - highest));
    const double sum = ofGyroid + ofBall;
    Parts result{ highest + std::log(sum) / sharpness, {} };
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double slope = cosine[a] * cosine[(a + 1) % 3] - sine[(a + 2) % 3] * sine[a];
      result.Gradient[a] = (ofGyroid * slope + ofBall * p[a] / radius) / sum;
    }
    return result;
  };
  return { [parts](const Vector3& p) { return parts(p).Value; },
    [parts](const Vector3& p) { return parts(p).Gradient; }, { -1.1, -1.1, -1.1 },
    { 1.1, 1.1, 1.1 } };
}

void moveOnto(const ImplicitShape& shape, Vector3& x)
{
  for (int step = 0; step < 5; ++step)
  {
    const Vector3 g = shape.Gradient(x);
    const double t = shape.Value(x) / vtkMath::Dot(g.data(), g.data());
    for (std::size_t a = 0; a < 3; ++a)
    {
      x[a] -= t * g[a];
    }
  }
}

/// A contour of the shape whose vertices lie on it.
vtkSmartPointer<vtkPolyData> trueSurface(const ImplicitShape& shape)
{
  auto surface = ipiatest::Triangulate(shape, TruthResolution);
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    Vector3 x;
    surface->GetPoint(i, x.data());
    moveOnto(shape, x);
    surface->GetPoints()->SetPoint(i, x.data());
  }
  return surface;
}

/// Random points of the shape with exact normals.
OrientedPoints randomPoints(const ImplicitShape& shape, vtkPolyData* surface, std::size_t count)
{
  std::mt19937_64 engine(1);
  OrientedPoints cloud;
  for (auto& sample : benchmarks::SampleSurface(surface, count, engine))
  {
    moveOnto(shape, sample.Position);
    Vector3 normal = shape.Gradient(sample.Position);
    vtkMath::Normalize(normal.data());
    cloud.Add(sample.Position, normal);
  }
  return cloud;
}

OrientedPoints pointsOf(vtkPolyData* data)
{
  OrientedPoints cloud;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    Vector3 position, normal;
    data->GetPoint(i, position.data());
    data->GetPointData()->GetNormals()->GetTuple(i, normal.data());
    cloud.Add(position, normal);
  }
  return cloud;
}

OrientedPoints withNoise(OrientedPoints cloud, double diagonal)
{
  std::mt19937_64 engine(2);
  std::normal_distribution<double> deviate;
  const double ofPosition = NoiseOfDiagonal * diagonal;
  // Two of the deviates turn a unit normal, so that the tangent of the angle has this mean square.
  const double ofNormal =
    std::tan(vtkMath::RadiansFromDegrees(NoiseOfNormalsInDegrees)) / std::sqrt(2.);
  for (std::size_t k = 0; k < cloud.Positions.size(); ++k)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      cloud.Positions[k][a] += ofPosition * deviate(engine);
      cloud.Normals[k][a] += ofNormal * deviate(engine);
    }
    vtkMath::Normalize(cloud.Normals[k].data());
  }
  return cloud;
}

void writeClouds(const std::string& folder, const std::string& name, const OrientedPoints& clean,
  vtkPolyData* truth)
{
  const std::string truthName = folder + "/" + name + "-truth.ply";
  benchmarks::WriteSurface(truth, truthName);
  for (const bool noisy : { false, true })
  {
    const std::string cloudName = folder + "/" + name + (noisy ? "-noise.ply" : ".ply");
    benchmarks::WriteCloud(
      ipiatest::ToPolyData(noisy ? withNoise(clean, truth->GetLength()) : clean), cloudName);
    std::cout << "{\"name\": \"" << name << (noisy ? ", noise" : "")
              << "\", \"points\": " << clean.Positions.size() << ", \"cloud\": \"" << cloudName
              << "\", \"truth\": \"" << truthName << "\"}" << std::endl;
  }
}

/// A torus whose tube is thicker and thinner in turn: radius 0.4 + 0.03 cos(9 u) cos(6 v).
OrientedPoints bumpyTorus(std::size_t count)
{
  constexpr double tube = 0.4, height = 0.03, around = 9, across = 6;
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> angle(0, 2 * vtkMath::Pi());
  std::uniform_real_distribution<double> uniform(0, 1);
  OrientedPoints cloud;
  cloud.Positions.reserve(count);
  cloud.Normals.reserve(count);
  while (cloud.Positions.size() < count)
  {
    const double u = angle(engine), v = angle(engine);
    const double r = tube + height * std::cos(around * u) * std::cos(across * v);
    const double byU = -height * around * std::sin(around * u) * std::cos(across * v);
    const double byV = -height * across * std::cos(around * u) * std::sin(across * v);
    const double ring = 1 + r * std::cos(v);
    const Vector3 outwards{ std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v) };
    const Vector3 alongV{ -std::sin(v) * std::cos(u), -std::sin(v) * std::sin(u), std::cos(v) };
    const Vector3 alongU{ -std::sin(u), std::cos(u), 0 };
    Vector3 position, tangentU, tangentV, normal;
    const Vector3 centre{ std::cos(u), std::sin(u), 0 };
    for (std::size_t a = 0; a < 3; ++a)
    {
      position[a] = centre[a] + r * outwards[a];
      tangentU[a] = ring * alongU[a] + byU * outwards[a];
      tangentV[a] = r * alongV[a] + byV * outwards[a];
    }
    vtkMath::Cross(tangentU.data(), tangentV.data(), normal.data());
    // Accepted by their share of area, which the largest possible one bounds.
    constexpr double largest = 1.5 * 0.55;
    if (uniform(engine) * largest < vtkMath::Normalize(normal.data()))
    {
      cloud.Add(position, normal);
    }
  }
  return cloud;
}

void makeClouds(const std::vector<std::string>& arguments)
{
  if (arguments[0] == "bumps")
  {
    benchmarks::WriteCloud(
      ipiatest::ToPolyData(bumpyTorus(std::stoul(arguments.at(1))), VTK_FLOAT), arguments.at(2));
    return;
  }
  struct Shape
  {
    const char* Name;
    ImplicitShape Function;
    std::size_t Points;
  };
  for (const Shape& shape : { Shape{ "torus", ipiatest::Torus(1, 0.4), 10000 },
         Shape{ "double-torus", ipiatest::DoubleTorus(std::sqrt(0.02)), 20000 },
         Shape{ "gyroid", gyroidInBall(), 60000 } })
  {
    auto truth = trueSurface(shape.Function);
    writeClouds(arguments[0], shape.Name, randomPoints(shape.Function, truth, shape.Points), truth);
  }
  for (const auto& scan : { std::make_pair("bunny", "bunny00"), { "armadillo", "armadillo" } })
  {
    if (arguments.size() > 1)
    {
      auto mesh = ipiatest::ReadScan(arguments[1], scan.second);
      writeClouds(arguments[0], scan.first, pointsOf(mesh), mesh);
    }
  }
}
}

int main(int argc, char* argv[])
{
  return benchmarks::RunJob(argc, argv, 1, "folder [meshes] | bumps count file", makeClouds);
}
