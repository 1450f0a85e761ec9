// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the fairing filters refuse, with one message and empty outputs; what they warn of; progress,
 * abort, and one object used again.
 */
#include "IPIATestFairing.h"
#include "IPIATestPipeline.h"

#include "vtkCellData.h"
#include "vtkStringArray.h"

#include <limits>

namespace
{
using ipiatest::Checks;
using ipiatest::Constant;
using ipiatest::Output;
using ipiatest::Text;
using ipiatest::Vector3;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

using CurveFilter = vtkSmartPointer<vtkFairingPIACurveFilter>;
using SurfaceFilter = vtkSmartPointer<vtkFairingPIASurfaceFilter>;

/// Input, parameters and chosen arrays as of a new object.
template <typename Filter>
void Reset(Filter filter)
{
  if constexpr (std::is_same_v<Filter, CurveFilter>)
  {
    filter->SetInputData(ipiatest::ToLine(ipiatest::WavePoints(60)));
    filter->SetNumberOfControlPoints(0);
    filter->SetSampleDimensions(0);
  }
  else
  {
    filter->SetInputData(ipiatest::WavyGrid(20, 20));
    filter->SetNumberOfControlPoints(0, 0);
    filter->SetSampleDimensions(0, 0);
  }
  filter->RemoveAllInputConnections(1);
  filter->ClearInsertedKnots();
  filter->SetDegree(3);
  filter->SetDerivativeOrder(2);
  filter->SetParametrizationToChord();
  filter->SetFairingWeight(1e-6);
  filter->SetAutomaticFairingWeight(1e-4);
  filter->SetAutomaticShare(0.25);
  filter->SetSolverToProgressiveIteration();
  filter->SetTolerance(1e-6);
  filter->SetStepSize(0);
  ipiatest::Choose(filter, 0, 0, "");
  ipiatest::Choose(filter, 1, 1, "FairingWeight");
  ipiatest::Choose(filter, 2, 1, "None"); // as ParaView names it
}

/// A filter that has run well, so that what is refused must also be cleared.
template <typename Filter>
Filter WarmFilter()
{
  auto filter = Filter::New();
  if constexpr (std::is_same_v<Filter, CurveFilter>)
  {
    filter->SetInputData(ipiatest::ToLine(ipiatest::WavePoints(60)));
  }
  else
  {
    filter->SetInputData(ipiatest::WavyGrid(20, 20));
  }
  filter->Update();
  return filter;
}

template <typename Filter>
void CheckRefused(Checks& checks, const std::string& phrase, const std::string& what,
  const std::function<void(Filter)>& spoil)
{
  Filter filter = WarmFilter<Filter>();
  checks.That(ipiatest::AllOutputsAreFinite(filter), what + ": good before");
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(filter);
  spoil(filter);
  filter->Update();
  messages->CheckOneError(checks, phrase, what);
  checks.That(ipiatest::AllOutputsAreEmpty(filter), what + ": outputs are empty");
  checks.Equal(filter->GetFittingError(), 0.0, what + ": fitting error");
  checks.Equal(filter->GetNumberOfIterationsUsed(), 0, what + ": iterations");
  Reset(filter);
  filter->Update();
  checks.That(messages->Errors.empty(), what + ", then a good input: no error");
  checks.That(ipiatest::SameBits(filter, WarmFilter<Filter>()), what + ": as new afterwards");
}

/// A copy of the control points, with something done to it, on port 1.
template <typename Filter>
void SpoilControls(Filter filter, const std::function<void(vtkPolyData*)>& spoil)
{
  vtkNew<vtkPolyData> controls;
  controls->DeepCopy(Output(filter, 1));
  spoil(controls);
  filter->SetControlPointsData(controls);
}

/// Moves the points of the input away from the origin.
template <typename Filter>
void ScaleInput(Filter filter, double scale)
{
  auto* data = vtkPointSet::SafeDownCast(filter->GetInputDataObject(0, 0));
  for (vtkIdType k = 0; k < data->GetNumberOfPoints(); ++k)
  {
    double x[3];
    data->GetPoint(k, x);
    data->GetPoints()->SetPoint(k, x[0] * scale, x[1] * scale, x[2] * scale);
  }
  data->Modified();
}

/// Arrays that are not one number per point, of both filters.
template <typename Filter>
void TestArrays(Checks& checks, const std::string& name)
{
  const auto refused = [&](const std::string& phrase, const std::function<void(Filter)>& spoil)
  { CheckRefused<Filter>(checks, phrase, name + ", " + phrase, spoil); };
  const auto data = [](Filter f)
  {
    f->Modified();
    return vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0));
  };
  refused("The array of fairing weights, \"absent\", is not there",
    [](Filter f) { ipiatest::Choose(f, 0, 0, "absent"); });
  refused("\"text\", is a vtkStringArray",
    [&](Filter f)
    {
      vtkNew<vtkStringArray> text;
      text->SetName("text");
      text->SetNumberOfTuples(data(f)->GetNumberOfPoints());
      data(f)->GetPointData()->AddArray(text);
      ipiatest::Choose(f, 0, 0, "text");
    });
  refused("\"w\", is not one of points",
    [&](Filter f)
    {
      data(f)->GetCellData()->AddArray(Constant("w", data(f)->GetNumberOfCells(), 0.5));
      f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "w");
    });
  refused("\"w\", is not one of points",
    [&](Filter f)
    {
      data(f)->GetFieldData()->AddArray(Constant("w", 1, 0.5));
      f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_NONE, "w");
    });
  refused("\"w\" has 3 tuples",
    [&](Filter f)
    {
      data(f)->GetPointData()->AddArray(Constant("w", 3, 0.5));
      ipiatest::Choose(f, 0, 0, "w");
    });
  refused("\"unused\" has 0 tuples",
    [&](Filter f) { data(f)->GetPointData()->AddArray(Constant("unused", 0, 0)); });
  refused("fairing weights, \"w\", has 3 components",
    [&](Filter f)
    {
      data(f)->GetPointData()->AddArray(Constant("w", data(f)->GetNumberOfPoints(), 0.5, 3));
      ipiatest::Choose(f, 0, 0, "w");
    });
  refused("parameters, \"t\", has 4 components",
    [&](Filter f)
    {
      data(f)->GetPointData()->AddArray(Constant("t", data(f)->GetNumberOfPoints(), 0.5, 4));
      ipiatest::Choose(f, 3, 0, "t");
      f->SetParametrizationToGiven();
    });
  for (const vtkIdType tuples : { 0, 3, 100000 })
  {
    refused(Text("\"FairingWeight\", has 1 components and ", tuples, " tuples"),
      [&](Filter f)
      {
        SpoilControls(f,
          [&](vtkPolyData* controls)
          { controls->GetPointData()->AddArray(Constant("FairingWeight", tuples, 0.5)); });
      });
    refused(Text("may move, \"m\", has 1 components and ", tuples, " tuples"),
      [&](Filter f)
      {
        SpoilControls(f,
          [&](vtkPolyData* controls)
          { controls->GetPointData()->AddArray(Constant("m", tuples, 1)); });
        ipiatest::Choose(f, 2, 1, "m");
      });
  }
  refused("may move is nan",
    [](Filter f)
    {
      SpoilControls(f,
        [](vtkPolyData* controls)
        { controls->GetPointData()->AddArray(Constant("m", controls->GetNumberOfPoints(), NaN)); });
      ipiatest::Choose(f, 2, 1, "m");
    });
}

