// SPDX-License-Identifier: BSD-3-Clause
/**
 * The point arrays of the input on the image and on the surface: their values, which of them, and
 * that f has nothing to do with them.
 */
#include "IPIATestColours.h"
#include "IPIATestPipeline.h"
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"

#include "vtkDataArraySelection.h"
#include "vtkDoubleArray.h"
#include "vtkFlyingEdges3D.h"
#include "vtkIdTypeArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <omp.h>

#include <functional>
#include <limits>

namespace
{
using ipiatest::Checks;
using ipiatest::Method;
using ipiatest::SphereCloud;
using ipiatest::Text;
using ipiatest::Vector3;

/// The value of a component at a position.
using Field = std::function<double(const Vector3& x, int component)>;

double Linear(const Vector3& x, int component)
{
  return 100 + 40 * x[static_cast<std::size_t>(component % 3)];
}

/// An array of a type with the values of a field at the points, the nearest where it is integral.
vtkSmartPointer<vtkDataArray> NewArray(
  vtkPolyData* cloud, const char* name, int type, int components, const Field& field)
{
  auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(cloud->GetNumberOfPoints());
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    Vector3 x;
    cloud->GetPoint(i, x.data());
    for (int c = 0; c < components; ++c)
    {
      const double value = field(x, c);
      const bool fraction = type == VTK_FLOAT || type == VTK_DOUBLE;
      array->SetComponent(i, c, fraction ? value : std::round(value));
    }
  }
  return array;
}

void AddArray(vtkPolyData* cloud, const char* name, int type, int components, const Field& field)
{
  cloud->GetPointData()->AddArray(NewArray(cloud, name, type, components, field));
}

/// The largest miss of a field, kept in a range.
double LargestMiss(vtkDataSet* data, const char* name, const Field& field, double low, double high)
{
  vtkDataArray* array = data->GetPointData()->GetArray(name);
  if (!array || array->GetNumberOfTuples() != data->GetNumberOfPoints() ||
    data->GetNumberOfPoints() == 0)
  {
    return HUGE_VAL;
  }
  double largest = 0;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    Vector3 x;
    data->GetPoint(i, x.data());
    for (int c = 0; c < array->GetNumberOfComponents(); ++c)
    {
      const double truth = std::min(std::max(field(x, c), low), high);
      const double miss = std::abs(array->GetComponent(i, c) - truth);
      largest = miss <= largest ? largest : miss;
    }
  }
  return largest;
}

/// The largest miss of a field, each component kept in the range of the values at the points.
double MissInRange(vtkDataSet* data, vtkPolyData* cloud, const char* name, const Field& field)
{
  vtkDataArray* given = cloud->GetPointData()->GetArray(name);
  return LargestMiss(
    data, name,
    [&](const Vector3& x, int c)
    {
      double range[2];
      given->GetRange(range, c);
      return std::min(std::max(field(x, c), range[0]), range[1]);
    },
    VTK_DOUBLE_MIN, VTK_DOUBLE_MAX);
}

vtkSmartPointer<vtkIPIASurfaceReconstruction> Reconstruct(vtkDataObject* cloud)
{
  auto reconstruction = vtkSmartPointer<vtkIPIASurfaceReconstruction>::New();
  reconstruction->SetInputDataObject(0, cloud);
  reconstruction->Update();
  return reconstruction;
}

