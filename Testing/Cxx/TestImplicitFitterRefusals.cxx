// SPDX-License-Identifier: BSD-3-Clause
/**
 * What cannot be fitted is refused with one error that names the cause, and leaves nothing on any
 * port: at first, after a good run, and with a contour filter downstream; by the classic and the
 * default method, and by the reconstruction in one step.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkFlyingEdges3D.h"
#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkMultiBlockDataSet.h"

#include <chrono>
#include <functional>
#include <limits>
#include <utility>

namespace
{
using ipiatest::Checks;
using ipiatest::Constant;
using ipiatest::Method;
using ipiatest::OrientedPoints;
using ipiatest::SphereCloud;
using ipiatest::ToPolyData;

/// Sets what is refused: @a algorithm takes inputs and the choice of arrays, @a fitter parameters.
/// They differ where the fitter is part of a reconstruction.
using Setup = std::function<void(vtkAlgorithm* algorithm, vtkIPIAImplicitFitter* fitter)>;

/// Sets nothing.
void NoSetup(vtkAlgorithm*, vtkIPIAImplicitFitter*)
{
}

void ChooseWeights(vtkAlgorithm* algorithm, vtkIPIAImplicitFitter*)
{
  algorithm->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Weight");
}

void CheckNothingLeft(Checks& checks, vtkIPIAImplicitFitter* fitter, const std::string& what)
{
  checks.That(ipiatest::OutputsAreEmpty(fitter), what + ": all outputs are empty");
  checks.That(!fitter->GetImplicitFunction()->HasControlLattice(), what + ": no function is left");
  checks.Equal(fitter->GetNumberOfIterationsUsed(), 0, what + ": iterations");
  checks.Equal(fitter->GetEnergy(), 0.0, what + ": energy");
}

/**
 * @param input   what is refused, by itself or with
 * @param setup   these parameters
 * @param phrase  a part of the message
 */
void CheckRefusedByFitter(Checks& checks, Method method, const std::string& cause,
  vtkDataObject* input, const std::string& phrase, const Setup& setup)
{
  const std::string what = cause + ", " + NameOf(method);
  vtkNew<ipiatest::MessageObserver> messages;

  auto alone = NewFitter(method, input);
  setup(alone, alone);
  messages->Watch(alone);
  const auto start = std::chrono::steady_clock::now();
  alone->Update();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  messages->CheckOneError(checks, phrase, what);
  CheckNothingLeft(checks, alone, what);
  checks.AtMost(took.count(), 5, what + ": seconds until the refusal");
  alone->Update();
  CheckNothingLeft(checks, alone, what + ", updated again");
  messages->Clear();

  auto again = NewFitter(method, SphereCloud(), 12);
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputConnection(again->GetOutputPort());
  surface->SetValue(0, 0.0);
  surface->Update();
  checks.That(surface->GetOutput()->GetNumberOfPoints() > 0, "the good run has a surface");
  again->SetGridSize(0, 0, 0);
  again->SetInputDataObject(0, input);
  setup(again, again);
  messages->Watch(again);
  // vtkFlyingEdges3D reports itself that an image without scalars cannot be contoured.
  vtkNew<ipiatest::MessageObserver> downstream;
  downstream->Watch(surface);
  surface->Update();
  messages->CheckOneError(checks, phrase, what + ", after a good run");
  CheckNothingLeft(checks, again, what + ", after a good run");
  checks.Equal(
    surface->GetOutput()->GetNumberOfPoints(), vtkIdType(0), what + ": points downstream");
}

/// The one message reaches an observer of the reconstruction, or else the output window; no filter
/// within it has one of its own.
void CheckRefusedByReconstruction(Checks& checks, const std::string& cause, vtkDataObject* input,
  const std::string& phrase, const Setup& setup)
{
  const std::string what = cause + ", reconstruction";
  vtkNew<ipiatest::MessageObserver> messages, window;
  const ipiatest::WindowWatch watch(window);
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(SphereCloud());
  reconstruction->GetFitter()->SetGridSize(12, 12, 12);
  messages->Watch(reconstruction);
  reconstruction->Update();
  messages->CheckSilence(checks, what + ": good run");
  checks.That(reconstruction->GetOutput()->GetNumberOfPolys() > 0, "the good run has a surface");

  reconstruction->GetFitter()->SetGridSize(0, 0, 0);
  reconstruction->SetInputDataObject(0, input);
  setup(reconstruction, reconstruction->GetFitter());
  reconstruction->Update();
  messages->CheckOneError(checks, phrase, what);
  window->CheckSilence(checks, what + ": output window");
  checks.That(ipiatest::IsEmpty(reconstruction->GetOutput()), what + ": the output is empty");
  CheckNothingLeft(checks, reconstruction->GetFitter(), what + ", fitter");

  vtkNew<vtkIPIASurfaceReconstruction> unobserved;
  unobserved->SetInputDataObject(0, input);
  setup(unobserved, unobserved->GetFitter());
  unobserved->Update();
  window->CheckOneError(checks, phrase, what + ", unobserved");
  checks.That(ipiatest::IsEmpty(unobserved->GetOutput()), what + ", unobserved: empty");
}