/// What an earlier round cannot have left, and sizes and ranges that are out of reach.
template <typename Filter>
void TestLimits(Checks& checks, const std::string& name)
{
  const auto refused = [&](const std::string& phrase, const std::function<void(Filter)>& spoil)
  { CheckRefused<Filter>(checks, phrase, name + ", " + phrase, spoil); };
  for (const double offset : { -3., -1e9, -4e18, 1e9, 4e18, NaN })
  {
    for (const int tuple : { 0, 1 })
    {
      refused("The KnotOffsets on port 1 go from",
        [&](Filter f)
        {
          SpoilControls(f,
            [&](vtkPolyData* controls)
            {
              vtkDataArray* old = controls->GetFieldData()->GetArray("KnotOffsets");
              auto offsets = Constant("KnotOffsets", old->GetNumberOfTuples(), 0);
              offsets->DeepCopy(old);
              offsets->SetComponent(tuple, 0, offset);
              controls->GetFieldData()->AddArray(offsets);
            });
        });
    }
  }
  for (const double knot : { NaN, std::numeric_limits<double>::infinity() })
  {
    refused("on port 1 are not those of",
      [&](Filter f)
      {
        SpoilControls(f,
          [&](vtkPolyData* controls)
          { controls->GetFieldData()->GetArray("Knots")->SetComponent(5, 0, knot); });
      });
  }
  refused("The Degree of the control points on port 1 is nan",
    [](Filter f)
    {
      SpoilControls(f,
        [](vtkPolyData* controls)
        { controls->GetFieldData()->AddArray(Constant("Degree", 1, NaN)); });
    });
  refused("they must be equal or",
    [](Filter f)
    {
      SpoilControls(f,
        [](vtkPolyData* controls)
        {
          vtkDataArray* knots = controls->GetFieldData()->GetArray("Knots");
          knots->SetComponent(5, 0, std::nextafter(knots->GetComponent(4, 0), 1.0));
        });
    });
  refused("The knots on port 1 ask for",
    [](Filter f)
    {
      SpoilControls(
        f, [](vtkPolyData* controls) { controls->GetPoints()->InsertNextPoint(0, 0, 0); });
    });
  refused("The knots on port 1 ask for",
    [](Filter f)
    { SpoilControls(f, [](vtkPolyData* controls) { controls->SetPoints(nullptr); }); });
  refused("lack the field data",
    [](Filter f) { f->SetControlPointsData(vtkSmartPointer<vtkPolyData>::New()); });
  refused("too far from the data",
    [](Filter f)
    {
      SpoilControls(
        f, [](vtkPolyData* controls) { controls->GetPoints()->SetPoint(4, 1e200, 0, 0); });
    });
  for (const double scale : { 1e-200, 1e155, 1e200 })
  {
    refused("The points have an extent of",
      [&](Filter f)
      {
        ScaleInput<Filter>(f, scale);
        f->Modified();
      });
  }
  refused("The equations have no unique solution",
    [](Filter f)
    {
      f->SetSolverToSparseDirect();
      f->SetFairingWeight(1);
    });
  refused("they must be equal or",
    [](Filter f)
    {
      if constexpr (std::is_same_v<Filter, CurveFilter>)
      {
        f->InsertKnot(1e-200);
      }
      else
      {
        f->InsertKnot(1, 1e-200);
      }
    });
  refused("GiB of memory",
    [](Filter f)
    {
      if constexpr (std::is_same_v<Filter, CurveFilter>)
      {
        f->SetSampleDimensions(2000000000);
      }
      else
      {
        f->SetSampleDimensions(100000, 100000);
      }
    });
}