/// Every type is kept. Integers miss by up to half for those given and half for those found.
void TestTypes(Checks& checks)
{
  const struct
  {
    const char* Name;
    int Type, Components;
    double Rounding;
  } arrays[] = { { "RGB", VTK_UNSIGNED_CHAR, 3, 1 }, { "char", VTK_SIGNED_CHAR, 1, 1 },
    { "short", VTK_SHORT, 4, 1 }, { "int", VTK_INT, 1, 1 }, { "long", VTK_LONG_LONG, 2, 1 },
    { "id", VTK_ID_TYPE, 1, 1 }, { "unsigned", VTK_UNSIGNED_LONG, 1, 1 },
    { "float", VTK_FLOAT, 9, 1e-5 }, { "double", VTK_DOUBLE, 3, 1e-6 * 80 } };
  const Field field = [](const Vector3& x, int c)
  { return 80 + 40 * x[static_cast<std::size_t>(c % 3)]; };
  for (Method method : ipiatest::Methods)
  {
    auto cloud = SphereCloud(900);
    for (const auto& array : arrays)
    {
      AddArray(cloud, array.Name, array.Type, array.Components, field);
    }
    vtkNew<vtkSOADataArrayTemplate<float>> columns;
    columns->DeepCopy(cloud->GetPointData()->GetArray("float"));
    columns->SetName("columns");
    columns->SetComponentName(1, "second");
    cloud->GetPointData()->AddArray(columns);
    cloud->GetPointData()->SetActiveScalars("RGB");

    auto fitter = ipiatest::NewFitter(method, cloud, 16);
    fitter->Update();
    auto reconstruction = vtkSmartPointer<vtkIPIASurfaceReconstruction>::New();
    reconstruction->SetInputData(cloud);
    if (method == Method::Classic)
    {
      reconstruction->GetFitter()->SetNumberOfLevels(1);
      reconstruction->GetFitter()->SetNormalConstraintToTwoSidedOffset();
    }
    reconstruction->Update();
    const auto check = [&](vtkDataSet* data, const std::string& what)
    {
      for (const auto& expected : arrays)
      {
        vtkDataArray* array = data->GetPointData()->GetArray(expected.Name);
        const std::string which = what + ", " + expected.Name;
        if (!checks.That(array != nullptr, which + " is there"))
        {
          continue;
        }
        checks.Equal(array->GetDataType(), expected.Type, which + ": type");
        checks.Equal(array->GetNumberOfComponents(), expected.Components, which + ": components");
        checks.AtMost(
          MissInRange(data, cloud, expected.Name, field), expected.Rounding, which + ": miss");
      }
      vtkDataArray* columns2 = data->GetPointData()->GetArray("columns");
      checks.That(columns2 && columns2->GetComponentName(1) &&
          std::string(columns2->GetComponentName(1)) == "second",
        what + ": name of a component");
      checks.That(ipiatest::SameArray(columns2, data->GetPointData()->GetArray("float")),
        what + ": columns are as rows");
    };
    check(fitter->GetOutput(), NameOf(method) + " image");
    check(reconstruction->GetOutput(), NameOf(method) + " surface");
    checks.Equal(std::string(fitter->GetOutput()->GetPointData()->GetScalars()->GetName()),
      std::string("f"), "active scalars of the image");
    vtkDataArray* active = reconstruction->GetOutput()->GetPointData()->GetScalars();
    checks.That(active && std::string(active->GetName()) == "RGB", "active scalars of the surface");
  }
}

/// A constant stays one, a linear function too, in its range.
void TestSimpleFields(Checks& checks)
{
  auto cloud = SphereCloud(2000);
  const Field constant = [](const Vector3&, int) { return 0.1; };
  AddArray(cloud, "constant", VTK_DOUBLE, 2, constant);
  AddArray(cloud, "linear", VTK_DOUBLE, 3, Linear);
  double range[2];
  cloud->GetPointData()->GetArray("linear")->GetRange(range, 2);
  auto fitter = ipiatest::NewFitter(Method::Default, cloud);
  fitter->Update();
  auto surface = Reconstruct(cloud);
  for (vtkDataSet* data : { static_cast<vtkDataSet*>(fitter->GetOutput()),
         static_cast<vtkDataSet*>(surface->GetOutput()) })
  {
    checks.Equal(
      LargestMiss(data, "constant", constant, -1, 1), 0., Text(data->GetClassName(), ": constant"));
    vtkDataArray* linear = data->GetPointData()->GetArray("linear");
    double found[2];
    linear->GetRange(found, 2);
    checks.That(found[0] >= range[0] && found[1] <= range[1],
      Text(data->GetClassName(), ": in the range of the values"));
    checks.AtMost(MissInRange(data, cloud, "linear", Linear), 1e-6 * 80,
      Text(data->GetClassName(), ": linear"));
  }
}

