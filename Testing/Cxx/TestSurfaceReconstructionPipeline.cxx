// SPDX-License-Identifier: BSD-3-Clause
/**
 * The reconstruction in a pipeline: one Update() at the end of a chain, changed input, parameters
 * and time steps, extra rows, weights, composite input, aborts, and images too coarse to show
 * anything. What it refuses and warns of is in TestImplicitFitterRefusals and ...Warnings.
 */
#include "IPIATestPipeline.h"

#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkTriangleFilter.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace
{
using ipiatest::Checks;
using ipiatest::SphereCloud;
using ipiatest::Text;

bool SameSurface(vtkPolyData* a, vtkPolyData* b)
{
  return a->GetNumberOfPoints() > 0 &&
    ipiatest::SameArray(a->GetPoints()->GetData(), b->GetPoints()->GetData()) &&
    ipiatest::SameArray(a->GetPointData()->GetNormals(), b->GetPointData()->GetNormals()) &&
    ipiatest::SameArray(
      a->GetPolys()->GetConnectivityArray(), b->GetPolys()->GetConnectivityArray());
}

vtkSmartPointer<vtkIPIASurfaceReconstruction> NewReconstruction(vtkDataObject* cloud)
{
  auto reconstruction = vtkSmartPointer<vtkIPIASurfaceReconstruction>::New();
  reconstruction->SetInputDataObject(cloud);
  return reconstruction;
}

void TestChain(Checks& checks)
{
  vtkNew<ipiatest::TimedSphere> source;
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkTriangleFilter> end;
  end->SetInputConnection(reconstruction->GetOutputPort());
  end->Update();
  ipiatest::CheckSphere(checks, end->GetOutput(), 1, 0, "one Update at the end of a chain");
  ipiatest::CheckTimeSteps(checks, source, reconstruction, end);
}

void TestSecondInput(Checks& checks)
{
  auto reused = NewReconstruction(SphereCloud());
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(reused);
  reused->Update();
  ipiatest::CheckSphere(checks, reused->GetOutput(), 1, 0, "first input");
  auto circle = ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Circle(1), 100));
  reused->SetInputData(circle);
  reused->Update();
  checks.Equal(reused->GetOutput()->GetNumberOfLines(), vtkIdType(1), "second input, a circle");
  auto third = SphereCloud(900, 50, { 1000, 0, 0 });
  reused->SetInputData(third);
  reused->Update();
  auto fresh = NewReconstruction(third);
  fresh->Update();
  checks.That(SameSurface(reused->GetOutput(), fresh->GetOutput()),
    "a third input gives what a new filter gives");
  for (vtkIdType i = 0; i < third->GetNumberOfPoints(); ++i)
  {
    double x[3];
    third->GetPoint(i, x);
    third->GetPoints()->SetPoint(i, x[0] - 1000, x[1], x[2]);
  }
  third->GetPoints()->Modified();
  reused->Update();
  ipiatest::CheckSphere(checks, reused->GetOutput(), 50, 0, "points edited in place");
  messages->CheckSilence(checks, "several inputs");
}

/// A change of the fitter's parameters, or of its own, is seen; without one nothing is done.
void TestWhatExecutes(Checks& checks)
{
  auto reconstruction = NewReconstruction(SphereCloud());
  reconstruction->Update();
  const auto executes = [&](const std::function<void()>& change)
  {
    const vtkMTimeType before = reconstruction->GetOutput()->GetMTime();
    change();
    reconstruction->Update();
    return reconstruction->GetOutput()->GetMTime() != before;
  };
  checks.That(!executes([] {}), "nothing changed: nothing is done");
  checks.That(!executes([] {}), "nothing changed, once more");
  checks.That(executes([&] { reconstruction->GetFitter()->SetGridSize(20, 20, 20); }),
    "a changed parameter of the fitter is seen");
  checks.Equal(reconstruction->GetFitter()->GetGridSizeUsed()[0], 20, "GridSize of the fitter");
  checks.That(executes([&] { reconstruction->ComponentFilterOff(); }), "ComponentFilter");
  checks.That(!executes([] {}), "nothing changed after that");
}