void CheckRefused(Checks& checks, const std::string& what, vtkDataObject* input,
  const std::string& phrase, const Setup& setup = NoSetup)
{
  for (Method method : ipiatest::Methods)
  {
    CheckRefusedByFitter(checks, method, what, input, phrase, setup);
  }
  CheckRefusedByReconstruction(checks, what, input, phrase, setup);
}

void TestNoPoints(Checks& checks)
{
  vtkNew<vtkPolyData> nothing;
  CheckRefused(checks, "no vtkPoints", nothing, "The input has no points");
  CheckRefused(checks, "no points", ToPolyData({}), "The input has no points");
  vtkNew<vtkMultiBlockDataSet> blocks;
  CheckRefused(checks, "no blocks", blocks, "The input has no points");
}

void TestNoUsablePoint(Checks& checks)
{
  OrientedPoints cloud;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  cloud.Add({ nan, 0, 0 }, { 1, 0, 0 });
  cloud.Add({ 0, nan, 0 }, { 1, 0, 0 });
  CheckRefused(checks, "only NaN points", ToPolyData(cloud), "None of the 2 points has finite");
}

void TestOnePoint(Checks& checks)
{
  OrientedPoints cloud;
  cloud.Add({ 1, 2, 3 }, { 1, 0, 0 });
  CheckRefused(checks, "one point", ToPolyData(cloud), "one usable point");
}

void TestNoNormals(Checks& checks)
{
  auto cloud = SphereCloud();
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(cloud->GetPoints());
  CheckRefused(checks, "no normals", bare, "The input has no point normals");
}

void TestWrongComponentCount(Checks& checks)
{
  auto cloud = SphereCloud();
  cloud->GetPointData()->AddArray(Constant("Pairs", cloud->GetNumberOfPoints(), 1, 2));
  CheckRefused(checks, "normals of two components", cloud, "has 2 components",
    [](vtkAlgorithm* algorithm, auto*) {
      algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Pairs");
    });
}

void TestTooFewNormals(Checks& checks)
{
  auto cloud = SphereCloud();
  cloud->GetPointData()->GetNormals()->SetNumberOfTuples(10);
  CheckRefused(checks, "fewer normals than points", cloud, "10 tuples for 600 points");
}

void TestZeroNormals(Checks& checks)
{
  auto cloud = SphereCloud();
  cloud->GetPointData()->GetNormals()->Fill(0);
  CheckRefused(checks, "zero normals", cloud, "All 600 normals are zero");
}

void TestWeights(Checks& checks)
{
  auto cloud = SphereCloud();
  cloud->GetPointData()->AddArray(Constant("Weight", cloud->GetNumberOfPoints(), 1, 2));
  CheckRefused(
    checks, "weights of two components", cloud, "row weights has 2 components", ChooseWeights);

  auto few = SphereCloud();
  few->GetPointData()->AddArray(Constant("Weight", 10, 1));
  CheckRefused(checks, "fewer weights than points", few, "10 tuples for 600 points", ChooseWeights);

  auto none = SphereCloud();
  none->GetPointData()->AddArray(Constant("Weight", none->GetNumberOfPoints(), 0));
  CheckRefused(checks, "zero weights", none, "All 600 row weights are zero", ChooseWeights);
}

void TestEqualPoints(Checks& checks)
{
  OrientedPoints cloud;
  for (int i = 0; i < 5; ++i)
  {
    cloud.Add({ 1, 2, 3 }, { i + 1., 1, 0 });
  }
  CheckRefused(checks, "equal points", ToPolyData(cloud), "All 5 points are equal");
}