/// What the fit uses, ids, ghosts, strings and arrays without a name are no fields.
void TestDefaultChoice(Checks& checks)
{
  auto cloud = SphereCloud(600);
  const Field one = [](const Vector3&, int) { return 1; };
  AddArray(cloud, "weight", VTK_DOUBLE, 1, one);
  AddArray(cloud, "fairing", VTK_DOUBLE, 1, one);
  AddArray(cloud, "kept", VTK_DOUBLE, 1, Linear);
  AddArray(cloud, vtkDataSetAttributes::GhostArrayName(), VTK_UNSIGNED_CHAR, 1,
    [](const Vector3&, int) { return 0; });
  cloud->GetPointData()->SetGlobalIds(NewArray(cloud, "global", VTK_ID_TYPE, 1, Linear));
  cloud->GetPointData()->SetPedigreeIds(NewArray(cloud, "pedigree", VTK_INT, 1, Linear));
  vtkNew<vtkStringArray> names;
  names->SetName("names");
  names->SetNumberOfValues(cloud->GetNumberOfPoints());
  cloud->GetPointData()->AddArray(names);
  auto nameless = NewArray(cloud, "x", VTK_DOUBLE, 1, Linear);
  nameless->SetName(nullptr);
  cloud->GetPointData()->AddArray(nameless);
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(reconstruction);
  reconstruction->SetInputData(cloud);
  const int points = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  reconstruction->SetInputArrayToProcess(1, 0, 0, points, "weight");
  reconstruction->SetInputArrayToProcess(3, 0, 0, points, "fairing");
  reconstruction->Update();
  vtkPointData* data = reconstruction->GetOutput()->GetPointData();
  checks.Equal(data->GetNumberOfArrays(), 2, "arrays: normals and the one that is a field");
  checks.That(data->GetArray("kept") != nullptr, "the array that is a field is there");
  messages->CheckSilence(checks, "default choice");
}

/// Arrays are chosen by name, all can be turned off, and f is not fitted again for it.
void TestChoice(Checks& checks)
{
  auto cloud = SphereCloud(600);
  AddArray(cloud, "a", VTK_DOUBLE, 1, Linear);
  AddArray(cloud, "b", VTK_FLOAT, 2, Linear);
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(cloud);
  auto fitter = ipiatest::NewFitter(Method::Default, cloud, 16);
  const struct
  {
    vtkAlgorithm* Algorithm;
    vtkIPIAImplicitFitter* Fitter;
  } filters[] = { { reconstruction, reconstruction->GetFitter() }, { fitter, fitter } };
  for (const auto& filter : filters)
  {
    vtkDataArraySelection* selection = filter.Fitter->GetPointDataArraySelection();
    filter.Algorithm->Update();
    const vtkMTimeType fitted = filter.Fitter->GetImplicitFunction()->GetMTime();
    const auto arrays = [&]
    {
      filter.Algorithm->Update();
      vtkPointData* data =
        vtkDataSet::SafeDownCast(filter.Algorithm->GetOutputDataObject(0))->GetPointData();
      return Text(data->HasArray("a") ? "a" : "", data->HasArray("b") ? "b" : "");
    };
    const std::string what = filter.Algorithm->GetClassName();
    checks.Equal(arrays(), std::string("ab"), what + ": both by default");
    selection->DisableArray("a");
    checks.Equal(arrays(), std::string("b"), what + ": one disabled");
    selection->EnableArray("a");
    filter.Fitter->FitPointArraysOff();
    checks.Equal(arrays(), std::string(""), what + ": all off");
    filter.Fitter->FitPointArraysOn();
    selection->RemoveAllArrays();
    selection->SetUnknownArraySetting(0);
    checks.Equal(arrays(), std::string(""), what + ": none enabled");
    selection->EnableArray("b");
    selection->EnableArray("no such array");
    checks.Equal(arrays(), std::string("b"), what + ": one enabled");
    checks.Equal(
      filter.Fitter->GetImplicitFunction()->GetMTime(), fitted, what + ": f is the first fit");
  }
  reconstruction->ComponentFilterOff();
  const vtkMTimeType fitted = reconstruction->GetFitter()->GetImplicitFunction()->GetMTime();
  reconstruction->Update();
  checks.Equal(reconstruction->GetFitter()->GetImplicitFunction()->GetMTime(), fitted,
    "f is not fitted again for the component filter");
  AddArray(cloud, "b", VTK_FLOAT, 2, [](const Vector3&, int) { return 3; });
  reconstruction->Update();
  checks.Equal(LargestMiss(
                 reconstruction->GetOutput(), "b", [](const Vector3&, int) { return 3; }, 3, 3),
    0., "changed values are fitted");
}

