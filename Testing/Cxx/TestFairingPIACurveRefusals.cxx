// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the filter for fair curves refuses and warns of: what both filters do, lines, and knots.
 */
#include "IPIATestFairingRefusals.h"

namespace
{
using ipiatest::CheckRefused;
using ipiatest::Checks;
using ipiatest::CurveFilter;
using ipiatest::NaN;
using ipiatest::Output;
using ipiatest::Text;
using ipiatest::Vector3;
using ipiatest::WarmFilter;

/// A knot that differs by rounding from one that is there counts as that one.
void TestKnotsByRounding(Checks& checks)
{
  const double knot = WarmFilter<CurveFilter>()
                        ->GetOutputDataObject(1)
                        ->GetFieldData()
                        ->GetArray("Knots")
                        ->GetComponent(6, 0);
  auto filter = WarmFilter<CurveFilter>();
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(filter);
  filter->SetSolverToSparseDirect();
  filter->InsertKnot(std::nextafter(knot, 1.0));
  filter->InsertKnot(std::nextafter(knot, 0.0));
  filter->Update();
  messages->CheckSilence(checks, "knot by rounding");
  vtkDataArray* knots = Output(filter, 1)->GetFieldData()->GetArray("Knots");
  checks.Equal(knots->GetComponent(8, 0), knot, "knot by rounding: three-fold");
  filter->InsertKnot(std::nextafter(knot, 1.0));
  filter->Update();
  messages->CheckOneError(checks, "would be there more than 3 times", "knot by rounding");
}

void TestLines(Checks& checks)
{
  const auto refused = [&](const std::string& phrase, const std::vector<Vector3>& points,
                         const std::function<void(CurveFilter)>& more = {})
  {
    CheckRefused<CurveFilter>(checks, phrase, phrase,
      [&](CurveFilter f)
      {
        f->SetInputData(ipiatest::ToLine(points));
        if (more)
        {
          more(f);
        }
      });
  };
  const auto good = ipiatest::WavePoints(30);
  refused("needs 4 at least", ipiatest::WavePoints(3));
  refused("needs 6 at least", ipiatest::WavePoints(5), [](CurveFilter f) { f->SetDegree(5); });
  auto points = good;
  points[7] = points[6];
  refused("Points 6 and 7 follow each other", points);
  points = good;
  points[12][1] = NaN;
  refused("Point 12 of line 0 is not finite", points);
  points[12][1] = std::numeric_limits<double>::infinity();
  refused("Point 12 of line 0 is not finite", points);
  refused(
    "NumberOfControlPoints is 31", good, [](CurveFilter f) { f->SetNumberOfControlPoints(31); });
  refused(
    "NumberOfControlPoints is 2", good, [](CurveFilter f) { f->SetNumberOfControlPoints(2); });
  refused("The knot 1.5 cannot be inserted", good, [](CurveFilter f) { f->InsertKnot(1.5); });
  refused("The knot 0.5 would be there more than 3 times", good,
    [](CurveFilter f)
    {
      for (int k = 0; k < 4; ++k)
      {
        f->InsertKnot(0.5);
      }
    });
  refused("those of 1 curves, the input has 2 lines", good,
    [&](CurveFilter f)
    {
      vtkNew<vtkPolyData> controls;
      controls->DeepCopy(Output(f, 1));
      f->SetControlPointsData(controls);
      vtkPolyData* data = vtkPolyData::SafeDownCast(f->GetInputDataObject(0, 0));
      data->GetLines()->InsertNextCell({ 0, 1, 2, 3, 4, 5 });
      data->Modified();
    });
  for (const vtkIdType id : { vtkIdType(-1), vtkIdType(30), vtkIdType(1) << 40 })
  {
    CheckRefused<CurveFilter>(checks, Text("Line 1 has a point ", id), "ids",
      [&](CurveFilter f)
      {
        auto data = ipiatest::ToLine(good);
        data->GetLines()->InsertNextCell({ 0, 1, 2, 3, 4, id });
        f->SetInputData(data);
      });
  }
  for (const bool empty : { false, true })
  {
    CheckRefused<CurveFilter>(checks, "The input has 0 points", "lines without points",
      [&](CurveFilter f)
      {
        auto data = ipiatest::ToLine(good);
        data->SetPoints(empty ? vtkSmartPointer<vtkPoints>::New() : nullptr);
        f->SetInputData(data);
      });
  }
  CheckRefused<CurveFilter>(checks, "has no lines", "no lines",
    [](CurveFilter f)
    {
      auto data = ipiatest::ToLine(ipiatest::WavePoints(30));
      data->SetLines(nullptr);
      f->SetInputData(data);
    });

  const auto given = [&](
                       const std::string& phrase, const std::function<double(vtkIdType)>& parameter)
  {
    CheckRefused<CurveFilter>(checks, phrase, phrase,
      [&](CurveFilter f)
      {
        auto data = ipiatest::ToLine(good);
        ipiatest::AddArray(data, "t", parameter);
        f->SetInputData(data);
        f->SetParametrizationToGiven();
        ipiatest::Choose(f, 3, 0, "t");
      });
  };
  const auto even = [](vtkIdType k) { return static_cast<double>(k) / 29; };
  given("The parameters of line 0 fall", [&](vtkIdType k) { return k == 9 ? 0.2 : even(k); });
  given("more than Degree knots coincide", [&](vtkIdType k) { return 1e-200 * even(k); });
  given("The parameter of point 29 is 1.1", [&](vtkIdType k) { return k == 29 ? 1.1 : even(k); });
  given("The parameter of point 4 is nan", [&](vtkIdType k) { return k == 4 ? NaN : even(k); });
  given("All parameters of line 0 are 0.5", [](vtkIdType) { return 0.5; });
  given(
    "more than Degree knots coincide", [](vtkIdType k) { return k == 0 ? 0
                                                           : k == 29   ? 1
                                                                       : 0.5; });
}

/// The fit by which control points are chosen is all but energy, which takes more iterations than
/// the round that follows.
void TestChoiceWarning(Checks& checks)
{
  auto filter = WarmFilter<CurveFilter>();
  filter->SetAutomaticFairingToCurvatureVariation();
  filter->SetFairingWeight(0.999);
  filter->SetAutomaticShare(1);
  filter->SetAutomaticFairingWeight(1e-9);
  filter->SetTolerance(1e-3);
  filter->SetMaximumNumberOfIterations(15);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(filter);
  filter->Update();
  messages->CheckOneWarning(checks, "by which AutomaticFairing chose", "unfinished choice");
}
}

int TestFairingPIACurveRefusals(int, char*[])
{
  Checks checks;
  vtkNew<ipiatest::MessageObserver> window;
  ipiatest::WindowWatch watch(window);
  ipiatest::TestSharedRefusals<CurveFilter>(checks, "curve",
    ipiatest::ToLine(ipiatest::WavePoints(2)),
    ipiatest::ToLine(ipiatest::StarfishPoints(90, 0.01), true));
  TestKnotsByRounding(checks);
  TestLines(checks);
  TestChoiceWarning(checks);
  return checks.Result();
}
