// SPDX-License-Identifier: BSD-3-Clause
/**
 * Fair surfaces: curvature of known ones, grids and given parameters, weights, rounds, knots,
 * threads.
 */
#include "IPIATestFairing.h"

#include <omp.h>

namespace
{
using ipiatest::Checks;
using ipiatest::Output;
using ipiatest::PointArray;
using ipiatest::Text;
using ipiatest::Vector3;

using Filter = vtkSmartPointer<vtkFairingPIASurfaceFilter>;

Filter NewFilter(vtkDataObject* data)
{
  auto filter = ipiatest::NewExactFilter<vtkFairingPIASurfaceFilter>(data);
  filter->SetSolverToBiconjugateGradient();
  return filter;
}

void TestNothingSet(Checks& checks)
{
  auto filter = Filter::New();
  filter->SetInputData(ipiatest::WavyGrid(40, 31));
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(filter);
  filter->Update();
  messages->CheckSilence(checks, "nothing set");
  checks.That(ipiatest::AllOutputsAreFinite(filter), "nothing set: outputs are finite");
  checks.Equal(Output(filter, 1)->GetNumberOfPoints(), 14 * 11, "control points");
  checks.Equal(filter->GetOutput()->GetNumberOfPoints(), 45 * 33, "samples");
  checks.Equal(filter->GetOutput()->GetNumberOfPolys(), 44 * 32, "quadrilaterals");
  checks.AtMost(filter->GetFittingError(), 1e-3, "fitting error");
  checks.That(filter->GetFairingEnergy() > 0, "energy");
  vtkFieldData* field = filter->GetOutput()->GetFieldData();
  checks.Equal(field->GetArray("FittingErrorHistory")->GetNumberOfTuples(),
    vtkIdType(filter->GetNumberOfIterationsUsed() + 1), "history");
}

struct Shape
{
  std::string Name;
  std::function<Vector3(double, double)> Surface;
  std::function<std::array<double, 2>(double, double)> Curvatures; ///< mean and Gauss
};

/// Curvature within 1e-3 away from the ends; normals point outwards.
void TestClosedForms(Checks& checks)
{
  const std::vector<Shape> shapes = { { "sphere",
                                        [](double u, double v)
                                        {
                                          const double a = 2 * u, b = v - 0.5;
                                          return Vector3{ 2 * std::cos(a) * std::cos(b),
                                            2 * std::sin(a) * std::cos(b), 2 * std::sin(b) };
                                        },
                                        [](double, double) {
                                          return std::array<double, 2>{ 0.5, 0.25 };
                                        } },
    { "cylinder",
      [](double u, double v) {
        return Vector3{ 2 * std::cos(3 * u), 2 * std::sin(3 * u), 5 + v };
      },
      [](double, double) {
        return std::array<double, 2>{ 0.25, 0 };
      } },
    { "torus",
      [](double u, double v)
      {
        const double a = 2 * u, b = 3 * v, r = 2 + 0.8 * std::cos(b);
        return Vector3{ r * std::cos(a), r * std::sin(a), 0.8 * std::sin(b) };
      },
      [](double, double v)
      {
        const double around = std::cos(3 * v) / (2 + 0.8 * std::cos(3 * v));
        return std::array<double, 2>{ (1 / 0.8 + around) / 2, around / 0.8 };
      } } };
  for (const Shape& shape : shapes)
  {
    auto filter = NewFilter(ipiatest::ToGrid(80, 80, shape.Surface));
    filter->SetNumberOfControlPoints(40, 40);
    filter->SetParametrizationToUniform();
    filter->SetFairingWeight(1e-12);
    filter->SetTolerance(1e-10);
    filter->SetSampleDimensions(81, 81);
    filter->Update();
    double mean = 0, gauss = 0, normal = 0;
    for (vtkIdType k = 0; k < 81 * 81; ++k)
    {
      const double u = static_cast<double>(k % 81) / 80, v = static_cast<double>(k / 81) / 80;
      if (u < 0.1 || u > 0.9 || v < 0.1 || v > 0.9)
      {
        continue;
      }
      const auto expected = shape.Curvatures(u, v);
      mean = std::max(
        mean, std::abs(PointArray(filter, 0, "MeanCurvature")->GetComponent(k, 0) - expected[0]));
      gauss = std::max(
        gauss, std::abs(PointArray(filter, 0, "GaussCurvature")->GetComponent(k, 0) - expected[1]));
      // By differences of the surface.
      const double h = 1e-5;
      const Vector3 x = shape.Surface(u, v), a = shape.Surface(u + h, v),
                    b = shape.Surface(u, v + h);
      double along[3], across[3], n[3], found[3];
      for (std::size_t c = 0; c < 3; ++c)
      {
        along[c] = a[c] - x[c];
        across[c] = b[c] - x[c];
      }
      vtkMath::Cross(along, across, n);
      vtkMath::Normalize(n);
      Output(filter, 0)->GetPointData()->GetNormals()->GetTuple(k, found);
      normal = std::max(normal, std::sqrt(vtkMath::Distance2BetweenPoints(n, found)));
    }
    checks.AtMost(mean, 1e-3, shape.Name + ": error of mean curvature");
    checks.AtMost(gauss, 1e-3, shape.Name + ": error of Gauss curvature");
    checks.AtMost(normal, 1e-3, shape.Name + ": error of normals");
  }
}

/// A grid whose parameters are given is that grid; scattered points too where knots are uniform.
void TestGivenParameters(Checks& checks)
{
  auto grid = ipiatest::WavyGrid(41, 31, 0.01);
  auto ordered = NewFilter(grid);
  ordered->SetParametrizationToUniform();
  ordered->SetNumberOfControlPoints(14, 11);
  ordered->Update();
  vtkDataArray* parameters = PointArray(ordered, 2, "Parameter");

  vtkNew<vtkPolyData> scattered;
  scattered->SetPoints(grid->GetPoints());
  scattered->GetPointData()->SetTCoords(parameters);
  auto given = NewFilter(scattered);
  given->SetParametrizationToGiven();
  given->SetNumberOfControlPoints(14, 11);
  given->Update();
  // The knots differ a little, and so do the surfaces, by less than the noise.
  checks.AtMost(ipiatest::LargestDistance(ordered->GetOutput(), given->GetOutput()), 0.01,
    "scattered points against the grid");
  checks.AtMost(given->GetFittingError(), 0.011, "scattered points: fitting error");

  // With the control points of the grid to begin with, and so with its knots, it is the same
  // surface.
  given->SetControlPointsData(Output(ordered, 1));
  given->Update();
  checks.AtMost(ipiatest::LargestDistance(ordered->GetOutput(), given->GetOutput()), 1e-7,
    "scattered points with the knots of the grid");

  // Half of the domain without data: fairing fills it.
  vtkNew<vtkPolyData> half;
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> tcoords;
  tcoords->SetNumberOfComponents(2);
  tcoords->SetName("uv");
  for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
  {
    const double* uv = parameters->GetTuple(k);
    if (uv[0] <= 0.5)
    {
      points->InsertNextPoint(grid->GetPoint(k));
      tcoords->InsertNextTuple(uv);
    }
  }
  half->SetPoints(points);
  half->GetPointData()->AddArray(tcoords);
  auto filled = NewFilter(half);
  filled->SetParametrizationToGiven();
  ipiatest::Choose(filled, 3, 0, "uv");
  filled->SetNumberOfControlPoints(14, 11);
  filled->SetFairingWeight(1e-3);
  filled->Update();
  checks.That(ipiatest::AllOutputsAreFinite(filled), "half of the domain: finite");
  checks.AtMost(filled->GetFittingError(), 0.03, "half of the domain: fitting error");
}

void TestFairness(Checks& checks)
{
  auto grid = ipiatest::WavyGrid(60, 60, 0.01);
  double energy[2];
  for (const bool fair : { false, true })
  {
    auto filter = NewFilter(grid);
    filter->SetNumberOfControlPoints(40, 40);
    filter->SetFairingWeight(fair ? 1e-4 : 1e-10);
    filter->Update();
    energy[fair] = filter->GetFairingEnergy();
    checks.AtMost(filter->GetFittingError(), 0.015, Text("fair ", fair, ": fitting error"));
  }
  checks.AtMost(energy[1], energy[0] / 10, "thin plate energy against the fit");
}

/// A fairer patch of which only its own control points move, and knots that change nothing.
void TestRounds(Checks& checks)
{
  auto grid = ipiatest::WavyGrid(50, 50, 0.01);
  auto first = NewFilter(grid);
  first->SetNumberOfControlPoints(24, 24);
  first->SetSampleDimensions(121, 121);
  first->SetFairingWeight(1e-9);
  first->Update();
  vtkNew<vtkPolyData> controls;
  controls->DeepCopy(Output(first, 1));
  const auto inPatch = [](vtkIdType j)
  { return j % 24 >= 9 && j % 24 < 13 && j / 24 >= 9 && j / 24 < 13; };
  ipiatest::AddArray(controls, "Movable", [&](vtkIdType j) { return inPatch(j) ? 1.0 : 0.0; });
  for (vtkIdType j = 0; j < 24 * 24; ++j)
  {
    if (inPatch(j))
    {
      controls->GetPointData()->GetArray("FairingWeight")->SetComponent(j, 0, 1e-3);
    }
  }
  auto second = NewFilter(grid);
  second->SetControlPointsData(controls);
  second->SetSampleDimensions(121, 121);
  ipiatest::Choose(second, 2, 1, "Movable");
  second->Update();
  vtkFieldData* field = Output(second, 1)->GetFieldData();
  vtkDataArray* knots = field->GetArray("Knots");
  const auto v = static_cast<vtkIdType>(field->GetArray("KnotOffsets")->GetComponent(1, 0));
  double inside = 0, outside = 0;
  for (vtkIdType k = 0; k < 121 * 121; ++k)
  {
    const double s = static_cast<double>(k % 121) / 120, t = static_cast<double>(k / 121) / 120;
    const bool in = s > knots->GetComponent(9, 0) && s < knots->GetComponent(16, 0) &&
      t > knots->GetComponent(v + 9, 0) && t < knots->GetComponent(v + 16, 0);
    double x[3], y[3];
    first->GetOutput()->GetPoint(k, x);
    second->GetOutput()->GetPoint(k, y);
    double& largest = in ? inside : outside;
    largest = std::max(largest, std::sqrt(vtkMath::Distance2BetweenPoints(x, y)));
  }
  checks.That(inside > 1e-3, Text("the patch changes (", inside, ")"));
  checks.AtMost(outside, 1e-10, "change outside the patch's support");

  ipiatest::AddArray(controls, "Fixed", [](vtkIdType) { return 0; });
  ipiatest::Choose(second, 2, 1, "Fixed");
  second->InsertKnot(0, 0.25);
  second->InsertKnot(1, 0.5);
  second->InsertKnot(1, 0.55);
  second->Update();
  checks.Equal(
    Output(second, 1)->GetNumberOfPoints(), 25 * 26, "control points with inserted knots");
  checks.AtMost(
    ipiatest::LargestDistance(first->GetOutput(), second->GetOutput()), 1e-12, "knots inserted");
}

void TestArraysAndWeights(Checks& checks)
{
  auto grid = ipiatest::WavyGrid(40, 30);
  ipiatest::AddArray(grid, "x", [&](vtkIdType k) { return grid->GetPoint(k)[0]; });
  ipiatest::AddArray(
    grid, "w", [&](vtkIdType k) { return grid->GetPoint(k)[0] < 1 ? 1e-8 : 1e-4; });
  auto filter = NewFilter(grid);
  ipiatest::Choose(filter, 0, 0, "w");
  filter->SetSampleDimensions(33, 33);
  filter->Update();
  double largest = 0;
  for (vtkIdType k = 0; k < 33 * 33; ++k)
  {
    largest = std::max(largest,
      std::abs(
        PointArray(filter, 0, "x")->GetComponent(k, 0) - filter->GetOutput()->GetPoint(k)[0]));
  }
  checks.AtMost(largest, 0.01, "array of the input on the surface");
  vtkDataArray* weights = PointArray(filter, 1, "FairingWeight");
  checks.AtMost(std::abs(weights->GetComponent(0, 0) / 1e-8 - 1), 1e-12, "weight at u = 0");
  checks.AtMost(std::abs(weights->GetComponent(13, 0) / 1e-4 - 1), 1e-12, "weight at u = 1");
  for (const int choice :
    { vtkFairingPIAFilter::SecondDifference, vtkFairingPIAFilter::CurvatureVariation })
  {
    auto automatic = NewFilter(ipiatest::WavyGrid(40, 30));
    automatic->SetAutomaticFairing(choice);
    automatic->SetAutomaticShare(0.5);
    automatic->Update();
    int raised = 0;
    for (vtkIdType j = 0; j < 140; ++j)
    {
      raised += PointArray(automatic, 1, "FairingWeight")->GetComponent(j, 0) == 1e-4 ? 1 : 0;
    }
    checks.Equal(raised, 70, Text("control points raised by choice ", choice));
  }
}

void TestThreads(Checks& checks)
{
  auto grid = ipiatest::WavyGrid(100, 90, 0.01);
  vtkNew<vtkPolyData> scattered;
  scattered->SetPoints(grid->GetPoints());
  vtkNew<vtkDoubleArray> uv;
  uv->SetNumberOfComponents(2);
  uv->SetName("uv");
  for (vtkIdType k = 0; k < 9000; ++k)
  {
    uv->InsertNextTuple2(static_cast<double>(k % 100) / 99, static_cast<double>(k / 100) / 89);
  }
  scattered->GetPointData()->SetTCoords(uv);
  for (const bool given : { false, true })
  {
    Filter reference;
    for (const int threads : { 1, 2, 4 })
    {
      omp_set_num_threads(threads);
      auto filter = Filter::New();
      filter->SetInputDataObject(given ? static_cast<vtkDataObject*>(scattered) : grid);
      filter->SetParametrization(given ? vtkFairingPIAFilter::Given : vtkFairingPIAFilter::Chord);
      filter->SetNumberOfControlPoints(70, 70);
      filter->SetTolerance(0);
      filter->SetMaximumNumberOfIterations(10);
      filter->Update();
      reference = reference ? reference : filter;
      checks.That(ipiatest::SameBits(reference, filter),
        Text("given ", given, ", ", threads, " thread(s): same bits"));
    }
  }
}
}

int TestFairingPIASurface(int, char*[])
{
  Checks checks;
  TestNothingSet(checks);
  TestClosedForms(checks);
  TestGivenParameters(checks);
  TestFairness(checks);
  TestRounds(checks);
  TestArraysAndWeights(checks);
  TestThreads(checks);
  return checks.Result();
}