/// f and the surface are the same bits with and without arrays.
void TestFIsUnchanged(Checks& checks)
{
  auto plain = SphereCloud(900), coloured = SphereCloud(900);
  AddArray(coloured, "a", VTK_DOUBLE, 3, Linear);
  auto a = ipiatest::NewFitter(Method::Default, plain, 16);
  auto b = ipiatest::NewFitter(Method::Default, coloured, 16);
  a->Update();
  b->Update();
  checks.That(ipiatest::SameOutputs(a, b), "f is the same with arrays");
  auto c = Reconstruct(plain), d = Reconstruct(coloured);
  checks.That(ipiatest::SameArray(
                c->GetOutput()->GetPoints()->GetData(), d->GetOutput()->GetPoints()->GetData()),
    "the surface is the same with arrays");
}

/// Arrays of blocks belong together by name; a block without one says nothing about it.
void TestComposite(Checks& checks)
{
  auto whole = SphereCloud(1800);
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (int part = 0; part < 3; ++part)
  {
    const auto sphere = ipiatest::SpherePoints(1800);
    ipiatest::OrientedPoints points;
    for (std::size_t i = static_cast<std::size_t>(part); i < sphere.Positions.size(); i += 3)
    {
      points.Add(sphere.Positions[i], sphere.Normals[i]);
    }
    auto block = ipiatest::ToPolyData(points);
    AddArray(block, "everywhere", part == 0 ? VTK_FLOAT : VTK_DOUBLE, 1, Linear);
    if (part == 1)
    {
      AddArray(block, "somewhere", VTK_DOUBLE, 1, Linear);
    }
    // Of another width: as if it was not there.
    AddArray(block, "width", VTK_DOUBLE, part == 2 ? 2 : 1,
      [part](const Vector3& x, int c) { return part == 2 ? -1e6 : Linear(x, c); });
    blocks->SetBlock(static_cast<unsigned>(part), block);
  }
  auto reconstruction = Reconstruct(blocks);
  vtkPolyData* surface = reconstruction->GetOutput();
  for (const char* name : { "everywhere", "somewhere", "width" })
  {
    checks.AtMost(LargestMiss(surface, name, Linear, 60.2, 139.8), 0.3, name);
  }
  vtkDataArray* everywhere = surface->GetPointData()->GetArray("everywhere");
  checks.That(everywhere && everywhere->GetDataType() == VTK_FLOAT, "type of the first block");
}