/// One holds bricks, the other all coefficients, in other precision.
void CheckSameFunction(
  Checks& checks, vtkIPIAImplicitFitter* one, vtkIPIAImplicitFitter* other, const std::string& what)
{
  double b[6];
  std::copy_n(other->GetModelBoundsUsed(), 6, b);
  double largest = 0, difference = 0;
  for (int k = 0; k < 1000; ++k)
  {
    double x[3];
    for (int a = 0; a < 3; ++a)
    {
      const double t = std::fmod(0.37 + k * std::sqrt(2. + 3 * a), 1.);
      x[a] = (1 - t) * b[2 * a] + t * b[2 * a + 1];
    }
    const double f = other->GetImplicitFunction()->EvaluateFunction(x);
    largest = std::max(largest, std::abs(f));
    difference =
      std::max(difference, std::abs(one->GetImplicitFunction()->EvaluateFunction(x) - f));
  }
  checks.That(largest > 0, what + ": f is not 0");
  checks.AtMost(difference / largest, 1e-6, what + ": the same function");
}

/// The results of the fitter stay, in field data too; the samples do not.
void TestResults(Checks& checks)
{
  auto reconstruction = NewReconstruction(SphereCloud());
  reconstruction->Update();
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputData(SphereCloud());
  fitter->Update();
  vtkIPIAImplicitFitter* inner = reconstruction->GetFitter();
  checks.Equal(inner->GetEnergy(), fitter->GetEnergy(), "Energy");
  CheckSameFunction(checks, inner, fitter, "function of the inner fitter");
  vtkFieldData* field = reconstruction->GetOutput()->GetFieldData();
  for (const char* name : { "Energy", "GridSizeUsed", "ResidualHistory" })
  {
    checks.That(ipiatest::SameArray(
                  field->GetArray(name), fitter->GetOutput()->GetFieldData()->GetArray(name)),
      Text("field data ", name));
  }
  std::ostringstream os;
  reconstruction->Print(os);
  for (const char* name :
    { "ComponentFilter: 1", "OutputPointsPrecision: 2", "NumberOfComponentsLeftOut: 0", "Fitter:" })
  {
    checks.That(os.str().find(name) != std::string::npos, Text("PrintSelf has ", name));
  }
}

/// Arrays are chosen on this filter as on the fitter, extra rows and composite inputs given so.
void TestInputs(Checks& checks)
{
  auto cloud = SphereCloud();
  vtkNew<vtkDoubleArray> weights, targets;
  weights->SetName("Weight");
  targets->SetName("Target");
  for (vtkIdType i = 0; i < 600; ++i)
  {
    weights->InsertNextValue(static_cast<double>(1 + i % 5));
  }
  auto direction = vtkSmartPointer<vtkDataArray>(cloud->GetPointData()->GetNormals());
  direction->SetName("Direction");
  cloud->GetPointData()->SetNormals(nullptr);
  cloud->GetPointData()->AddArray(direction);
  cloud->GetPointData()->AddArray(weights);
  auto rows = SphereCloud(50, 0.3);
  targets->SetNumberOfTuples(50);
  targets->Fill(-0.5);
  rows->GetPointData()->AddArray(targets);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, cloud);

  vtkNew<vtkIPIAImplicitFitter> fitter;
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  for (vtkAlgorithm* algorithm :
    { static_cast<vtkAlgorithm*>(fitter), static_cast<vtkAlgorithm*>(reconstruction) })
  {
    algorithm->SetInputDataObject(0, blocks);
    algorithm->SetInputDataObject(1, rows);
    const auto points = vtkDataObject::FIELD_ASSOCIATION_POINTS;
    algorithm->SetInputArrayToProcess(0, 0, 0, points, "Direction");
    algorithm->SetInputArrayToProcess(1, 0, 0, points, "Weight");
    algorithm->SetInputArrayToProcess(2, 1, 0, points, "Target");
  }
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(reconstruction);
  reconstruction->Update();
  fitter->Update();
  messages->CheckSilence(checks, "chosen arrays");
  CheckSameFunction(
    checks, reconstruction->GetFitter(), fitter, "chosen arrays, extra rows and a composite");
  double centre[3] = { 0, 0, 0.3 };
  checks.AtMost(
    std::abs(reconstruction->GetFitter()->GetImplicitFunction()->EvaluateFunction(centre) + 0.5),
    0.05, "f at the extra rows");
  ipiatest::CheckSphere(checks, reconstruction->GetOutput(), 1, 0, "chosen arrays");
}