void TestCollinearPoints(Checks& checks)
{
  OrientedPoints slanted, along;
  for (int i = 0; i < 50; ++i)
  {
    slanted.Add({ 1. * i, 2. * i, 3. * i }, { 3, 0, -1 });
    along.Add({ 1. * i, 2, 3 }, { 0, 1, i % 2 - 0.5 });
  }
  CheckRefused(checks, "slanted line", ToPolyData(slanted), "All 50 points lie on a line");
  CheckRefused(checks, "line along x", ToPolyData(along), "All 50 points lie on a line");
}

void TestGridSize(Checks& checks)
{
  CheckRefused(checks, "grid size 3", SphereCloud(), "GridSize is 3 along axis 1",
    [](auto*, auto* fitter) { fitter->SetGridSize(10, 3, 10); });
  CheckRefused(checks, "negative grid size", SphereCloud(), "GridSize is -1 along axis 2",
    [](auto*, auto* fitter) { fitter->SetGridSize(10, 10, -1); });
}

void TestSampleDimensions(Checks& checks)
{
  CheckRefused(checks, "one sample", SphereCloud(), "SampleDimensions is 1 along axis 0",
    [](auto*, auto* fitter) { fitter->SetSampleDimensions(1, 10, 10); });
  CheckRefused(checks, "negative samples", SphereCloud(), "SampleDimensions is -5 along axis 0",
    [](auto*, auto* fitter) { fitter->SetSampleDimensions(-5, 10, 10); });
}

void TestSizesBeyondMemory(Checks& checks)
{
  CheckRefused(checks, "GridSize 20000^3", SphereCloud(), "GiB of memory",
    [](auto*, auto* fitter) { fitter->SetGridSize(20000, 20000, 20000); });
  CheckRefused(checks, "SampleDimensions 100000^3", SphereCloud(), "GiB of memory",
    [](auto*, auto* fitter) { fitter->SetSampleDimensions(100000, 100000, 100000); });
  CheckRefused(checks, "largest GridSize", SphereCloud(), "GiB of memory",
    [](auto*, auto* fitter) { fitter->SetGridSize(VTK_INT_MAX, VTK_INT_MAX, VTK_INT_MAX); });
  CheckRefused(checks, "largest SampleDimensions", SphereCloud(), "GiB of memory",
    [](auto*, auto* fitter)
    { fitter->SetSampleDimensions(VTK_INT_MAX, VTK_INT_MAX, VTK_INT_MAX); });
  CheckRefused(checks, "Padding 1e5", SphereCloud(), "GiB of memory",
    [](auto*, auto* fitter) { fitter->SetPadding(1e5); });
  CheckRefused(checks, "Padding 1e12", SphereCloud(), "Padding is 1e+12",
    [](auto*, auto* fitter) { fitter->SetPadding(1e12); });
  CheckRefused(checks, "largest Padding", SphereCloud(), "Padding is 1",
    [](auto*, auto* fitter) { fitter->SetPadding(VTK_DOUBLE_MAX); });
  for (double padding : { 1e300, std::numeric_limits<double>::quiet_NaN() })
  {
    CheckRefused(checks, ipiatest::Text("Padding ", padding, " with GridSize"), SphereCloud(),
      "Padding is ",
      [=](auto*, auto* fitter)
      {
        fitter->SetPadding(padding);
        fitter->SetGridSize(10, 10, 10);
      });
  }
  CheckRefused(checks, "bounds 1e300", SphereCloud(), "times as long as the points",
    [](auto*, auto* fitter)
    { fitter->SetModelBounds(-1e300, 1e300, -1e300, 1e300, -1e300, 1e300); });
}

void TestBounds(Checks& checks)
{
  CheckRefused(checks, "bounds without points", SphereCloud(), "None of the points lies in",
    [](auto*, auto* fitter) { fitter->SetModelBounds(5, 6, 5, 6, 5, 6); });
  CheckRefused(checks, "bounds empty along y", SphereCloud(), "empty or not finite along axis 1",
    [](auto*, auto* fitter) { fitter->SetModelBounds(-2, 2, 1, -1, -2, 2); });
  CheckRefused(checks, "bounds without length along z", SphereCloud(),
    "empty or not finite along axis 2",
    [](auto*, auto* fitter) { fitter->SetModelBounds(-2, 2, -2, 2, 1, 1); });
  CheckRefused(checks, "infinite bounds", SphereCloud(), "empty or not finite along axis 0",
    [](auto*, auto* fitter) { fitter->SetModelBounds(-HUGE_VAL, 2, -2, 2, -2, 2); });
}

