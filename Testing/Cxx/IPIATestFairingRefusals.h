// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What both fairing filters refuse, with one message and empty outputs; what they warn of;
 * progress, abort, and one object used again.
 */
#ifndef IPIATestFairingRefusals_h
#define IPIATestFairingRefusals_h

#include "IPIATestFairing.h"
#include "IPIATestPipeline.h"

#include "vtkCellData.h"
#include "vtkStringArray.h"

#include <limits>

namespace ipiatest
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

using CurveFilter = vtkSmartPointer<vtkFairingPIACurveFilter>;
using SurfaceFilter = vtkSmartPointer<vtkFairingPIASurfaceFilter>;

/// Input, parameters and chosen arrays as of a new object.
template <typename Filter>
void Reset(Filter filter)
{
  if constexpr (std::is_same_v<Filter, CurveFilter>)
  {
    filter->SetInputData(ToLine(WavePoints(60)));
    filter->SetNumberOfControlPoints(0);
    filter->SetSampleDimensions(0);
  }
  else
  {
    filter->SetInputData(WavyGrid(20, 20));
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
  Choose(filter, 0, 0, "");
  Choose(filter, 1, 1, "FairingWeight");
  Choose(filter, 2, 1, "None"); // as ParaView names it
}

/// A filter that has run well, so that what is refused must also be cleared.
template <typename Filter>
Filter WarmFilter()
{
  auto filter = Filter::New();
  if constexpr (std::is_same_v<Filter, CurveFilter>)
  {
    filter->SetInputData(ToLine(WavePoints(60)));
  }
  else
  {
    filter->SetInputData(WavyGrid(20, 20));
  }
  filter->Update();
  return filter;
}

template <typename Filter>
void CheckRefused(Checks& checks, const std::string& phrase, const std::string& what,
  const std::function<void(Filter)>& spoil)
{
  Filter filter = WarmFilter<Filter>();
  checks.That(AllOutputsAreFinite(filter), what + ": good before");
  vtkNew<MessageObserver> messages;
  messages->Watch(filter);
  spoil(filter);
  filter->Update();
  messages->CheckOneError(checks, phrase, what);
  checks.That(AllOutputsAreEmpty(filter), what + ": outputs are empty");
  checks.Equal(filter->GetFittingError(), 0.0, what + ": fitting error");
  checks.Equal(filter->GetNumberOfIterationsUsed(), 0, what + ": iterations");
  Reset(filter);
  filter->Update();
  checks.That(messages->Errors.empty(), what + ", then a good input: no error");
  checks.That(SameBits(filter, WarmFilter<Filter>()), what + ": as new afterwards");
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

/// Arrays that are not one number per point.
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
    [](Filter f) { Choose(f, 0, 0, "absent"); });
  refused("\"text\", is a vtkStringArray",
    [&](Filter f)
    {
      vtkNew<vtkStringArray> text;
      text->SetName("text");
      text->SetNumberOfTuples(data(f)->GetNumberOfPoints());
      data(f)->GetPointData()->AddArray(text);
      Choose(f, 0, 0, "text");
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
      Choose(f, 0, 0, "w");
    });
  refused("\"unused\" has 0 tuples",
    [&](Filter f) { data(f)->GetPointData()->AddArray(Constant("unused", 0, 0)); });
  refused("fairing weights, \"w\", has 3 components",
    [&](Filter f)
    {
      data(f)->GetPointData()->AddArray(Constant("w", data(f)->GetNumberOfPoints(), 0.5, 3));
      Choose(f, 0, 0, "w");
    });
  refused("parameters, \"t\", has 4 components",
    [&](Filter f)
    {
      data(f)->GetPointData()->AddArray(Constant("t", data(f)->GetNumberOfPoints(), 0.5, 4));
      Choose(f, 3, 0, "t");
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
        Choose(f, 2, 1, "m");
      });
  }
  refused("may move is nan",
    [](Filter f)
    {
      SpoilControls(f,
        [](vtkPolyData* controls)
        { controls->GetPointData()->AddArray(Constant("m", controls->GetNumberOfPoints(), NaN)); });
      Choose(f, 2, 1, "m");
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
  vtkNew<MessageObserver> messages;
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
    checks.That(AllOutputsAreFinite(filter), what + ": finite");
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
    checks.That(AllOutputsAreFinite(filter), Text(name, ", direct round ", round));
  }
}

