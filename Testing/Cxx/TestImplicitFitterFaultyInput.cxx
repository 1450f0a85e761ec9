// SPDX-License-Identifier: BSD-3-Clause
/**
 * Input that is not to be trusted alike everywhere: weights of blocks and by the length of normals,
 * outliers, and normals that are flipped.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkDoubleArray.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkMinimalStandardRandomSequence.h"
#include "vtkMultiBlockDataSet.h"

#include <limits>

namespace
{
using ipiatest::Checks;
using ipiatest::Method;
using ipiatest::OrientedPoints;
using ipiatest::Vector3;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// Two concentric spheres that cannot both be met: weights decide which is.
constexpr double Inner = 0.9, Outer = 1.1;

OrientedPoints Layer(double radius)
{
  return ipiatest::SpherePoints(1500, radius);
}

void SetFieldWeight(vtkPolyData* block, double weight, int tuples = 1)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName("BlockWeight");
  array->SetNumberOfTuples(tuples);
  array->Fill(weight);
  block->GetFieldData()->AddArray(array);
}

vtkSmartPointer<vtkMultiBlockDataSet> Layers(double innerWeight, double outerWeight)
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  auto inner = ipiatest::ToPolyData(Layer(Inner)), outer = ipiatest::ToPolyData(Layer(Outer));
  SetFieldWeight(inner, innerWeight);
  SetFieldWeight(outer, outerWeight);
  blocks->SetBlock(0, inner);
  blocks->SetBlock(2, outer); // and an empty one between
  return blocks;
}

void UseBlockWeights(vtkAlgorithm* algorithm)
{
  algorithm->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_NONE, "BlockWeight");
}

/// The same weights given point by point.
vtkSmartPointer<vtkPolyData> LayersWithPointWeights(double innerWeight, double outerWeight)
{
  OrientedPoints all = Layer(Inner);
  const auto first = static_cast<vtkIdType>(all.Positions.size());
  all.Append(Layer(Outer));
  auto data = ipiatest::ToPolyData(all);
  vtkNew<vtkDoubleArray> weights;
  weights->SetName("Weight");
  weights->SetNumberOfTuples(data->GetNumberOfPoints());
  for (vtkIdType i = 0; i < weights->GetNumberOfTuples(); ++i)
  {
    weights->SetValue(i, i < first ? innerWeight : outerWeight);
  }
  data->GetPointData()->AddArray(weights);
  return data;
}

vtkSmartPointer<vtkIPIAImplicitFitter> FitOfPointWeights(
  Method method, double innerWeight, double outerWeight)
{
  auto fitter = NewFitter(method, LayersWithPointWeights(innerWeight, outerWeight), 16);
  fitter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Weight");
  fitter->Update();
  return fitter;
}

void TestBlockWeights(Checks& checks)
{
  for (Method method : ipiatest::Methods)
  {
    for (const auto& [inner, outer] : { std::pair(0.25, 4.0), std::pair(1.0, 0.0) })
    {
      const std::string what =
        ipiatest::Text("weights ", inner, " and ", outer, ", ", NameOf(method));
      auto fitter = NewFitter(method, Layers(inner, outer), 16);
      UseBlockWeights(fitter);
      vtkNew<ipiatest::MessageObserver> messages;
      messages->Watch(fitter);
      fitter->Update();
      messages->CheckSilence(checks, what);
      auto expected = FitOfPointWeights(method, inner, outer);
      checks.That(ipiatest::SameArray(fitter->GetOutput()->GetPointData()->GetScalars(),
                    expected->GetOutput()->GetPointData()->GetScalars()),
        what + ": as with a weight for each point");
    }
  }
  // One data set is one block.
  auto single = ipiatest::SphereCloud();
  SetFieldWeight(single, 3);
  auto fitter = NewFitter(Method::Default, single, 16);
  UseBlockWeights(fitter);
  fitter->Update();
  checks.That(ipiatest::OutputsAreSound(fitter), "field data of a single data set");
}

void TestBlockWeightsOfReconstruction(Checks& checks)
{
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(Layers(0, 1));
  UseBlockWeights(reconstruction);
  reconstruction->Update();
  const double* bounds = reconstruction->GetOutput()->GetBounds();
  checks.AtMost(std::abs(bounds[1] - Outer), 0.01, "the layer of weight 1 is met");
}

void TestBadBlockWeights(Checks& checks)
{
  for (Method method : ipiatest::Methods)
  {
    vtkNew<ipiatest::MessageObserver> messages;
    const auto check = [&](vtkMultiBlockDataSet* blocks, const std::string& error,
                         const std::string& warning, const std::string& what)
    {
      auto fitter = NewFitter(method, blocks, 16);
      UseBlockWeights(fitter);
      messages->Watch(fitter);
      fitter->Update();
      if (error.empty())
      {
        messages->CheckOneWarning(checks, warning, what + ", " + NameOf(method));
        checks.That(ipiatest::OutputsAreSound(fitter), what + ": the rest is fitted");
        checks.Equal(ipiatest::FittedPoints(fitter)->GetNumberOfPoints(), 1500, what);
      }
      else
      {
        messages->CheckOneError(checks, error, what + ", " + NameOf(method));
        checks.That(ipiatest::OutputsAreEmpty(fitter), what + ": empty outputs");
      }
    };
    auto missing = Layers(1, 1);
    vtkPolyData::SafeDownCast(missing->GetBlock(2))->GetFieldData()->RemoveArray("BlockWeight");
    check(missing, "Some blocks of the input have row weights and others not", "",
      "a block without its weight");
    auto two = Layers(1, 1);
    SetFieldWeight(vtkPolyData::SafeDownCast(two->GetBlock(2)), 1, 2);
    check(two, "it must have one of each", "", "two weights for a block");
    check(Layers(0, 0), "row weights are zero", "", "no block with a weight");
    check(Layers(NaN, -1), "has finite coordinates and a valid weight", "", "no valid weight");
    check(Layers(-1, 1), "", "1500 point(s) with a negative or non-finite weight", "weight -1");
    check(Layers(1, NaN), "", "1500 point(s) with a negative or non-finite weight", "weight NaN");
  }
}

void TestNormalLengths(Checks& checks)
{
  // The lengths are the weights times 7, and the median is 7 times 1.
  auto data = LayersWithPointWeights(1, 0.125);
  vtkDataArray* normals = data->GetPointData()->GetNormals();
  vtkDataArray* weights = data->GetPointData()->GetArray("Weight");
  weights->SetTuple1(0, 2);
  weights->SetTuple1(1, 1);
  const auto n = data->GetNumberOfPoints();
  for (vtkIdType i = n / 2; i < n / 2 + 2; ++i)
  {
    weights->SetTuple1(i, 1); // so that the median is 1
  }
  auto lengths = vtkSmartPointer<vtkPolyData>::New();
  lengths->DeepCopy(data);
  for (vtkIdType i = 0; i < n; ++i)
  {
    double v[3];
    normals->GetTuple(i, v);
    for (double& c : v)
    {
      c *= 8 * weights->GetTuple1(i);
    }
    lengths->GetPointData()->GetNormals()->SetTuple(i, v);
  }
  for (Method method : ipiatest::Methods)
  {
    auto expected = NewFitter(method, data, 16);
    expected->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Weight");
    expected->Update();
    auto plain = NewFitter(method, data, 16);
    plain->Update();
    auto fitter = NewFitter(method, lengths, 16);
    fitter->Update();
    const auto differenceFrom = [&](vtkIPIAImplicitFitter* other)
    {
      double largest = 0;
      for (vtkIdType i = 0; i < fitter->GetOutput()->GetNumberOfPoints(); ++i)
      {
        largest = std::max(largest,
          std::abs(fitter->GetOutput()->GetPointData()->GetScalars()->GetTuple1(i) -
            other->GetOutput()->GetPointData()->GetScalars()->GetTuple1(i)));
      }
      return largest;
    };
    checks.AtMost(differenceFrom(plain), 1e-4, "off: lengths do not count, " + NameOf(method));
    fitter->UseNormalLengthsOn();
    fitter->Update();
    checks.AtMost(differenceFrom(expected), 1e-4, "on: as weights, " + NameOf(method));
    checks.That(differenceFrom(plain) > 1e-2, "on: it makes a difference, " + NameOf(method));
  }
}

void TestBadNormalLengths(Checks& checks)
{
  for (Method method : ipiatest::Methods)
  {
    auto data = ipiatest::SphereCloud();
    vtkDataArray* normals = data->GetPointData()->GetNormals();
    auto fitter = NewFitter(method, data, 16);
    fitter->UseNormalLengthsOn();
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(fitter);
    normals->SetTuple3(0, 0, 0, 0);
    normals->SetTuple3(1, NaN, 0, 1);
    normals->SetTuple3(2, 1e300, 1e300, 0);
    fitter->Update();
    messages->CheckOneWarning(
      checks, "2 zero or non-finite normal(s)", "some without length, " + NameOf(method));
    checks.That(ipiatest::OutputsAreSound(fitter), "and the rest is fitted");
    for (vtkIdType i = 0; i < normals->GetNumberOfTuples(); ++i)
    {
      normals->SetTuple3(i, 0, 0, 0);
    }
    normals->Modified();
    data->Modified();
    fitter->Update();
    messages->CheckOneError(
      checks, "600 normals are zero or not finite", "all of length 0, " + NameOf(method));
    checks.That(ipiatest::OutputsAreEmpty(fitter), "empty outputs");
  }
}

/// Turns this share of the normals.
double Flip(OrientedPoints& cloud, double share)
{
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(7);
  double flipped = 0;
  for (Vector3& n : cloud.Normals)
  {
    random->Next();
    if (random->GetValue() < share)
    {
      n = { -n[0], -n[1], -n[2] };
      ++flipped;
    }
  }
  return flipped / static_cast<double>(cloud.Normals.size());
}

void TestFlippedNormals(Checks& checks)
{
  for (double share : { 0.02, 0.1, 0.25 })
  {
    OrientedPoints cloud = ipiatest::SpherePoints(6000);
    const double flipped = Flip(cloud, share);
    vtkNew<vtkIPIAImplicitFitter> fitter;
    fitter->SetInputData(ipiatest::ToPolyData(cloud));
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(fitter);
    fitter->Update();
    const std::string what = ipiatest::Text(share, " flipped");
    messages->CheckOneWarning(
      checks, ipiatest::Text(std::round(1000 * flipped) / 10, " % of the normals"), what);
    checks.AtMost(std::abs(fitter->GetFlippedNormalsFound() - flipped), 0.005, what + ": share");
    checks.Equal(fitter->GetOutput()->GetFieldData()->GetArray("FlippedNormalsFound")->GetTuple1(0),
      fitter->GetFlippedNormalsFound(), what + ": field data");
    checks.Equal(
      ipiatest::TopologyOf(ipiatest::ZeroSurface(fitter)), ipiatest::Topology{ 1, 0, 0, 0 }, what);
    vtkPointData* fitted = ipiatest::FittedPoints(fitter)->GetPointData();
    vtkDataArray* agreement = fitted->GetArray("NormalAgreement");
    double negative = 0;
    for (vtkIdType i = 0; i < agreement->GetNumberOfTuples(); ++i)
    {
      negative += agreement->GetTuple1(i) < -0.9;
      checks.That(std::abs(agreement->GetTuple1(i)) > 0.9, what + ": NormalAgreement is 1 or -1");
    }
    checks.Equal(negative / 6000, flipped, what + ": NormalAgreement");
    checks.AtMost(fitter->GetAverageError(), 1e-8, what + ": the points are met");
    fitter->SetSampleDimensions(20, 20, 20);
    fitter->Update();
    messages->CheckSilence(checks, what + ", sampled again");
  }
}

void TestInsideOut(Checks& checks)
{
  for (Method method : ipiatest::Methods)
  {
    const std::string phrase = "inside and outside are exchanged";
    vtkNew<ipiatest::MessageObserver> messages;
    const auto fit = [&](const OrientedPoints& cloud)
    {
      auto fitter = NewFitter(method, ipiatest::ToPolyData(cloud), 16);
      messages->Watch(fitter);
      fitter->Update();
    };
    fit(ipiatest::SpherePoints(600, 1, { 0, 0, 0 }, -1));
    messages->CheckOneWarning(checks, phrase, "inward normals, " + NameOf(method));
    fit(ipiatest::SpherePoints(600));
    messages->CheckSilence(checks, "outward normals, " + NameOf(method));
    // In the plane.
    OrientedPoints circle;
    for (int i = 0; i < 200; ++i)
    {
      const double angle = 2 * vtkMath::Pi() * i / 200;
      circle.Add(
        { std::cos(angle), std::sin(angle), 3 }, { -std::cos(angle), -std::sin(angle), 0 });
    }
    fit(circle);
    messages->CheckOneWarning(checks, phrase, "inward normals in the plane, " + NameOf(method));
  }
  // An open terrain is no closed surface, whichever way it looks.
  for (double side : { 1., -1. })
  {
    OrientedPoints terrain;
    for (int i = 0; i < 60; ++i)
    {
      for (int j = 0; j < 60; ++j)
      {
        const double x = i / 60., y = j / 60., slope = 0.3 * std::cos(6 * x);
        const double length = std::sqrt(1 + slope * slope);
        terrain.Add({ x, y, 0.05 * std::sin(6 * x) }, { -side * slope / length, 0, side / length });
      }
    }
    vtkNew<vtkIPIAImplicitFitter> fitter;
    fitter->SetInputData(ipiatest::ToPolyData(terrain));
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(fitter);
    fitter->Update();
    messages->CheckSilence(checks, ipiatest::Text("terrain towards ", side));
  }
}

/// Points anywhere in the box from -1 to 1, with any normals.
void AddOutliers(OrientedPoints& cloud, int n)
{
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(3);
  const auto uniform = [&]
  {
    random->Next();
    return random->GetRangeValue(-1, 1);
  };
  for (int k = 0; k < n; ++k)
  {
    const Vector3 x{ uniform(), uniform(), uniform() };
    Vector3 normal{ uniform(), uniform(), uniform() };
    vtkMath::Normalize(normal.data());
    cloud.Add(x, normal);
  }
}

void TestOutliers(Checks& checks)
{
  const OrientedPoints sphere = ipiatest::SpherePoints(6000);
  double cleanSpacing = 0;
  for (int outliers : { 0, 60, 300 })
  {
    OrientedPoints cloud = sphere;
    AddOutliers(cloud, outliers);
    vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
    reconstruction->SetInputData(ipiatest::ToPolyData(cloud));
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(reconstruction);
    reconstruction->Update();
    const std::string what = ipiatest::Text(outliers, " outliers");
    messages->CheckSilence(checks, what);
    vtkIPIAImplicitFitter* fitter = reconstruction->GetFitter();
    const double share = outliers / (6000. + outliers);
    checks.AtMost(std::abs(fitter->GetOutliersFound() - share), 0.2 * share, what + ": share");
    vtkNew<vtkIPIAImplicitFitter> alone;
    alone->SetInputData(ipiatest::ToPolyData(cloud));
    alone->Update();
    vtkDataArray* outlier = ipiatest::FittedPoints(alone)->GetPointData()->GetArray("Outlier");
    double found = 0, ofSphere = 0;
    for (vtkIdType i = 0; i < outlier->GetNumberOfTuples(); ++i)
    {
      found += outlier->GetTuple1(i);
      ofSphere += i < 6000 ? outlier->GetTuple1(i) : 0;
    }
    checks.Equal(found / (6000. + outliers), fitter->GetOutliersFound(), what + ": the array");
    checks.AtMost(ofSphere / 6000, 1e-3, what + ": hardly any point of the sphere");
    checks.Equal(fitter->GetSmoothingLengthUsed(), 0., what + ": not taken for noise");
    checks.Equal(
      ipiatest::TopologyOf(reconstruction->GetOutput()), ipiatest::Topology{ 1, 0, 0, 0 }, what);
    double sum = 0;
    vtkPoints* points = reconstruction->GetOutput()->GetPoints();
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
    {
      sum += std::abs(vtkMath::Norm(points->GetPoint(i)) - 1);
    }
    checks.AtMost(sum / static_cast<double>(points->GetNumberOfPoints()), 5e-4, what);
    const double* bounds = fitter->GetModelBoundsUsed();
    const double spacing = (bounds[1] - bounds[0]) / (fitter->GetGridSizeUsed()[0] - 3);
    cleanSpacing = outliers == 0 ? spacing : cleanSpacing;
    checks.AtMost(spacing / cleanSpacing, 1.06, what + ": the lattice is hardly coarser");
  }
}

/// Outliers support no surface: half a sphere ends where its points end.
void TestOutliersAroundOpenSurface(Checks& checks)
{
  const OrientedPoints sphere = ipiatest::SpherePoints(12000);
  OrientedPoints cloud;
  for (std::size_t k = 0; k < sphere.Positions.size(); ++k)
  {
    if (sphere.Positions[k][2] > 0)
    {
      cloud.Add(sphere.Positions[k], sphere.Normals[k]);
    }
  }
  AddOutliers(cloud, 200);
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(ipiatest::ToPolyData(cloud));
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(reconstruction);
  reconstruction->Update();
  messages->CheckSilence(checks, "half a sphere");
  vtkPolyData* surface = reconstruction->GetOutput();
  const ipiatest::Topology topology = ipiatest::TopologyOf(surface);
  checks.Equal(topology.Components, 1, "half a sphere: components");
  checks.That(topology.BoundaryEdges > 0, "half a sphere: open");
  const double spacing = std::sqrt(4 * vtkMath::Pi() / 12000);
  double lowest = 1, miss = 0;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    const double* x = surface->GetPoint(i);
    lowest = std::min(lowest, x[2]);
    miss = std::max(miss, std::abs(vtkMath::Norm(x) - 1));
  }
  checks.AtMost(-lowest, 2 * spacing, "half a sphere: ends within two spacings");
  checks.AtMost(lowest, 2 * spacing, "half a sphere: reaches its border within two spacings");
  checks.AtMost(miss, spacing, "half a sphere: its shape");
}
}

int TestImplicitFitterFaultyInput(int, char*[])
{
  Checks checks;
  TestBlockWeights(checks);
  TestBlockWeightsOfReconstruction(checks);
  TestBadBlockWeights(checks);
  TestNormalLengths(checks);
  TestBadNormalLengths(checks);
  TestFlippedNormals(checks);
  TestInsideOut(checks);
  TestOutliers(checks);
  TestOutliersAroundOpenSurface(checks);
  return checks.Result();
}