/// What looks like the above and is right.
template <typename Filter>
void TestAccepted(Checks& checks, const std::string& name)
{
  vtkNew<ipiatest::MessageObserver> messages;
  for (const double scale : { 1e-90, 1e-40, 1e40, 1e90 })
  {
    Filter filter = WarmFilter<Filter>();
    messages->Watch(filter);
    ScaleInput(filter, scale);
    vtkSmartPointer<vtkPolyData> before = vtkSmartPointer<vtkPolyData>::New();
    before->DeepCopy(Output(filter, 0));
    filter->Update();
    const std::string what = Text(name, ", scaled by ", scale);
    checks.That(messages->Errors.empty(), what + ": no error");
    messages->Clear();
    checks.That(ipiatest::AllOutputsAreFinite(filter), what + ": finite");
    // Curvatures are those before, in other units.
    const bool curve = std::is_same_v<Filter, CurveFilter>;
    const char* array = curve ? "Curvature" : "MeanCurvature";
    vtkDataArray* curvature = Output(filter, 0)->GetPointData()->GetArray(array);
    vtkDataArray* expected = before->GetPointData()->GetArray(array);
    for (vtkIdType k = 0; k < expected->GetNumberOfTuples(); k += 37)
    {
      const double value = expected->GetComponent(k, 0);
      checks.AtMost(std::abs(curvature->GetComponent(k, 0) * scale - value),
        1e-6 * (1 + std::abs(value)), what + ": curvature");
    }
  }
  Filter filter = WarmFilter<Filter>();
  messages->Watch(filter);
  filter->SetSolverToBiconjugateGradient();
  filter->SetTolerance(0);
  filter->Update();
  messages->CheckSilence(checks, name + ", conjugate gradients to the end");
  checks.AtMost(filter->GetIterationError(), 1e-10, name + ", conjugate gradients: error");
  // A direct round on its own result has nothing but rounding to solve for.
  filter->SetSolverToSparseDirect();
  for (int round = 0; round < 3; ++round)
  {
    SpoilControls(filter, [](vtkPolyData*) {});
    filter->Update();
    messages->CheckSilence(checks, Text(name, ", direct round ", round));
    checks.That(ipiatest::AllOutputsAreFinite(filter), Text(name, ", direct round ", round));
  }
}

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