/// Values that are no numbers give no rows and one warning; so do arrays that nothing is left of.
void TestBadValues(Checks& checks)
{
  auto cloud = SphereCloud(900);
  constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
  AddArray(cloud, "holes", VTK_DOUBLE, 3, Linear);
  for (vtkIdType i = 0; i < 900; i += 10)
  {
    cloud->GetPointData()->GetArray("holes")->SetComponent(i, 1, NaN);
  }
  cloud->GetPointData()->GetArray("holes")->SetComponent(
    5, 0, std::numeric_limits<double>::infinity());
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(reconstruction);
  reconstruction->SetInputData(cloud);
  reconstruction->Update();
  messages->CheckOneWarning(checks, "91 of \"holes\"", "values that are not finite");
  checks.AtMost(
    LargestMiss(reconstruction->GetOutput(), "holes", Linear, 60.2, 139.8), 0.3, "holes");
  reconstruction->ComponentFilterOff();
  reconstruction->Update();
  messages->CheckSilence(checks, "the same arrays again");

  AddArray(cloud, "nothing", VTK_FLOAT, 1, [](const Vector3&, int) { return NaN; });
  cloud->GetPointData()->RemoveArray("holes");
  reconstruction->Update();
  messages->CheckOneWarning(checks, "\"nothing\" has no value", "an array without values");
  checks.That(!reconstruction->GetOutput()->GetPointData()->HasArray("nothing"), "it is left out");

  cloud->GetPointData()->RemoveArray("nothing");
  AddArray(cloud, "f", VTK_DOUBLE, 1, Linear);
  auto fitter = ipiatest::NewFitter(Method::Default, cloud, 16);
  messages->Watch(fitter);
  fitter->Update();
  messages->CheckOneWarning(checks, "\"f\" is left out", "an array named f");
  checks.AtMost(fitter->GetOutput()->GetPointData()->GetScalars()->GetRange()[1], 2., "f is f");

  // Refused for another reason, and for the memory that all of it would take.
  vtkNew<vtkPolyData> empty;
  reconstruction->SetInputData(empty);
  reconstruction->Update();
  messages->CheckOneError(checks, "no points", "empty input");
  checks.That(ipiatest::IsEmpty(reconstruction->GetOutput()), "empty input: empty output");
  fitter->SetSampleDimensions(20000, 20000, 20000);
  fitter->Update();
  messages->CheckOneError(checks, "choose fewer point arrays", "memory");
  checks.That(ipiatest::OutputsAreEmpty(fitter), "memory: empty outputs");
}

/// Points of weight 0 say nothing.
void TestWeights(Checks& checks)
{
  auto cloud = SphereCloud(1800);
  AddArray(cloud, "v", VTK_DOUBLE, 1, Linear);
  AddArray(cloud, "weight", VTK_DOUBLE, 1, [](const Vector3&, int) { return 1; });
  for (vtkIdType i = 0; i < 1800; i += 4)
  {
    cloud->GetPointData()->GetArray("v")->SetComponent(i, 0, i % 8 ? 60 : 140);
    cloud->GetPointData()->GetArray("weight")->SetComponent(i, 0, 0);
  }
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(cloud);
  reconstruction->SetInputArrayToProcess(
    1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "weight");
  reconstruction->Update();
  checks.AtMost(LargestMiss(reconstruction->GetOutput(), "v", Linear, 60, 140), 0.1, "weights");
}

/// A curve in the plane across y has the arrays too.
void TestCurve(Checks& checks)
{
  const auto flower = ipiatest::PointsOn(ipiatest::Flower(), 400);
  auto cloud = ipiatest::ToPolyData(ipiatest::InPlane(flower, 0, 2, 0.7));
  const Field angle = [](const Vector3& x, int) { return std::sin(2 * std::atan2(x[2], x[0])); };
  AddArray(cloud, "angle", VTK_DOUBLE, 1, angle);
  auto reconstruction = Reconstruct(cloud);
  checks.AtMost(
    LargestMiss(reconstruction->GetOutput(), "angle", angle, -1, 1), 2e-3, "on a curve");
  auto fitter = ipiatest::NewFitter(Method::Default, cloud);
  fitter->Update();
  vtkDataArray* array = fitter->GetOutput()->GetPointData()->GetArray("angle");
  checks.That(array && array->GetNumberOfTuples() == fitter->GetOutput()->GetNumberOfPoints() &&
      ipiatest::IsFinite(array),
    "on the image of a curve");
}

/// The contour of the image has what the reconstruction has, to the error of linear interpolation.
void TestContour(Checks& checks)
{
  auto cloud = SphereCloud(3000);
  const Field wave = [](const Vector3& x, int c)
  { return 127 + 120 * std::sin(4 * x[static_cast<std::size_t>(c)]); };
  AddArray(cloud, "RGB", VTK_UNSIGNED_CHAR, 3, wave);
  auto fitter = ipiatest::NewFitter(Method::Default, cloud);
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputConnection(fitter->GetOutputPort());
  contour->SetValue(0, 0);
  contour->InterpolateAttributesOn();
  contour->Update();
  checks.AtMost(LargestMiss(contour->GetOutput(), "RGB", wave, 0, 255), 6, "contour");
  checks.AtMost(LargestMiss(Reconstruct(cloud)->GetOutput(), "RGB", wave, 0, 255), 2, "surface");
}