/// Progress rises; an abort at any time leaves nothing. Until it is seen, the start of the filter,
/// of its fitter and of the fit may be reported.
void TestAbort(Checks& checks)
{
  vtkNew<vtkIPIASurfaceReconstruction> whole;
  whole->SetInputData(SphereCloud());
  vtkNew<ipiatest::ProgressObserver> all;
  whole->AddObserver(vtkCommand::ProgressEvent, all);
  whole->Update();
  all->CheckRise(checks, "progress of the reconstruction");

  for (double share : { 0.0, 0.04, 0.3, 0.57, 0.7, 0.85 })
  {
    auto reconstruction = NewReconstruction(SphereCloud());
    reconstruction->Update();
    vtkNew<ipiatest::ProgressObserver> progress;
    progress->AbortAt = share;
    const unsigned long tag = reconstruction->AddObserver(vtkCommand::ProgressEvent, progress);
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(reconstruction);
    reconstruction->GetFitter()->SetGridSize(24, 24, 24);
    reconstruction->Update();
    const std::string what = Text("abort at ", share);
    messages->CheckSilence(checks, what);
    checks.That(ipiatest::IsEmpty(reconstruction->GetOutput()), what + ": the output is empty");
    const auto late = std::count_if(progress->Values.begin(), progress->Values.end(),
      [&](double value) { return value >= share; });
    checks.AtMost(static_cast<double>(late), 3, what + ": reports after it");

    reconstruction->RemoveObserver(tag);
    reconstruction->Modified(); // VTK 9.1 takes an aborted filter for up to date
    reconstruction->Update();
    ipiatest::CheckSphere(checks, reconstruction->GetOutput(), 1, 0, what + ", then a whole run");
  }
}

/// Samples between which the surface hides, lattices of a single cell, two points: no crash, no
/// word of an inner filter, and nothing that is not finite.
void TestNothingToContour(Checks& checks)
{
  const auto circle = ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Circle(1), 100));
  ipiatest::OrientedPoints two;
  two.Add({ 0, 0, 0 }, { 0, 1, 0 });
  two.Add({ 1, 0, 0 }, { 0, 1, 0 });
  ipiatest::OrientedPoints three = two;
  three.Add({ 0, 1, 1 }, { 1, 0, 0 });
  const ipiatest::OrientedPoints twoInSpace = ipiatest::InPlane(two, 0, 2, 3);
  struct Case
  {
    std::string Name;
    vtkSmartPointer<vtkPolyData> Cloud;
    int GridSize, SampleDimensions;
  };
  const Case cases[] = { { "sphere, 2^3 samples", SphereCloud(), 0, 2 },
    { "circle, 2^2 samples", circle, 0, 2 }, { "sphere, 4^3 coefficients", SphereCloud(), 4, 0 },
    { "circle, 4^2 coefficients", circle, 4, 0 }, { "two points", ipiatest::ToPolyData(two), 0, 0 },
    { "two points across y", ipiatest::ToPolyData(twoInSpace), 0, 0 },
    { "three points in space", ipiatest::ToPolyData(three), 0, 0 } };
  for (const Case& c : cases)
  {
    auto reconstruction = NewReconstruction(c.Cloud);
    reconstruction->GetFitter()->SetGridSize(c.GridSize, c.GridSize, c.GridSize);
    reconstruction->GetFitter()->SetSampleDimensions(
      c.SampleDimensions, c.SampleDimensions, c.SampleDimensions);
    vtkNew<ipiatest::MessageObserver> messages, window;
    messages->Watch(reconstruction);
    const ipiatest::WindowWatch watch(window);
    reconstruction->Update();
    messages->CheckSilence(checks, c.Name);
    window->CheckSilence(checks, c.Name + ": output window");
    vtkPolyData* surface = reconstruction->GetOutput();
    checks.That(surface->GetPoints() && ipiatest::IsFinite(surface->GetPoints()->GetData()) &&
        ipiatest::IsFinite(surface->GetPointData()),
      c.Name + ": finite");
    checks.Equal(surface->GetNumberOfPoints() == 0, c.SampleDimensions == 2,
      Text(c.Name, ": without a point (", surface->GetNumberOfPoints(), ")"));
  }
}
}

int TestSurfaceReconstructionPipeline(int, char*[])
{
  Checks checks;
  TestChain(checks);
  TestSecondInput(checks);
  TestWhatExecutes(checks);
  TestResults(checks);
  TestInputs(checks);
  TestAbort(checks);
  TestNothingToContour(checks);
  return checks.Result();
}