/// Of both filters.
template <typename Filter>
void TestParameters(Checks& checks, const std::string& name)
{
  const auto refused = [&](const std::string& phrase, const std::function<void(Filter)>& spoil)
  { CheckRefused<Filter>(checks, phrase, name + ", " + phrase, spoil); };
  refused("FairingWeight is -0.1", [](Filter f) { f->SetFairingWeight(-0.1); });
  refused("FairingWeight is 1.5", [](Filter f) { f->SetFairingWeight(1.5); });
  refused("FairingWeight is nan", [](Filter f) { f->SetFairingWeight(NaN); });
  refused("AutomaticFairingWeight is 2", [](Filter f) { f->SetAutomaticFairingWeight(2); });
  refused("AutomaticShare is -1", [](Filter f) { f->SetAutomaticShare(-1); });
  refused("Tolerance is -1", [](Filter f) { f->SetTolerance(-1); });
  refused("StepSize is nan", [](Filter f) { f->SetStepSize(NaN); });
  refused("DerivativeOrder is 3 and Degree is 2",
    [](Filter f)
    {
      f->SetDegree(2);
      f->SetDerivativeOrder(3);
    });
  refused("diverged", [](Filter f) { f->SetStepSize(1e3); });
  refused("no array of parameters", [](Filter f) { f->SetParametrizationToGiven(); });
  refused("Value 3 of the fairing weights \"w\" is 1.5",
    [](Filter f)
    {
      auto* data = vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0));
      ipiatest::AddArray(data, "w", [](vtkIdType k) { return k == 3 ? 1.5 : 0.5; });
      ipiatest::Choose(f, 0, 0, "w");
      f->Modified();
    });
  refused("Value 0 of the fairing weights \"w\" is nan",
    [](Filter f)
    {
      auto* data = vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0));
      ipiatest::AddArray(data, "w", [](vtkIdType) { return NaN; });
      ipiatest::Choose(f, 0, 0, "w");
      f->Modified();
    });
  refused("lack the field data",
    [](Filter f) { f->SetControlPointsData(ipiatest::ToLine(ipiatest::WavePoints(30))); });
  refused("Value 2 of the fairing weights \"FairingWeight\" is -1",
    [](Filter f)
    {
      vtkNew<vtkPolyData> controls;
      controls->DeepCopy(Output(f, 1));
      controls->GetPointData()->GetArray("FairingWeight")->SetComponent(2, 0, -1);
      f->SetControlPointsData(controls);
    });
  refused("on port 1 are not those of",
    [](Filter f)
    {
      vtkNew<vtkPolyData> controls;
      controls->DeepCopy(Output(f, 1));
      controls->GetFieldData()->GetArray("Knots")->SetComponent(5, 0, 0.99);
      f->SetControlPointsData(controls);
    });
  refused("not finite",
    [](Filter f)
    {
      vtkNew<vtkPolyData> controls;
      controls->DeepCopy(Output(f, 1));
      controls->GetPoints()->SetPoint(4, 0, NaN, 0);
      f->SetControlPointsData(controls);
    });
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