void TestThreads(Checks& checks)
{
  auto cloud = SphereCloud(3000);
  AddArray(cloud, "v", VTK_DOUBLE, 2,
    [](const Vector3& x, int c) {
      return std::sin(9 * x[0]) + std::fmod(1e4 * std::abs(x[1 + static_cast<std::size_t>(c)]), 1);
    });
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  auto one = Reconstruct(cloud);
  auto oneImage = ipiatest::NewFitter(Method::Default, cloud);
  oneImage->Update();
  omp_set_num_threads(3);
  auto three = Reconstruct(cloud);
  auto threeImage = ipiatest::NewFitter(Method::Default, cloud);
  threeImage->Update();
  omp_set_num_threads(threads);
  checks.That(ipiatest::SameArray(one->GetOutput()->GetPointData()->GetArray("v"),
                three->GetOutput()->GetPointData()->GetArray("v")),
    "the same bits on any number of threads, surface");
  checks.That(ipiatest::SameArray(oneImage->GetOutput()->GetPointData()->GetArray("v"),
                threeImage->GetOutput()->GetPointData()->GetArray("v")),
    "the same bits on any number of threads, image");
}

void TestProgressAndAbort(Checks& checks)
{
  auto cloud = SphereCloud(900);
  AddArray(cloud, "v", VTK_DOUBLE, 2, [](const Vector3& x, int) { return std::sin(9 * x[0]); });
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  auto fitter = ipiatest::NewFitter(Method::Default, cloud, 16);
  reconstruction->SetInputData(cloud);
  for (vtkAlgorithm* algorithm :
    { static_cast<vtkAlgorithm*>(reconstruction.Get()), static_cast<vtkAlgorithm*>(fitter.Get()) })
  {
    for (double abortAt : { 0.35, 0.6, 2. })
    {
      vtkNew<ipiatest::ProgressObserver> progress;
      progress->AbortAt = abortAt;
      const unsigned long tag = algorithm->AddObserver(vtkCommand::ProgressEvent, progress);
      algorithm->SetAbortExecute(0);
      algorithm->Modified();
      algorithm->Update();
      algorithm->RemoveObserver(tag);
      const std::string what = Text(algorithm->GetClassName(), ", abort at ", abortAt);
      auto* output = vtkDataSet::SafeDownCast(algorithm->GetOutputDataObject(0));
      if (abortAt < 1)
      {
        checks.That(ipiatest::IsEmpty(output), what + ": empty output");
      }
      else
      {
        progress->CheckRise(checks, what);
        checks.That(output->GetPointData()->HasArray("v"), what + ": the array is there");
      }
    }
  }
}

/// Colours with noise on a double torus: nearer to the truth than those of the nearest point.
void TestNoisyColours(Checks& checks)
{
  const auto shape = ipiatest::DoubleTorus(std::sqrt(0.03));
  const auto errors =
    ipiatest::NoisyColours(ipiatest::ToPolyData(ipiatest::PointsOn(shape, 12000)));
  checks.AtMost(errors.OfSurface, 0.4 * errors.OfNearest, "error in that of the nearest point");
}
}

int TestPointArrays(int, char*[])
{
  Checks checks;
  TestTypes(checks);
  TestSimpleFields(checks);
  TestDefaultChoice(checks);
  TestChoice(checks);
  TestFIsUnchanged(checks);
  TestComposite(checks);
  TestBadValues(checks);
  TestWeights(checks);
  TestCurve(checks);
  TestContour(checks);
  TestThreads(checks);
  TestProgressAndAbort(checks);
  TestNoisyColours(checks);
  return checks.Result();
}