/// Values that are out of range.
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
      AddArray(data, "w", [](vtkIdType k) { return k == 3 ? 1.5 : 0.5; });
      Choose(f, 0, 0, "w");
      f->Modified();
    });
  refused("Value 0 of the fairing weights \"w\" is nan",
    [](Filter f)
    {
      auto* data = vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0));
      AddArray(data, "w", [](vtkIdType) { return NaN; });
      Choose(f, 0, 0, "w");
      f->Modified();
    });
  refused("lack the field data", [](Filter f) { f->SetControlPointsData(ToLine(WavePoints(30))); });
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

template <typename Filter>
void TestWarning(Checks& checks, const std::string& name)
{
  Filter filter = WarmFilter<Filter>();
  vtkNew<MessageObserver> messages;
  messages->Watch(filter);
  filter->SetMaximumNumberOfIterations(2);
  filter->Update();
  messages->CheckOneWarning(checks, "did not reach the tolerance", name + ", two iterations");
  checks.That(AllOutputsAreFinite(filter), name + ": the result is there");
  checks.Equal(filter->GetNumberOfIterationsUsed(), 2, name + ": iterations");
  // Who asks for a number of iterations gets it without a word.
  filter->SetTolerance(0);
  filter->Update();
  messages->CheckSilence(checks, name + ", no tolerance");
}

template <typename Filter>
void TestAbort(Checks& checks, const std::string& name)
{
  for (const double share : { 0.0, 0.3, 0.85, 1.0 })
  {
    Filter filter = WarmFilter<Filter>();
    filter->SetTolerance(0);
    filter->SetMaximumNumberOfIterations(100);
    vtkNew<ProgressObserver> progress;
    progress->AbortAt = share;
    const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, progress);
    vtkNew<MessageObserver> messages;
    messages->Watch(filter);
    filter->Update();
    const std::string what = Text(name, ", abort at ", share);
    messages->CheckSilence(checks, what);
    checks.That(AllOutputsAreEmpty(filter), what + ": outputs are empty");
    const auto late = std::count_if(progress->Values.begin(), progress->Values.end(),
      [&](double value) { return value >= share; });
    checks.AtMost(static_cast<double>(late), 2, what + ": reports after it");
    filter->RemoveObserver(tag);
    filter->SetAbortExecute(0);
    filter->Modified();
    filter->Update();
    checks.That(AllOutputsAreFinite(filter), what + ": the next update is a whole one");
  }
  Filter filter = WarmFilter<Filter>();
  filter->Modified();
  vtkNew<ProgressObserver> progress;
  filter->AddObserver(vtkCommand::ProgressEvent, progress);
  filter->Update();
  progress->CheckRise(checks, name + ": progress");
}

/// A second input is as for a new object, and refusals leave no trace.
template <typename Filter>
void TestReuse(Checks& checks, vtkDataObject* refused, vtkDataObject* good)
{
  auto used = WarmFilter<Filter>();
  vtkNew<MessageObserver> messages;
  messages->Watch(used);
  used->SetInputDataObject(refused);
  used->Update();
  messages->Clear();
  used->SetInputDataObject(good);
  used->Update();
  messages->CheckSilence(checks, "reuse");
  auto fresh = Filter::New();
  fresh->SetInputDataObject(good);
  fresh->Update();
  checks.That(SameBits(used, fresh), "reuse: as a new object");
}

/// All of the above. @param refused, good  inputs
template <typename Filter>
void TestSharedRefusals(
  Checks& checks, const std::string& name, vtkDataObject* refused, vtkDataObject* good)
{
  TestParameters<Filter>(checks, name);
  TestArrays<Filter>(checks, name);
  TestLimits<Filter>(checks, name);
  TestAccepted<Filter>(checks, name);
  TestWarning<Filter>(checks, name);
  TestAbort<Filter>(checks, name);
  TestReuse<Filter>(checks, refused, good);
}
}

#endif