void TestGrids(Checks& checks)
{
  const auto refused = [&](const std::string& phrase, vtkDataObject* data,
                         const std::function<void(SurfaceFilter)>& more = {})
  {
    CheckRefused<SurfaceFilter>(checks, phrase, phrase,
      [&](SurfaceFilter f)
      {
        f->SetInputDataObject(data);
        if (more)
        {
          more(f);
        }
      });
  };
  refused("needs 16 at least", ipiatest::WavyGrid(3, 3));
  refused("The grid has 3 points along v", ipiatest::WavyGrid(20, 3));
  refused("NumberOfControlPoints along u is 21", ipiatest::WavyGrid(20, 20),
    [](SurfaceFilter f) { f->SetNumberOfControlPoints(21, 5); });
  refused("NumberOfControlPoints along v is -3", ipiatest::WavyGrid(20, 20),
    [](SurfaceFilter f) { f->SetNumberOfControlPoints(5, -3); });
  refused("whose points have no order", ipiatest::ToLine(ipiatest::WavePoints(30)));
  auto solid = ipiatest::WavyGrid(20, 20);
  solid->SetDimensions(10, 10, 4);
  refused("has dimensions (10, 10, 4)", solid);
  for (const int n : { 10, 30, 30000 })
  {
    auto other = ipiatest::WavyGrid(20, 20);
    other->SetDimensions(n, n, 1);
    refused("and 400 points", other);
    refused("and 400 points", other, [](SurfaceFilter f) { f->SetParametrizationToGiven(); });
  }
  auto bad = ipiatest::WavyGrid(20, 20);
  bad->GetPoints()->SetPoint(77, NaN, 0, 0);
  refused("Point 77 is not finite", bad);
  refused("points of lines 4 and 5",
    ipiatest::ToGrid(20, 20,
      [](double u, double v) {
        return Vector3{ std::abs(u - 5.0 / 19) < 1e-9 ? 4.0 / 19 : u, v, 0 };
      }));
  refused("points are equal",
    ipiatest::ToGrid(20, 20,
      [](double, double) {
        return Vector3{ 1, 2, 3 };
      }));
  refused("The knot 0 cannot be inserted", ipiatest::WavyGrid(20, 20),
    [](SurfaceFilter f) { f->InsertKnot(1, 0); });

  const auto given = [&](const std::string& phrase, double u, double v)
  {
    refused(phrase, ipiatest::WavyGrid(10, 10),
      [&](SurfaceFilter f)
      {
        auto* data = vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0));
        vtkNew<vtkDoubleArray> uv;
        uv->SetNumberOfComponents(2);
        for (int k = 0; k < 100; ++k)
        {
          uv->InsertNextTuple2(k % 10 / 9.0, k / 10 / 9.0);
        }
        uv->SetTuple2(55, u, v);
        data->GetPointData()->SetTCoords(uv);
        f->SetParametrizationToGiven();
      });
  };
  given("The parameter u of point 55 is 1.2", 1.2, 0.5);
  given("The parameter v of point 55 is -0.1", 0.5, -0.1);
  given("The parameter v of point 55 is nan", 0.5, NaN);
  refused("more than 4 times the 400 points", ipiatest::WavyGrid(20, 20),
    [](SurfaceFilter f)
    {
      auto* data = vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0));
      vtkNew<vtkDoubleArray> uv;
      uv->SetNumberOfComponents(2);
      for (int k = 0; k < 400; ++k)
      {
        uv->InsertNextTuple2(k % 20 / 19.0, k / 20 / 19.0);
      }
      data->GetPointData()->SetTCoords(uv);
      f->SetParametrizationToGiven();
      f->SetNumberOfControlPoints(2000000000, 100000);
    });
}