/// What is left in the bounds cannot be fitted.
void TestLittleInBounds(Checks& checks)
{
  const auto bounds = [](auto*, auto* fitter) { fitter->SetModelBounds(4, 6, 4, 6, 4, 6); };
  OrientedPoints cloud = ipiatest::SpherePoints(600);
  cloud.Add({ 5, 5, 5 }, { 0, 0, 1 });
  CheckRefused(
    checks, "bounds with one point", ToPolyData(cloud), "Only one point lies in", bounds);
  cloud.Append(ipiatest::SpherePoints(20, 0.5, { 5, 5, 5 }));
  auto zero = ToPolyData(cloud);
  auto weightless = ToPolyData(cloud);
  vtkNew<vtkDoubleArray> weights;
  weights->SetName("Weight");
  for (vtkIdType i = 0; i < 621; ++i)
  {
    weights->InsertNextValue(i < 600);
    if (i >= 600)
    {
      zero->GetPointData()->GetNormals()->SetTuple3(i, 0, 0, 0);
    }
  }
  weightless->GetPointData()->AddArray(weights);
  CheckRefused(
    checks, "bounds without normals", zero, "All normals are zero or not finite in", bounds);
  CheckRefused(checks, "bounds without weights", weightless, "All row weights are zero in",
    [&](auto* algorithm, auto* fitter)
    {
      bounds(algorithm, fitter);
      ChooseWeights(algorithm, fitter);
    });
}

void TestDimension(Checks& checks)
{
  const auto planar = [](auto*, auto* fitter) { fitter->SetDimension(2); };
  CheckRefused(checks, "2-D for a sphere", SphereCloud(), "do not lie in a plane", planar);
  OrientedPoints plane;
  for (int i = 0; i < 100; ++i)
  {
    plane.Add({ i % 10 * 1., i / 10 * 1., 0 }, { 0, 0, 1 });
  }
  CheckRefused(checks, "2-D with normals across", ToPolyData(plane),
    "normals point out of the plane of the points (along axis 2)", planar);
}

void TestExtraRowsWithoutValues(Checks& checks)
{
  CheckRefused(checks, "extra rows without values", SphereCloud(),
    "The extra rows (input port 1) have no target values",
    [](vtkAlgorithm* algorithm, auto*) { algorithm->SetInputDataObject(1, SphereCloud(10, 0.5)); });
}

void TestDivergence(Checks& checks)
{
  // The default method has no step.
  CheckRefusedByFitter(checks, Method::Classic, "diverging step", SphereCloud(),
    "diverges with StepSize 1000", [](auto*, auto* fitter) { fitter->SetStepSize(1000); });
}

/// All offset rows leave the domain, by the classic method and in the hierarchy.
void TestOffsetsOutside(Checks& checks)
{
  CheckRefused(checks, "offsets outside the domain", SphereCloud(),
    "No offset row lies in the domain",
    [](auto*, auto* fitter)
    {
      fitter->SetNormalConstraintToOutwardOffset();
      fitter->SetOffsetDistance(5);
    });
}

void TestNumbersThatAreNone(Checks& checks)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Set = void (vtkIPIAImplicitFitter::*)(double);
  const std::pair<const char*, Set> numbers[] = {
    { "OffsetDistance is nan", &vtkIPIAImplicitFitter::SetOffsetDistance },
    { "OffsetValue is nan", &vtkIPIAImplicitFitter::SetOffsetValue },
    { "InwardOffsetDistance is nan", &vtkIPIAImplicitFitter::SetInwardOffsetDistance },
    { "InwardOffsetValue is nan", &vtkIPIAImplicitFitter::SetInwardOffsetValue },
    { "FairingWeight is nan", &vtkIPIAImplicitFitter::SetFairingWeight },
    { "Tolerance is nan", &vtkIPIAImplicitFitter::SetTolerance },
    { "StepSize is nan", &vtkIPIAImplicitFitter::SetStepSize },
  };
  for (const auto& [phrase, set] : numbers)
  {
    CheckRefused(checks, phrase, SphereCloud(), phrase,
      [&, member = set](auto*, auto* fitter) { (fitter->*member)(nan); });
  }
}

