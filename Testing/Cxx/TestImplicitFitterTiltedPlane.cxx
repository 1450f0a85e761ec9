// SPDX-License-Identifier: BSD-3-Clause
/**
 * Profiles in tilted planes: fitted in their plane and placed back in space, they give the curve,
 * samples and function of the same profile in an axis plane.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkFlyingEdges2D.h"
#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkMatrix3x3.h"
#include "vtkTransform.h"

namespace
{
using ipiatest::Checks;
using ipiatest::Method;
using ipiatest::OrientedPoints;
using ipiatest::Text;
using ipiatest::Vector3;

/// How far values of f in the plane and tilted may differ, relative to the largest.
constexpr double Tolerance = 1e-9;

/// A turn about an axis in the plane, then a shift.
vtkSmartPointer<vtkTransform> Tilt(double degrees, const Vector3& axis, double shift)
{
  auto transform = vtkSmartPointer<vtkTransform>::New();
  transform->Translate(shift, -shift, 2 * shift);
  transform->RotateWXYZ(degrees, axis.data());
  return transform;
}

OrientedPoints Moved(const OrientedPoints& cloud, vtkTransform* transform)
{
  OrientedPoints moved = cloud;
  for (auto& x : moved.Positions)
  {
    transform->TransformPoint(x.data(), x.data());
  }
  for (auto& n : moved.Normals)
  {
    transform->TransformVector(n.data(), n.data());
  }
  return moved;
}

vtkSmartPointer<vtkIPIAImplicitFitter> Fit(const OrientedPoints& cloud, Method method)
{
  auto fitter = NewFitter(method, ipiatest::ToPolyData(cloud));
  fitter->SetOutputScalarTypeToDouble();
  fitter->GenerateGradientOn();
  fitter->Update();
  return fitter;
}

double LargestValue(vtkDataArray* array)
{
  return std::max(std::abs(array->GetRange()[0]), std::abs(array->GetRange()[1]));
}

/// Samples, gradients and their places, the function between them, and the function of the saved
/// lattice.
void CheckSameFit(Checks& checks, const OrientedPoints& cloud, Method method,
  vtkTransform* transform, const std::string& what)
{
  auto flat = Fit(cloud, method);
  auto tilted = Fit(Moved(cloud, transform), method);
  vtkImageData* expected = flat->GetOutput();
  vtkImageData* image = tilted->GetOutput();
  if (!checks.Equal(image->GetNumberOfPoints(), expected->GetNumberOfPoints(), what + ": samples"))
  {
    return;
  }
  checks.Equal(image->GetDataDimension(), 2, what + ": dimension");
  vtkDataArray* f = expected->GetPointData()->GetScalars();
  checks.AtMost(
    ipiatest::LargestDifference(image->GetPointData()->GetScalars(), f) / LargestValue(f),
    Tolerance, what + ": f at the samples");

  vtkNew<vtkIPIAImplicitFunction> saved;
  saved->SetControlLattice(ipiatest::ControlLattice(tilted));
  vtkDataArray* gradients = image->GetPointData()->GetArray("Gradient");
  double place = 0, gradient = 0, between = 0, read = 0;
  const double length = expected->GetLength();
  for (vtkIdType i = 0; i < expected->GetNumberOfPoints(); ++i)
  {
    double x[3], y[3], g[3];
    expected->GetPoint(i, x);
    transform->TransformPoint(x, x);
    image->GetPoint(i, y);
    place = std::max(place, std::sqrt(vtkMath::Distance2BetweenPoints(x, y)));
    transform->TransformVector(expected->GetPointData()->GetArray("Gradient")->GetTuple3(i), g);
    for (int a = 0; a < 3; ++a)
    {
      gradient = std::max(gradient, std::abs(g[a] - gradients->GetComponent(i, a)));
    }
    // Off the samples and off the plane, along which f does not change.
    double p[3];
    expected->GetPoint(i, p);
    p[0] += 0.3 * expected->GetSpacing()[0];
    p[2] += 0.1 * length;
    const double value = flat->GetImplicitFunction()->FunctionValue(p);
    transform->TransformPoint(p, p);
    between = std::max(between, std::abs(tilted->GetImplicitFunction()->FunctionValue(p) - value));
    read = std::max(read, std::abs(saved->FunctionValue(p) - value));
  }
  const double shift = vtkMath::Norm(transform->GetPosition());
  checks.AtMost(place / (length + shift), 1e-14, what + ": places of the samples");
  checks.AtMost(gradient, Tolerance, what + ": gradients");
  checks.AtMost(between / LargestValue(f), Tolerance, what + ": function");
  checks.AtMost(read / LargestValue(f), Tolerance, what + ": function of the saved lattice");
}

vtkSmartPointer<vtkPolyData> Reconstruct(const OrientedPoints& cloud)
{
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(ipiatest::ToPolyData(cloud));
  reconstruction->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  reconstruction->Update();
  return reconstruction->GetOutput();
}

void CheckSameCurve(
  Checks& checks, const OrientedPoints& cloud, vtkTransform* transform, const std::string& what)
{
  auto expected = Reconstruct(cloud);
  auto curve = Reconstruct(Moved(cloud, transform));
  checks.That(expected->GetNumberOfPoints() > 100, what + ": the curve has points");
  if (!checks.Equal(curve->GetNumberOfPoints(), expected->GetNumberOfPoints(), what + ": vertices"))
  {
    return;
  }
  checks.Equal(curve->GetNumberOfLines(), expected->GetNumberOfLines(), what + ": polylines");
  double place = 0, normal = 0;
  for (vtkIdType i = 0; i < curve->GetNumberOfPoints(); ++i)
  {
    double x[3], n[3];
    transform->TransformPoint(expected->GetPoint(i), x);
    place = std::max(place, std::sqrt(vtkMath::Distance2BetweenPoints(x, curve->GetPoint(i))));
    transform->TransformVector(expected->GetPointData()->GetNormals()->GetTuple3(i), n);
    for (int a = 0; a < 3; ++a)
    {
      normal =
        std::max(normal, std::abs(n[a] - curve->GetPointData()->GetNormals()->GetComponent(i, a)));
    }
  }
  checks.AtMost(place / expected->GetLength(), Tolerance, what + ": vertices");
  checks.AtMost(normal, 1e-6, what + ": normals, of single precision");
}

/// The image stands in the plane for filters that know directions.
void CheckContour(Checks& checks, const OrientedPoints& cloud, vtkTransform* transform)
{
  auto fitter = Fit(Moved(cloud, transform), Method::Default);
  vtkNew<vtkFlyingEdges2D> contour;
  contour->SetInputData(fitter->GetOutput());
  contour->SetValue(0, 0);
  contour->Update();
  vtkPolyData* curve = contour->GetOutput();
  checks.That(curve->GetNumberOfPoints() > 100, "vtkFlyingEdges2D draws the curve");
  double farthest = 0;
  for (vtkIdType i = 0; i < curve->GetNumberOfPoints(); ++i)
  {
    farthest = std::max(
      farthest, std::abs(fitter->GetImplicitFunction()->FunctionValue(curve->GetPoint(i))));
  }
  checks.AtMost(farthest, ipiatest::KnotSpacing(fitter) / 4, "vtkFlyingEdges2D: |f| on the curve");
}

void CheckRefused(Checks& checks, const OrientedPoints& cloud)
{
  auto fitter = NewFitter(Method::Default, ipiatest::ToPolyData(cloud));
  fitter->SetModelBounds(-100, 100, -100, 100, -100, 100);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->Update();
  messages->CheckOneError(checks, "ModelBounds are a box along the axes", "bounds");
  checks.That(ipiatest::OutputsAreEmpty(fitter), "bounds: empty");
}
}

int TestImplicitFitterTiltedPlane(int, char*[])
{
  Checks checks;
  const OrientedPoints flower = ipiatest::PointsOn(ipiatest::Flower(), 300, 2, -1);
  OrientedPoints half; // whose curve is trimmed
  for (std::size_t k = 0; k < flower.Positions.size(); ++k)
  {
    if (flower.Positions[k][0] > 2)
    {
      half.Add(flower.Positions[k], flower.Normals[k]);
    }
  }
  for (const auto& [degrees, axis, shift] :
    { std::make_tuple(30., Vector3{ 1, 0, 0 }, 0.), std::make_tuple(-40., Vector3{ 1, 2, 0 }, 50.),
      std::make_tuple(44., Vector3{ 3, -1, 0 }, 0.) })
  {
    auto tilt = Tilt(degrees, axis, shift);
    for (Method method : ipiatest::Methods)
    {
      CheckSameFit(checks, flower, method, tilt, Text(NameOf(method), ", ", degrees, " degrees"));
    }
    CheckSameCurve(checks, flower, tilt, Text("curve, ", degrees, " degrees"));
    CheckSameCurve(checks, half, tilt, Text("open curve, ", degrees, " degrees"));
  }
  CheckContour(checks, flower, Tilt(30, { 1, 0, 0 }, 0));
  CheckRefused(checks, Moved(flower, Tilt(30, { 1, 0, 0 }, 0)));
  return checks.Result();
}