template <typename Filter>
void TestWarning(Checks& checks, const std::string& name)
{
  Filter filter = WarmFilter<Filter>();
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(filter);
  filter->SetMaximumNumberOfIterations(2);
  filter->Update();
  messages->CheckOneWarning(checks, "did not reach the tolerance", name + ", two iterations");
  checks.That(ipiatest::AllOutputsAreFinite(filter), name + ": the result is there");
  checks.Equal(filter->GetNumberOfIterationsUsed(), 2, name + ": iterations");
  // Who asks for a number of iterations gets it without a word.
  filter->SetTolerance(0);
  filter->Update();
  messages->CheckSilence(checks, name + ", no tolerance");
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

template <typename Filter>
void TestAbort(Checks& checks, const std::string& name)
{
  for (const double share : { 0.0, 0.3, 0.85, 1.0 })
  {
    Filter filter = WarmFilter<Filter>();
    filter->SetTolerance(0);
    filter->SetMaximumNumberOfIterations(100);
    vtkNew<ipiatest::ProgressObserver> progress;
    progress->AbortAt = share;
    const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, progress);
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(filter);
    filter->Update();
    const std::string what = Text(name, ", abort at ", share);
    messages->CheckSilence(checks, what);
    checks.That(ipiatest::AllOutputsAreEmpty(filter), what + ": outputs are empty");
    const auto late = std::count_if(progress->Values.begin(), progress->Values.end(),
      [&](double value) { return value >= share; });
    checks.AtMost(static_cast<double>(late), 2, what + ": reports after it");
    filter->RemoveObserver(tag);
    filter->SetAbortExecute(0);
    filter->Modified();
    filter->Update();
    checks.That(ipiatest::AllOutputsAreFinite(filter), what + ": the next update is a whole one");
  }
  Filter filter = WarmFilter<Filter>();
  filter->Modified();
  vtkNew<ipiatest::ProgressObserver> progress;
  filter->AddObserver(vtkCommand::ProgressEvent, progress);
  filter->Update();
  progress->CheckRise(checks, name + ": progress");
}

/// A second input is as for a new object, and refusals leave no trace.
void TestReuse(Checks& checks)
{
  auto used = WarmFilter<CurveFilter>();
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(used);
  used->SetInputData(ipiatest::ToLine(ipiatest::WavePoints(2)));
  used->Update();
  messages->Clear();
  auto line = ipiatest::ToLine(ipiatest::StarfishPoints(90, 0.01), true);
  used->SetInputData(line);
  used->Update();
  messages->CheckSilence(checks, "reuse");
  auto fresh = CurveFilter::New();
  fresh->SetInputData(line);
  fresh->Update();
  checks.That(ipiatest::SameBits(used, fresh), "reuse: as a new object");

  auto grid = WarmFilter<SurfaceFilter>();
  auto data = ipiatest::WavyGrid(31, 17, 0.01);
  grid->SetInputData(data);
  grid->Update();
  auto other = SurfaceFilter::New();
  other->SetInputData(data);
  other->Update();
  checks.That(ipiatest::SameBits(grid, other), "surface reuse: as a new object");
}
}

int TestFairingPIARefusals(int, char*[])
{
  Checks checks;
  vtkNew<ipiatest::MessageObserver> window;
  ipiatest::WindowWatch watch(window);
  TestParameters<CurveFilter>(checks, "curve");
  TestParameters<SurfaceFilter>(checks, "surface");
  TestArrays<CurveFilter>(checks, "curve");
  TestArrays<SurfaceFilter>(checks, "surface");
  TestLimits<CurveFilter>(checks, "curve");
  TestLimits<SurfaceFilter>(checks, "surface");
  TestAccepted<CurveFilter>(checks, "curve");
  TestAccepted<SurfaceFilter>(checks, "surface");
  TestKnotsByRounding(checks);
  TestLines(checks);
  TestGrids(checks);
  TestWarning<CurveFilter>(checks, "curve");
  TestWarning<SurfaceFilter>(checks, "surface");
  TestChoiceWarning(checks);
  TestAbort<CurveFilter>(checks, "curve");
  TestAbort<SurfaceFilter>(checks, "surface");
  TestReuse(checks);
  return checks.Result();
}
