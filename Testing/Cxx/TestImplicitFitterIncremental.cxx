// SPDX-License-Identifier: BSD-3-Clause
/**
 * With Incremental, points that come at the end of the input are added to the last fit; anything
 * else is fitted as by a new filter, bit for bit.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkDoubleArray.h"
#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"

#include <functional>

namespace
{
using ipiatest::Checks;
using ipiatest::OrientedPoints;
using ipiatest::Text;

constexpr int NumberOfPoints = 12000;
constexpr double CapHeight = 0.8; // of the unit sphere

/// The points of a sphere below or above a height.
OrientedPoints Part(bool cap)
{
  const OrientedPoints sphere = ipiatest::SpherePoints(NumberOfPoints);
  OrientedPoints part;
  for (std::size_t i = 0; i < sphere.Positions.size(); ++i)
  {
    if ((sphere.Positions[i][2] > CapHeight) == cap)
    {
      part.Add(sphere.Positions[i], sphere.Normals[i]);
    }
  }
  return part;
}

OrientedPoints Joined(OrientedPoints first, const OrientedPoints& second)
{
  first.Append(second);
  return first;
}

OrientedPoints WholeSphere()
{
  return Joined(Part(false), Part(true));
}

vtkIdType SizeOfCap()
{
  return static_cast<vtkIdType>(Part(true).Positions.size());
}

/// A fitter on a given lattice.
vtkSmartPointer<vtkIPIAImplicitFitter> NewFixedFitter(vtkDataObject* input, bool incremental)
{
  auto fitter = vtkSmartPointer<vtkIPIAImplicitFitter>::New();
  fitter->SetModelBounds(-1.2, 1.2, -1.2, 1.2, -1.2, 1.2);
  fitter->SetGridSize(99, 99, 99);
  fitter->SetIncremental(incremental);
  fitter->SetInputDataObject(0, input);
  return fitter;
}

/// Root mean square of the difference between two functions at and around the unit sphere, in
/// units of the longest side of the domain.
double Difference(vtkIPIAImplicitFitter* a, vtkIPIAImplicitFitter* b)
{
  const OrientedPoints sphere = ipiatest::SpherePoints(5000);
  const double* bounds = a->GetModelBoundsUsed();
  const double side = bounds[1] - bounds[0], h = side / (a->GetGridSizeUsed()[0] - 3);
  double sum = 0;
  int n = 0;
  for (const auto& direction : sphere.Normals)
  {
    for (int step = -2; step <= 2; ++step)
    {
      double x[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        x[axis] = (1 + step * h) * direction[axis];
      }
      const double d =
        a->GetImplicitFunction()->FunctionValue(x) - b->GetImplicitFunction()->FunctionValue(x);
      sum += d * d;
      ++n;
    }
  }
  return std::sqrt(sum / n) / side;
}

void CheckAddition(Checks& checks, vtkIPIAImplicitFitter* fitter, const std::string& what)
{
  auto full = NewFixedFitter(ipiatest::ToPolyData(WholeSphere()), false);
  full->Update();
  checks.Equal(fitter->GetNumberOfPointsAdded(), SizeOfCap(), what + ": points added");
  checks.Equal(full->GetNumberOfPointsAdded(), vtkIdType{ 0 }, "points added by a new filter");
  checks.That(3 * fitter->GetNumberOfCoefficientsSolved() < full->GetNumberOfCoefficientsSolved(),
    Text(what, ": solves for less than a third of ", full->GetNumberOfCoefficientsSolved(),
      " coefficients (", fitter->GetNumberOfCoefficientsSolved(), ")"));
  checks.AtMost(Difference(fitter, full), 1e-3, what + ": difference to the fit of all");
  checks.AtMost(std::abs(fitter->GetMaximumError()), 1e-3, what + ": maximum error");
  vtkDataArray* added = fitter->GetOutput()->GetFieldData()->GetArray("NumberOfPointsAdded");
  checks.That(added && added->GetTuple1(0) == static_cast<double>(SizeOfCap()),
    what + ": the field data have the number of points");
  vtkDataArray* solved =
    fitter->GetOutput()->GetFieldData()->GetArray("NumberOfCoefficientsSolved");
  checks.That(
    solved && solved->GetTuple1(0) == static_cast<double>(fitter->GetNumberOfCoefficientsSolved()),
    what + ": the field data have the number of coefficients");
  checks.Equal(ipiatest::FittedPoints(fitter)->GetNumberOfPoints(), vtkIdType{ NumberOfPoints },
    what + ": points of output 1");
}

void TestAppendedPoints(Checks& checks)
{
  auto fitter = NewFixedFitter(ipiatest::ToPolyData(Part(false)), true);
  fitter->Update();
  auto plain = NewFixedFitter(ipiatest::ToPolyData(Part(false)), false);
  plain->Update();
  checks.That(ipiatest::SameOutputs(fitter, plain), "a first fit is as without Incremental");
  fitter->SetInputData(ipiatest::ToPolyData(WholeSphere()));
  fitter->Update();
  CheckAddition(checks, fitter, "appended points");
  fitter->SetSampleDimensions(20, 20, 20);
  fitter->Update();
  checks.Equal(fitter->GetNumberOfPointsAdded(), SizeOfCap(), "points added, sampled again");
}

void TestAppendedBlock(Checks& checks)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, ipiatest::ToPolyData(Part(false)));
  auto fitter = NewFixedFitter(blocks, true);
  fitter->Update();
  blocks->SetBlock(1, ipiatest::ToPolyData(Part(true)));
  fitter->Update();
  CheckAddition(checks, fitter, "appended block");
}

void TestNothingAdded(Checks& checks)
{
  auto fitter = NewFixedFitter(ipiatest::ToPolyData(WholeSphere()), true);
  fitter->Update();
  auto plain = NewFixedFitter(ipiatest::ToPolyData(WholeSphere()), false);
  plain->Update();
  fitter->SetInputData(ipiatest::ToPolyData(WholeSphere()));
  fitter->Update();
  checks.Equal(fitter->GetNumberOfCoefficientsSolved(), vtkIdType{ 0 },
    "coefficients solved for, with the same points again");
  checks.That(ipiatest::SameArray(ipiatest::ControlLattice(fitter)->GetPointData()->GetScalars(),
                ipiatest::ControlLattice(plain)->GetPointData()->GetScalars()),
    "the same points again leave the coefficients as they are");
}

/// What makes a full fit.
struct Change
{
  const char* Name;
  std::function<void(vtkIPIAImplicitFitter*, vtkPolyData*)> Make;
};

void TestFullFits(Checks& checks)
{
  const Change changes[] = {
    { "a point moved",
      [](auto*, vtkPolyData* points)
      {
        double x[3];
        points->GetPoint(10, x);
        x[0] += 1e-9;
        points->GetPoints()->SetPoint(10, x);
      } },
    { "a normal turned",
      [](auto*, vtkPolyData* points)
      {
        vtkDataArray* normals = points->GetPointData()->GetNormals();
        normals->SetComponent(10, 0, normals->GetComponent(10, 0) + 1e-6);
      } },
    { "points in front",
      [](auto*, vtkPolyData* points)
      { points->DeepCopy(ipiatest::ToPolyData(Joined(Part(true), Part(false)))); } },
    { "points vanished",
      [](auto*, vtkPolyData* points) { points->DeepCopy(ipiatest::ToPolyData(Part(true))); } },
    { "weights",
      [](vtkIPIAImplicitFitter* fitter, vtkPolyData* points)
      {
        points->GetPointData()->AddArray(
          ipiatest::Constant("Weights", points->GetNumberOfPoints(), 0.5));
        fitter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Weights");
      } },
    { "another grid size",
      [](vtkIPIAImplicitFitter* fitter, auto*) { fitter->SetGridSize(90, 99, 99); } },
    { "other bounds",
      [](vtkIPIAImplicitFitter* fitter, auto*)
      { fitter->SetModelBounds(-1.2, 1.2, -1.2, 1.2, -1.2, 1.25); } },
    { "a lattice of its own",
      [](vtkIPIAImplicitFitter* fitter, auto*) { fitter->SetModelBounds(0, -1, 0, -1, 0, -1); } },
    { "a fairing weight",
      [](vtkIPIAImplicitFitter* fitter, auto*) { fitter->SetFairingWeight(1e-3); } },
    { "a number of iterations",
      [](vtkIPIAImplicitFitter* fitter, auto*) { fitter->SetMaximumNumberOfIterations(9); } },
    { "a number of levels",
      [](vtkIPIAImplicitFitter* fitter, auto*) { fitter->SetNumberOfLevels(2); } },
    { "offset rows",
      [](vtkIPIAImplicitFitter* fitter, auto*) { fitter->SetNormalConstraintToTwoSidedOffset(); } },
    { "the classic method",
      [](vtkIPIAImplicitFitter* fitter, auto*)
      {
        fitter->SetNormalConstraintToTwoSidedOffset();
        fitter->SetNumberOfLevels(1);
      } },
    { "extra rows",
      [](vtkIPIAImplicitFitter* fitter, auto*)
      {
        OrientedPoints inside;
        inside.Add({ 0, 0, 0 }, { 0, 0, 1 });
        auto rows = ipiatest::ToPolyData(inside);
        vtkNew<vtkDoubleArray> value;
        value->InsertNextValue(-1);
        rows->GetPointData()->SetScalars(value);
        fitter->SetExtraRowsData(rows);
      } },
  };
  for (const Change& change : changes)
  {
    auto fitter = NewFixedFitter(ipiatest::ToPolyData(Part(false)), true);
    fitter->Update();
    auto points = ipiatest::ToPolyData(WholeSphere());
    change.Make(fitter, points);
    fitter->SetInputData(points);
    fitter->Update();
    auto fresh = NewFixedFitter(ipiatest::ToPolyData(WholeSphere()), false);
    auto samePoints = ipiatest::ToPolyData(WholeSphere());
    change.Make(fresh, samePoints);
    fresh->SetInputData(samePoints);
    fresh->Update();
    checks.Equal(
      fitter->GetNumberOfPointsAdded(), vtkIdType{ 0 }, Text(change.Name, ": points added"));
    checks.That(ipiatest::OutputsAreSound(fitter), Text(change.Name, ": outputs are sound"));
    checks.That(
      ipiatest::SameOutputs(fitter, fresh), Text(change.Name, ": as fitted by a new filter"));
  }
}

void TestAutomaticDomain(Checks& checks)
{
  // The domain of the points without the cap is smaller.
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->IncrementalOn();
  fitter->SetInputData(ipiatest::ToPolyData(Part(false)));
  fitter->Update();
  fitter->SetInputData(ipiatest::ToPolyData(WholeSphere()));
  fitter->Update();
  checks.Equal(
    fitter->GetNumberOfPointsAdded(), vtkIdType{ 0 }, "points added to a domain that grows");
}

void TestForgetting(Checks& checks)
{
  auto fitter = NewFixedFitter(ipiatest::ToPolyData(Part(false)), true);
  fitter->Update();
  fitter->IncrementalOff();
  fitter->Update();
  fitter->IncrementalOn();
  fitter->SetInputData(ipiatest::ToPolyData(WholeSphere()));
  fitter->Update();
  checks.Equal(
    fitter->GetNumberOfPointsAdded(), vtkIdType{ 0 }, "points added, turned off in between");

  fitter->SetInputData(ipiatest::ToPolyData(Part(false)));
  fitter->Update();
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->SetInputData(vtkSmartPointer<vtkPolyData>::New());
  fitter->Update();
  checks.That(ipiatest::OutputsAreEmpty(fitter), "no points, no outputs");
  fitter->SetInputData(ipiatest::ToPolyData(WholeSphere()));
  fitter->Update();
  checks.Equal(fitter->GetNumberOfPointsAdded(), vtkIdType{ 0 }, "points added after an error");
}

void TestInPlane(Checks& checks)
{
  const auto circle = ipiatest::PointsOn(ipiatest::Circle(1), 600);
  OrientedPoints half;
  for (std::size_t i = 0; i < 400; ++i)
  {
    half.Add(circle.Positions[i], circle.Normals[i]);
  }
  const auto make = [&](bool incremental, const OrientedPoints& points)
  {
    auto fitter = NewFixedFitter(ipiatest::ToPolyData(points), incremental);
    fitter->SetGridSize(131, 131, 1);
    return fitter;
  };
  auto fitter = make(true, half);
  fitter->Update();
  fitter->SetInputData(ipiatest::ToPolyData(circle));
  fitter->Update();
  auto full = make(false, circle);
  full->Update();
  checks.Equal(fitter->GetNumberOfPointsAdded(), vtkIdType{ 200 }, "points added in the plane");
  double worst = 0;
  for (const auto& position : circle.Positions)
  {
    double x[3] = { position[0], position[1], position[2] };
    worst = std::max(worst,
      std::abs(fitter->GetImplicitFunction()->FunctionValue(x) -
        full->GetImplicitFunction()->FunctionValue(x)));
  }
  checks.AtMost(worst, 1e-4, "largest difference in the plane");
}

void TestSurface(Checks& checks)
{
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  vtkIPIAImplicitFitter* fitter = reconstruction->GetFitter();
  fitter->IncrementalOn();
  fitter->SetModelBounds(-1.2, 1.2, -1.2, 1.2, -1.2, 1.2);
  fitter->SetGridSize(99, 99, 99);
  reconstruction->SetInputData(ipiatest::ToPolyData(Part(false)));
  reconstruction->Update();
  reconstruction->SetInputData(ipiatest::ToPolyData(WholeSphere()));
  reconstruction->Update();
  vtkPolyData* surface = reconstruction->GetOutput();
  checks.Equal(fitter->GetNumberOfPointsAdded(), SizeOfCap(), "points added to a surface");
  double worst = 0;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    worst = std::max(worst, std::abs(vtkMath::Norm(surface->GetPoint(i)) - 1));
  }
  checks.AtMost(worst, 1e-3, "distance of the surface from the sphere");
  const ipiatest::Topology topology = ipiatest::TopologyOf(surface);
  checks.Equal(topology.Components, 1, "components of the surface");
  checks.Equal(topology.Genus, 0, "handles of the surface");
}
}

int TestImplicitFitterIncremental(int, char*[])
{
  Checks checks;
  TestAppendedPoints(checks);
  TestAppendedBlock(checks);
  TestNothingAdded(checks);
  TestFullFits(checks);
  TestAutomaticDomain(checks);
  TestForgetting(checks);
  TestInPlane(checks);
  TestSurface(checks);
  return checks.Result();
}
