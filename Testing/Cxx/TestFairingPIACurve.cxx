// SPDX-License-Identifier: BSD-3-Clause
/**
 * Fair curves: what they are like, weights, rounds, knots, threads.
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

using Filter = vtkSmartPointer<vtkFairingPIACurveFilter>;

Filter NewFilter(vtkPolyData* lines)
{
  return ipiatest::NewExactFilter<vtkFairingPIACurveFilter>(lines);
}

void TestNothingSet(Checks& checks)
{
  auto filter = Filter::New();
  filter->SetInputData(ipiatest::ToLine(ipiatest::WavePoints(100)));
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(filter);
  filter->Update();
  messages->CheckSilence(checks, "nothing set");
  checks.That(ipiatest::AllOutputsAreFinite(filter), "nothing set: outputs are finite");
  checks.Equal(Output(filter, 1)->GetNumberOfPoints(), 34, "control points");
  checks.Equal(filter->GetOutput()->GetNumberOfPoints(), 311, "samples");
  checks.AtMost(filter->GetFittingError(), 1e-3, "fitting error");
  checks.AtMost(filter->GetIterationError(), 1e-6, "iteration error");
  const auto states = static_cast<vtkIdType>(filter->GetNumberOfIterationsUsed() + 1);
  vtkFieldData* field = filter->GetOutput()->GetFieldData();
  for (const char* name :
    { "IterationErrorHistory", "FittingErrorHistory", "FairingEnergyHistory" })
  {
    checks.Equal(field->GetArray(name)->GetNumberOfTuples(), states, Text("states in ", name));
  }
  const double lastFit = field->GetArray("FittingErrorHistory")->GetComponent(states - 1, 0);
  checks.AtMost(
    std::abs(lastFit - filter->GetFittingError()), 1e-9, "fitting error and its history");
  double sum = 0;
  vtkDataArray* errors = PointArray(filter, 2, "FitError");
  for (vtkIdType k = 0; k < 100; ++k)
  {
    sum += std::pow(errors->GetComponent(k, 0), 2) / 100;
  }
  checks.AtMost(
    std::abs(std::sqrt(sum) - filter->GetFittingError()), 1e-14, "fitting error of the points");
  // Clamped ends pass near the end points.
  double x[3];
  filter->GetOutput()->GetPoint(0, x);
  checks.AtMost(std::sqrt(vtkMath::Distance2BetweenPoints(x, ipiatest::WavePoints(100)[0].data())),
    0.01, "first point");
}

/// A closed circle and an open arc: curvature 1 / radius, no torsion, normals towards the centre.
void TestCircle(Checks& checks)
{
  for (const bool closed : { true, false })
  {
    for (const int degree : { 3, 4, 5 })
    {
      auto points = ipiatest::CurvePoints(200, closed,
        [](double t)
        {
          return Vector3{ 5 + 2 * std::cos(6.2831853071795865 * t),
            2 * std::sin(6.2831853071795865 * t), 1 };
        });
      auto filter = NewFilter(ipiatest::ToLine(points, closed));
      filter->SetClosure(
        closed ? vtkFairingPIACurveFilter::ClosedCurves : vtkFairingPIACurveFilter::OpenCurves);
      filter->SetDegree(degree);
      filter->SetFairingWeight(1e-12);
      filter->SetTolerance(1e-6);
      filter->SetSampleDimensions(1000);
      filter->Update();
      double curvature = 0, torsion = 0, normal = 0, length = 0;
      for (vtkIdType k = closed ? 0 : 100; k < (closed ? 1000 : 900); ++k)
      {
        double x[3], n[3];
        filter->GetOutput()->GetPoint(k, x);
        PointArray(filter, 0, "CurvatureNormal")->GetTuple(k, n);
        const double inwards[3] = { (5 - x[0]) / 4, -x[1] / 4, 1 - x[2] };
        const double kappa = PointArray(filter, 0, "Curvature")->GetComponent(k, 0);
        curvature = std::max(curvature, std::abs(kappa - 0.5));
        torsion = std::max(torsion, std::abs(PointArray(filter, 0, "Torsion")->GetComponent(k, 0)));
        normal = std::max(normal, std::sqrt(vtkMath::Distance2BetweenPoints(n, inwards)));
        length = std::max(length, std::abs(vtkMath::Norm(n) - kappa));
      }
      const std::string what = Text(closed ? "circle" : "arc", " of degree ", degree);
      checks.AtMost(curvature, 1e-3, what + ": error of curvature");
      checks.AtMost(normal, 1e-3, what + ": error of curvature normal");
      checks.AtMost(length, 1e-12, what + ": length of the normal against curvature");
      checks.AtMost(torsion, 1e-3, what + ": torsion");
    }
  }
}

/// The claim of the method: far fairer than the fit, and hardly less true to the data.
void TestStarfish(Checks& checks)
{
  const double noise = 0.02;
  auto line = ipiatest::ToLine(ipiatest::StarfishPoints(200, noise), true);
  double energy[2];
  for (const bool fair : { false, true })
  {
    auto filter = NewFilter(line);
    filter->SetNumberOfControlPoints(100);
    filter->SetFairingWeight(fair ? 3e-6 : 1e-10);
    filter->Update();
    energy[fair] = filter->GetFairingEnergy();
    checks.AtMost(
      filter->GetFittingError(), 1.5 * noise, Text("starfish, fair ", fair, ": fitting error"));
  }
  checks.AtMost(energy[1], energy[0] / 10, "starfish: strain energy against the fit");
}

/// A plane curve with noise, more faired on one segment.
void TestSegments(Checks& checks)
{
  auto line = ipiatest::ToLine(ipiatest::StarfishPoints(240, 0.01), true);
  auto first = NewFilter(line);
  first->SetNumberOfControlPoints(80);
  first->SetFairingWeight(1e-8);
  first->SetSampleDimensions(4001);
  first->Update();
  vtkNew<vtkPolyData> controls;
  controls->DeepCopy(Output(first, 1));
  vtkDataArray* weights = controls->GetPointData()->GetArray("FairingWeight");
  for (vtkIdType j = 20; j < 30; ++j)
  {
    weights->SetComponent(j, 0, 1e-4);
  }
  ipiatest::AddArray(
    controls, "Movable", [](vtkIdType j) { return j >= 20 && j < 30 ? 1.0 : 0.0; });

  for (const bool local : { true, false })
  {
    auto second = NewFilter(line);
    second->SetControlPointsData(controls);
    second->SetSampleDimensions(4001);
    if (local)
    {
      ipiatest::Choose(second, 2, 1, "Movable");
    }
    second->Update();
    vtkDataArray* knots = Output(second, 1)->GetFieldData()->GetArray("Knots");
    const double low = knots->GetComponent(20, 0), high = knots->GetComponent(29 + 4, 0);
    double inside = 0, outside = 0, opposite = 0;
    for (vtkIdType k = 0; k < 4001; ++k)
    {
      double x[3], y[3];
      first->GetOutput()->GetPoint(k, x);
      second->GetOutput()->GetPoint(k, y);
      const double t = static_cast<double>(k) / 4000;
      const double distance = std::sqrt(vtkMath::Distance2BetweenPoints(x, y));
      double& largest = t > low && t < high ? inside : outside;
      largest = std::max(largest, distance);
      if (std::abs(t - (low + high) / 2) > 0.4)
      {
        opposite = std::max(opposite, distance);
      }
    }
    const std::string what = local ? "movable segment" : "raised segment";
    checks.That(inside > 1e-3, Text(what, " changes (", inside, ")"));
    if (local)
    {
      checks.AtMost(outside, 1e-10, what + ": change outside its support");
    }
    else
    {
      // All control points are solved for: the change fades away but does not end.
      checks.That(outside > 1e-6, Text(what, " moves its neighbours (", outside, ")"));
      checks.AtMost(opposite, 1e-6, what + ": change on the opposite side");
    }
    checks.Equal(PointArray(second, 1, "FairingWeight")->GetComponent(25, 0), 1e-4, "weight kept");
    checks.Equal(
      PointArray(second, 1, "FairingWeight")->GetComponent(35, 0), 1e-8, "other weight kept");
  }
}

/// Inserted knots leave the curve as it is. The round that follows is one without a step to make:
/// no control point may move.
void TestKnotInsertion(Checks& checks)
{
  for (const bool closed : { false, true })
  {
    auto points = closed ? ipiatest::StarfishPoints(100, 0.01) : ipiatest::WavePoints(100);
    auto line = ipiatest::ToLine(points, closed);
    auto first = NewFilter(line);
    first->SetNumberOfControlPoints(34);
    first->SetSampleDimensions(3000);
    first->Update();
    vtkNew<vtkPolyData> controls;
    controls->DeepCopy(Output(first, 1));
    ipiatest::AddArray(controls, "Movable", [](vtkIdType) { return 0; });
    auto second = NewFilter(line);
    second->SetControlPointsData(controls);
    second->SetSampleDimensions(3000);
    for (const double knot : { 0.3, 0.31, 0.77, 0.77 })
    {
      second->InsertKnot(knot);
    }
    checks.Equal(second->GetNumberOfInsertedKnots(), 4, "inserted knots");
    ipiatest::Choose(second, 2, 1, "Movable");
    second->Update();
    const std::string what = Text("knots inserted, closed ", closed);
    checks.Equal(Output(second, 1)->GetNumberOfPoints(), 38, what + ": control points");
    checks.AtMost(ipiatest::LargestDistance(first->GetOutput(), second->GetOutput()), 1e-12, what);

    // With control points free again, more of them fit better.
    second->SetInputArrayToProcess(2, 1, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "");
    second->Update();
    checks.AtMost(second->GetFittingError(), first->GetFittingError(), what + ": fitting error");
    second->ClearInsertedKnots();
    second->Update();
    checks.Equal(Output(second, 1)->GetNumberOfPoints(), 34, what + ": control points without");
  }
}

void TestWeightsOfPoints(Checks& checks)
{
  auto line = ipiatest::ToLine(ipiatest::WavePoints(90));
  ipiatest::AddArray(line, "w", [](vtkIdType k) { return k < 45 ? 1e-7 : 1e-3; });
  auto filter = NewFilter(line);
  ipiatest::Choose(filter, 0, 0, "w");
  // The user's weights come first.
  filter->SetAutomaticFairingToSecondDifference();
  filter->Update();
  vtkDataArray* weights = PointArray(filter, 1, "FairingWeight");
  checks.AtMost(
    std::abs(weights->GetComponent(0, 0) / 1e-7 - 1), 1e-12, "weight of the first control point");
  checks.AtMost(
    std::abs(weights->GetComponent(29, 0) / 1e-3 - 1), 1e-12, "weight of the last control point");
  const double middle = weights->GetComponent(15, 0);
  checks.That(
    middle > 1e-7 && middle < 1e-3, Text("weight in the middle lies between (", middle, ")"));
}

void TestAutomaticFairing(Checks& checks)
{
  auto points = ipiatest::CurvePoints(120, false,
    [](double t) {
      return Vector3{ std::cos(3 * t), std::sin(3 * t), 0 };
    });
  points[60][0] *= 0.95;
  points[60][1] *= 0.95;
  for (const int choice :
    { vtkFairingPIAFilter::SecondDifference, vtkFairingPIAFilter::CurvatureVariation })
  {
    auto filter = NewFilter(ipiatest::ToLine(points));
    filter->SetNumberOfControlPoints(40);
    filter->SetFairingWeight(1e-9);
    filter->Update();
    const double plainEnergy = filter->GetFairingEnergy();
    filter->SetAutomaticFairing(choice);
    filter->SetAutomaticShare(0.1);
    filter->SetAutomaticFairingWeight(1e-3);
    filter->Update();
    vtkDataArray* weights = PointArray(filter, 1, "FairingWeight");
    int raised = 0;
    bool near = true;
    for (vtkIdType j = 0; j < 40; ++j)
    {
      if (weights->GetComponent(j, 0) == 1e-3)
      {
        ++raised;
        near = near && std::abs(static_cast<double>(j) - 20) <= 4;
      }
    }
    checks.Equal(raised, 4, Text("choice ", choice, ": control points"));
    checks.That(near, Text("choice ", choice, ": they are at the dent"));

    // A later round has the weights of this one, or chooses anew.
    vtkNew<vtkPolyData> controls;
    controls->DeepCopy(Output(filter, 1));
    ipiatest::AddArray(controls, "FairingWeight", [](vtkIdType) { return 1e-5; });
    auto later = NewFilter(ipiatest::ToLine(points));
    later->SetControlPointsData(controls);
    later->SetFairingWeight(1e-9);
    later->SetAutomaticFairing(choice);
    later->Update();
    checks.Equal(PointArray(later, 1, "FairingWeight")->GetComponent(20, 0), 1e-5, "given weight");
    ipiatest::Choose(later, 1, 1, "");
    later->Update();
    double range[2];
    PointArray(later, 1, "FairingWeight")->GetRange(range);
    checks.That(range[0] == 1e-9 && range[1] == 1e-4, "weights chosen anew");
    checks.AtMost(
      filter->GetFairingEnergy(), 0.5 * plainEnergy, Text("choice ", choice, ": energy"));
  }
}

void TestLinesAndArrays(Checks& checks)
{
  // Two lines in one data set: each as it is alone.
  auto first = ipiatest::ToLine(ipiatest::WavePoints(60));
  auto second = ipiatest::ToLine(ipiatest::StarfishPoints(90, 0.01), true);
  vtkNew<vtkPolyData> both;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  for (vtkPolyData* part : { first.Get(), second.Get() })
  {
    const vtkIdType offset = points->GetNumberOfPoints();
    for (vtkIdType k = 0; k < part->GetNumberOfPoints(); ++k)
    {
      points->InsertNextPoint(part->GetPoint(k));
    }
    vtkNew<vtkIdList> ids;
    part->GetLines()->GetCellAtId(0, ids);
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
    {
      ids->SetId(k, ids->GetId(k) + offset);
    }
    lines->InsertNextCell(ids);
  }
  both->SetPoints(points);
  both->SetLines(lines);
  ipiatest::AddArray(both, "x", [&](vtkIdType k) { return points->GetPoint(k)[0]; });
  auto filter = NewFilter(both);
  filter->SetSampleDimensions(200);
  filter->Update();
  double energy = 0;
  for (const int k : { 0, 1 })
  {
    auto alone = NewFilter(k == 0 ? first : second);
    alone->SetSampleDimensions(200);
    alone->Update();
    energy += alone->GetFairingEnergy();
    double largest = 0;
    for (vtkIdType i = 0; i < 200; ++i)
    {
      double x[3], y[3];
      alone->GetOutput()->GetPoint(i, x);
      filter->GetOutput()->GetPoint(200 * k + i, y);
      largest = std::max(largest, std::sqrt(vtkMath::Distance2BetweenPoints(x, y)));
    }
    checks.Equal(largest, 0.0, Text("line ", k, " of two: difference from it alone"));
  }
  checks.AtMost(std::abs(filter->GetFairingEnergy() - energy), 1e-9 * energy, "energy of both");
  checks.Equal(filter->GetOutput()->GetNumberOfLines(), 2, "lines");
  // An array that is a coordinate of the data points is nearly that of the curve.
  double largest = 0;
  for (vtkIdType i = 0; i < 400; ++i)
  {
    largest = std::max(largest,
      std::abs(
        PointArray(filter, 0, "x")->GetComponent(i, 0) - filter->GetOutput()->GetPoint(i)[0]));
  }
  checks.AtMost(largest, 0.05, "array of the input along the curve");
  checks.That(PointArray(filter, 2, "x") != nullptr, "array of the input on the data points");

  // A second round for both.
  vtkNew<vtkPolyData> controls;
  controls->DeepCopy(Output(filter, 1));
  filter->SetControlPointsData(controls);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(filter);
  filter->Update();
  messages->CheckSilence(checks, "second round of both");
  checks.Equal(
    Output(filter, 1)->GetNumberOfPoints(), controls->GetNumberOfPoints(), "control points");
  checks.AtMost(
    ipiatest::LargestDistance(Output(filter, 1), controls), 1e-6, "second round from the limit");
}

void TestGivenParameters(Checks& checks)
{
  const auto points = ipiatest::WavePoints(80);
  auto line = ipiatest::ToLine(points);
  // Float, and those of chord length: the same curve as computed.
  auto computed = NewFilter(line);
  computed->Update();
  line->GetPointData()->AddArray(PointArray(computed, 2, "Parameter"));
  auto given = NewFilter(line);
  given->SetParametrizationToGiven();
  ipiatest::Choose(given, 3, 0, "Parameter");
  given->Update();
  checks.AtMost(ipiatest::LargestDistance(given->GetOutput(), computed->GetOutput()), 1e-12,
    "given parameters against computed ones");
}

/// Another weight for another unit of length would not do.
void TestUnits(Checks& checks)
{
  const auto points = ipiatest::WavePoints(80);
  auto reference = NewFilter(ipiatest::ToLine(points));
  reference->Update();
  for (const double scale : { 1e-6, 1e5 })
  {
    auto moved = points;
    for (Vector3& x : moved)
    {
      x = { scale * x[0], scale * x[1] + 10 * scale, scale * x[2] };
    }
    auto filter = NewFilter(ipiatest::ToLine(moved));
    filter->Update();
    double largest = 0;
    for (vtkIdType k = 0; k < filter->GetOutput()->GetNumberOfPoints(); ++k)
    {
      double x[3], y[3];
      reference->GetOutput()->GetPoint(k, x);
      filter->GetOutput()->GetPoint(k, y);
      const double back[3] = { y[0] / scale, y[1] / scale - 10, y[2] / scale };
      largest = std::max(largest, std::sqrt(vtkMath::Distance2BetweenPoints(x, back)));
    }
    checks.AtMost(largest, 1e-10, Text("scale ", scale));
  }
}

void TestThreads(Checks& checks)
{
  auto line = ipiatest::ToLine(ipiatest::StarfishPoints(40000, 0.01), true);
  Filter reference;
  for (const int threads : { 1, 2, 4 })
  {
    omp_set_num_threads(threads);
    auto filter = Filter::New();
    filter->SetInputData(line);
    filter->SetFairingWeight(1e-12);
    filter->SetNumberOfControlPoints(8000);
    filter->SetTolerance(0);
    filter->SetMaximumNumberOfIterations(20);
    filter->Update();
    reference = reference ? reference : filter;
    checks.That(ipiatest::SameBits(reference, filter), Text(threads, " thread(s): same bits"));
  }
}
}

int TestFairingPIACurve(int, char*[])
{
  Checks checks;
  TestNothingSet(checks);
  TestCircle(checks);
  TestStarfish(checks);
  TestSegments(checks);
  TestKnotInsertion(checks);
  TestWeightsOfPoints(checks);
  TestAutomaticFairing(checks);
  TestLinesAndArrays(checks);
  TestGivenParameters(checks);
  TestUnits(checks);
  TestThreads(checks);
  return checks.Result();
}