/// Beyond what a fit can make sense of. Setters take infinity for the largest number.
void TestNumbersOutOfReach(Checks& checks)
{
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : { 1e30, 1e100, 1e300, infinity })
  {
    CheckRefused(checks, "FairingWeight", SphereCloud(), "FairingWeight is 1e+",
      [=](auto*, auto* fitter) { fitter->SetFairingWeight(value); });
    CheckRefused(checks, "Padding", SphereCloud(), "Padding is 1e+",
      [=](auto*, auto* fitter) { fitter->SetPadding(value); });
  }
  for (const double value : { 1., 1e100, 1e300, infinity })
  {
    CheckRefused(checks, "Tolerance", SphereCloud(), "nothing is iterated",
      [=](auto*, auto* fitter) { fitter->SetTolerance(value); });
  }
  // The other rule has a unit, in which any number may be right.
  auto fitter = NewFitter(Method::Default, SphereCloud(), 12);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->SetStoppingRuleToEnergyChange();
  fitter->SetTolerance(1e100);
  fitter->Update();
  messages->CheckSilence(checks, "Tolerance of EnergyChange");
  checks.That(ipiatest::OutputsAreSound(fitter), "Tolerance of EnergyChange: outputs are finite");
}

/// Weights that are named and not there; "" and "None" name nothing.
void TestAbsentArrays(Checks& checks)
{
  for (const int index : { 1, 3 })
  {
    const auto choose = [index](const char* name)
    {
      return [=](vtkAlgorithm* algorithm, auto*) {
        algorithm->SetInputArrayToProcess(
          index, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
      };
    };
    const std::string what = index == 1 ? "row weights" : "local fairing weights";
    const std::string phrase = "The input has no array named \"Absent\" for the " + what;
    CheckRefused(checks, "absent " + what, SphereCloud(), phrase, choose("Absent"));
    vtkNew<vtkMultiBlockDataSet> blocks;
    blocks->SetBlock(0, SphereCloud());
    blocks->SetBlock(1, SphereCloud(50, 2));
    CheckRefused(checks, "absent " + what + " of blocks", blocks, phrase, choose("Absent"));
    for (const char* none : { "", "None" })
    {
      auto fitter = NewFitter(Method::Default, SphereCloud(), 12);
      vtkNew<ipiatest::MessageObserver> messages;
      messages->Watch(fitter);
      choose(none)(fitter, fitter.GetPointer());
      fitter->Update();
      messages->CheckSilence(checks, "no " + what);
      checks.That(ipiatest::OutputsAreSound(fitter), "no " + what + ": outputs are finite");
    }
  }
}

void TestBlockWithoutNormals(Checks& checks)
{
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(SphereCloud(50, 2)->GetPoints());
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, SphereCloud());
  blocks->SetBlock(1, bare);
  CheckRefused(
    checks, "block without normals", blocks, "Block 1 of the input has no point normals");
}

void TestBlockWithoutWeights(Checks& checks)
{
  auto weighted = SphereCloud();
  weighted->GetPointData()->AddArray(Constant("Weight", weighted->GetNumberOfPoints(), 2));
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, weighted);
  blocks->SetBlock(1, SphereCloud(50, 2));
  CheckRefused(checks, "block without weights", blocks,
    "Some blocks of the input have row weights and others not", ChooseWeights);
}
}

int TestImplicitFitterRefusals(int, char*[])
{
  Checks checks;
  TestNoPoints(checks);
  TestNoUsablePoint(checks);
  TestOnePoint(checks);
  TestNoNormals(checks);
  TestWrongComponentCount(checks);
  TestTooFewNormals(checks);
  TestZeroNormals(checks);
  TestWeights(checks);
  TestEqualPoints(checks);
  TestCollinearPoints(checks);
  TestGridSize(checks);
  TestSampleDimensions(checks);
  TestSizesBeyondMemory(checks);
  TestBounds(checks);
  TestLittleInBounds(checks);
  TestDimension(checks);
  TestExtraRowsWithoutValues(checks);
  TestDivergence(checks);
  TestOffsetsOutside(checks);
  TestNumbersThatAreNone(checks);
  TestNumbersOutOfReach(checks);
  TestAbsentArrays(checks);
  TestBlockWithoutNormals(checks);
  TestBlockWithoutWeights(checks);
  return checks.Result();
}
