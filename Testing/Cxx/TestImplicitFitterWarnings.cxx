// SPDX-License-Identifier: BSD-3-Clause
/**
 * What can be left out is left out with one warning that counts it, and the rest is fitted: by the
 * classic and the default method, and by the reconstruction in one step.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkIPIASurfaceReconstruction.h"

#include <functional>
#include <limits>

namespace
{
using ipiatest::Checks;
using ipiatest::Method;
using ipiatest::SphereCloud;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// Sets what is to be warned of: @a algorithm takes inputs and the choice of arrays, @a fitter
/// parameters.
using Setup = std::function<void(vtkAlgorithm* algorithm, vtkIPIAImplicitFitter* fitter)>;

/// The warning comes once, @a fitted points are left, and the surface is one closed sphere.
void CheckWarnedByFitter(Checks& checks, Method method, const std::string& cause,
  vtkPolyData* cloud, const std::string& phrase, vtkIdType fitted, const Setup& setup)
{
  const std::string what = cause + ", " + NameOf(method);
  auto fitter = NewFitter(method, cloud, 16);
  setup(fitter, fitter);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->GenerateGradientOn();
  fitter->GenerateSupportOn();
  fitter->Update();
  messages->CheckOneWarning(checks, phrase, what);
  checks.Equal(
    ipiatest::FittedPoints(fitter)->GetNumberOfPoints(), fitted, what + ": fitted points");
  checks.That(ipiatest::OutputsAreSound(fitter), what + ": all outputs are finite");
  checks.Equal(
    ipiatest::TopologyOf(ipiatest::ZeroSurface(fitter)), ipiatest::Topology{ 1, 0, 0, 0 }, what);
  fitter->SetSampleDimensions(20, 20, 20);
  fitter->Update();
  messages->CheckSilence(checks, what + ", sampled again");
}

/// The warning reaches an observer of the reconstruction, or else the output window.
void CheckWarnedByReconstruction(Checks& checks, const std::string& cause, vtkPolyData* cloud,
  const std::string& phrase, const Setup& setup)
{
  for (bool observed : { true, false })
  {
    const std::string what =
      cause + (observed ? ", reconstruction" : ", reconstruction without observer");
    vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
    reconstruction->SetInputData(cloud);
    reconstruction->GetFitter()->SetGridSize(16, 16, 16);
    setup(reconstruction, reconstruction->GetFitter());
    vtkNew<ipiatest::MessageObserver> messages, window;
    if (observed)
    {
      messages->Watch(reconstruction);
    }
    const ipiatest::WindowWatch watch(window);
    reconstruction->Update();
    (observed ? messages : window)->CheckOneWarning(checks, phrase, what);
    (observed ? window : messages)->CheckSilence(checks, what);
    checks.Equal(
      ipiatest::TopologyOf(reconstruction->GetOutput()), ipiatest::Topology{ 1, 0, 0, 0 }, what);
    checks.That(ipiatest::IsFinite(reconstruction->GetOutput()->GetPoints()->GetData()) &&
        ipiatest::IsFinite(reconstruction->GetOutput()->GetPointData()),
      what + ": finite");
  }
}

void CheckWarned(Checks& checks, const std::string& what, vtkPolyData* cloud,
  const std::string& phrase, vtkIdType fitted, const Setup& setup)
{
  for (Method method : ipiatest::Methods)
  {
    CheckWarnedByFitter(checks, method, what, cloud, phrase, fitted, setup);
  }
  CheckWarnedByReconstruction(checks, what, cloud, phrase, setup);
}

void TestZeroNormals(Checks& checks)
{
  auto cloud = SphereCloud();
  for (vtkIdType i : { 3, 100, 599 })
  {
    cloud->GetPointData()->GetNormals()->SetTuple3(i, 0, 0, 0);
  }
  CheckWarned(checks, "zero normals", cloud, "Left out of the fit: 3 zero or non-finite normal(s)",
    600, [](auto*, auto*) {});
}

void TestNonFiniteNormals(Checks& checks)
{
  auto cloud = SphereCloud();
  cloud->GetPointData()->GetNormals()->SetTuple3(0, NaN, 0, 1);
  cloud->GetPointData()->GetNormals()->SetTuple3(7, 0, Infinity, 1);
  CheckWarned(
    checks, "NaN normals", cloud, "2 zero or non-finite normal(s)", 600, [](auto*, auto*) {});
}

void TestNonFinitePoints(Checks& checks)
{
  auto cloud = SphereCloud();
  cloud->GetPoints()->SetPoint(0, NaN, 0, 0);
  cloud->GetPoints()->SetPoint(1, 0, Infinity, 0);
  cloud->GetPoints()->SetPoint(2, 0, 0, -Infinity);
  cloud->GetPoints()->SetPoint(599, NaN, NaN, NaN);
  CheckWarned(
    checks, "NaN and infinite points", cloud, "4 non-finite point(s)", 596, [](auto*, auto*) {});
}

void TestWeights(Checks& checks)
{
  auto cloud = SphereCloud();
  auto weights = ipiatest::Constant("Weight", 600, 1);
  weights->SetValue(0, NaN);
  weights->SetValue(1, -1);
  weights->SetValue(2, Infinity);
  weights->SetValue(3, 0); // is allowed
  cloud->GetPointData()->AddArray(weights);
  CheckWarned(checks, "NaN, negative and infinite weights", cloud,
    "3 point(s) with a negative or non-finite weight", 597,
    [](vtkAlgorithm* algorithm, auto*) {
      algorithm->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Weight");
    });
}

void TestPointsOutsideBounds(Checks& checks)
{
  ipiatest::OrientedPoints cloud = ipiatest::SpherePoints(600);
  cloud.Append(ipiatest::SpherePoints(20, 0.1, { 5, 5, 5 }));
  CheckWarned(checks, "points outside ModelBounds", ipiatest::ToPolyData(cloud),
    "20 point(s) outside ModelBounds", 600,
    [](auto*, auto* fitter) { fitter->SetModelBounds(-1.3, 1.3, -1.3, 1.3, -1.3, 1.3); });
}

void TestNonFiniteExtraRows(Checks& checks)
{
  auto rows = SphereCloud(10, 0.2);
  auto values = ipiatest::Constant("Value", 10, -0.8);
  values->SetValue(4, NaN);
  rows->GetPointData()->SetScalars(values);
  rows->GetPoints()->SetPoint(5, Infinity, 0, 0);
  CheckWarned(checks, "NaN extra rows", SphereCloud(), "2 non-finite extra row(s)", 600,
    [&](auto* algorithm, auto*) { algorithm->SetInputDataObject(1, rows); });
}

/// Several causes share one warning.
void TestAllAtOnce(Checks& checks)
{
  auto cloud = SphereCloud();
  cloud->GetPoints()->SetPoint(0, NaN, 0, 0);
  cloud->GetPointData()->GetNormals()->SetTuple3(5, 0, 0, 0);
  CheckWarned(checks, "several causes", cloud,
    "Left out of the fit: 1 non-finite point(s), 1 zero or non-finite normal(s)", 599,
    [](auto*, auto*) {});
}

/// Half a sphere in a box around the whole of it has no two sides: the far field of the classic
/// method says so.
void TestOpenSurface(Checks& checks)
{
  ipiatest::OrientedPoints half;
  const auto sphere = ipiatest::SpherePoints(4000);
  for (std::size_t i = 0; i < sphere.Positions.size(); ++i)
  {
    if (sphere.Positions[i][2] > 0)
    {
      half.Add(sphere.Positions[i], sphere.Normals[i]);
    }
  }
  for (Method method : ipiatest::Methods)
  {
    const std::string what = "open surface, " + NameOf(method);
    auto fitter = NewFitter(method, ipiatest::ToPolyData(half), 32);
    fitter->SetModelBounds(-1.5, 1.5, -1.5, 1.5, -1.5, 1.5);
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(fitter);
    fitter->Update();
    if (method == Method::Classic)
    {
      messages->CheckOneWarning(checks, "which is open there or has wide holes", what);
    }
    else
    {
      // The hierarchy continues the surface.
      messages->CheckSilence(checks, what);
    }
    checks.That(ipiatest::OutputsAreSound(fitter), what + ": all outputs are finite");
  }
}
}

int TestImplicitFitterWarnings(int, char*[])
{
  Checks checks;
  TestZeroNormals(checks);
  TestNonFiniteNormals(checks);
  TestNonFinitePoints(checks);
  TestWeights(checks);
  TestPointsOutsideBounds(checks);
  TestNonFiniteExtraRows(checks);
  TestAllAtOnce(checks);
  TestOpenSurface(checks);
  return checks.Result();
}
