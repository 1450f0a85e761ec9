// SPDX-License-Identifier: BSD-3-Clause
/**
 * Any numeric array type and layout, normals of any length, duplicate points: right without a word.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkIPIAImplicitFunction.h"
#include "vtkSOADataArrayTemplate.h"

namespace
{
using ipiatest::Checks;
using ipiatest::Method;
using ipiatest::Text;

/// Integer positions and normals on a sphere of radius 1000, so that every type holds them exactly.
ipiatest::OrientedPoints IntegerSphere()
{
  ipiatest::OrientedPoints cloud = ipiatest::SpherePoints(600, 1000);
  for (auto list : { &cloud.Positions, &cloud.Normals })
  {
    for (auto& v : *list)
    {
      for (double& c : v)
      {
        c = std::round(list == &cloud.Normals ? 100 * c : c);
      }
    }
  }
  return cloud;
}

void CopyInto(vtkDataArray* array, const std::vector<ipiatest::Vector3>& values)
{
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    array->SetTuple(static_cast<vtkIdType>(i), values[i].data());
  }
}

vtkSmartPointer<vtkPolyData> Assemble(
  vtkDataArray* positions, vtkDataArray* normals, vtkDataArray* weights)
{
  const auto cloud = IntegerSphere();
  CopyInto(positions, cloud.Positions);
  CopyInto(normals, cloud.Normals);
  normals->SetName("Normals");
  weights->SetName("Weight");
  weights->SetNumberOfComponents(1); // structures of arrays have none at first
  weights->SetNumberOfTuples(static_cast<vtkIdType>(cloud.Positions.size()));
  for (vtkIdType i = 0; i < weights->GetNumberOfTuples(); ++i)
  {
    weights->SetComponent(i, 0, static_cast<double>(1 + i % 3));
  }
  vtkNew<vtkPoints> points;
  points->SetData(positions);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->GetPointData()->SetNormals(normals);
  data->GetPointData()->AddArray(weights);
  return data;
}

vtkSmartPointer<vtkIPIAImplicitFitter> Fit(Method method, vtkPolyData* cloud)
{
  auto fitter = NewFitter(method, cloud, 16);
  fitter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Weight");
  return fitter;
}

vtkSmartPointer<vtkIPIAImplicitFitter> Reference(Method method)
{
  vtkNew<vtkDoubleArray> positions, normals, weights;
  auto fitter = Fit(method, Assemble(positions, normals, weights));
  fitter->Update();
  return fitter;
}

void CheckAsReference(Checks& checks, vtkPolyData* cloud, const std::string& what)
{
  for (Method method : ipiatest::Methods)
  {
    auto fitter = Fit(method, cloud);
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(fitter);
    fitter->Update();
    checks.That(ipiatest::SameOutputs(fitter, Reference(method)),
      Text(what, " gives the same, ", NameOf(method)));
    messages->CheckSilence(checks, what);
  }
}

void TestTypes(Checks& checks)
{
  const int types[][3] = {
    { VTK_FLOAT, VTK_FLOAT, VTK_FLOAT },
    { VTK_FLOAT, VTK_DOUBLE, VTK_SHORT },
    { VTK_DOUBLE, VTK_FLOAT, VTK_UNSIGNED_CHAR },
    { VTK_INT, VTK_INT, VTK_INT },
    { VTK_DOUBLE, VTK_SHORT, VTK_LONG_LONG },
    { VTK_SHORT, VTK_SIGNED_CHAR, VTK_ID_TYPE },
  };
  for (const auto& type : types)
  {
    const auto make = [](int t)
    { return vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(t)); };
    CheckAsReference(checks, Assemble(make(type[0]), make(type[1]), make(type[2])),
      Text("points of type ", type[0], ", normals ", type[1], ", weights ", type[2]));
  }
}

void TestStructuresOfArrays(Checks& checks)
{
  vtkNew<vtkSOADataArrayTemplate<double>> positions, weights;
  vtkNew<vtkSOADataArrayTemplate<float>> normals;
  CheckAsReference(checks, Assemble(positions, normals, weights), "structures of arrays");
}

/// Lengths that are powers of two divide out exactly, the extreme ones included.
void TestUnnormalisedNormals(Checks& checks)
{
  for (double length : { 0.0078125, 1024., 0x1p-1060, 0x1p1000 })
  {
    vtkNew<vtkDoubleArray> positions, normals, weights;
    auto cloud = Assemble(positions, normals, weights);
    for (vtkIdType i = 0; i < normals->GetNumberOfTuples(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        normals->SetComponent(i, c, length * normals->GetComponent(i, c));
      }
    }
    CheckAsReference(checks, cloud, Text("normals of length ", length));
  }
}

/// A point twice is a point of weight two.
void TestDuplicates(Checks& checks, Method method)
{
  auto sphere = ipiatest::SpherePoints(600);
  auto once = NewFitter(method, ipiatest::ToPolyData(sphere), 16);
  sphere.Append(ipiatest::SpherePoints(600));
  auto twice = NewFitter(method, ipiatest::ToPolyData(sphere), 16);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(twice);
  for (auto& fitter : { once, twice })
  {
    fitter->SetOutputScalarTypeToDouble();
    fitter->Update();
  }
  const std::string what = "duplicates, " + NameOf(method);
  messages->CheckSilence(checks, what);
  // The hierarchy computes in single precision.
  const bool classic = method == Method::Classic;
  checks.AtMost(ipiatest::LargestDifference(once->GetOutput()->GetPointData()->GetScalars(),
                  twice->GetOutput()->GetPointData()->GetScalars()),
    classic ? 1e-12 : 1e-6, what + ": difference of f");
  // It scales the weights so that an occupied cell weighs 1, however many points it holds.
  checks.AtMost(std::abs(twice->GetEnergy() / once->GetEnergy() - (classic ? 2 : 1)),
    classic ? 1e-9 : 1e-5, what + ": growth of the energy");
}

/// Normals that are not the active ones, by name.
void TestNormalsByName(Checks& checks)
{
  vtkNew<vtkDoubleArray> positions, normals, weights, wrong;
  auto cloud = Assemble(positions, normals, weights);
  normals->SetName("Direction");
  wrong->SetName("Wrong");
  wrong->SetNumberOfComponents(3);
  wrong->SetNumberOfTuples(cloud->GetNumberOfPoints());
  wrong->Fill(1);
  cloud->GetPointData()->SetNormals(wrong);
  cloud->GetPointData()->AddArray(normals);
  for (Method method : ipiatest::Methods)
  {
    auto fitter = Fit(method, cloud);
    fitter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Direction");
    fitter->Update();
    checks.That(ipiatest::SameOutputs(fitter, Reference(method)),
      Text("normals chosen by name, ", NameOf(method)));
  }
}
}

int TestImplicitFitterArrayTypes(int, char*[])
{
  Checks checks;
  TestTypes(checks);
  TestStructuresOfArrays(checks);
  TestUnnormalisedNormals(checks);
  for (Method method : ipiatest::Methods)
  {
    TestDuplicates(checks, method);
  }
  TestNormalsByName(checks);
  return checks.Result();
}
