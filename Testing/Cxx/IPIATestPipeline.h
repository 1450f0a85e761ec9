// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What stands before and beside a filter in a pipeline: a source that changes with time, and an
 * observer of progress that aborts.
 */
#ifndef IPIATestPipeline_h
#define IPIATestPipeline_h

#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace ipiatest
{
/// Points on a sphere that grows and moves with time: radius 1 + t, centre (3 t, 0, 0).
class TimedSphere : public vtkPolyDataAlgorithm
{
public:
  static TimedSphere* New() { VTK_STANDARD_NEW_BODY(TimedSphere); }
  vtkTypeMacro(TimedSphere, vtkPolyDataAlgorithm);

protected:
  TimedSphere() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    const double steps[3] = { 0, 1, 2 }, range[2] = { 0, 2 };
    vtkInformation* info = output->GetInformationObject(0);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), steps, 3);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    const auto key = vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP();
    const double time = info->Has(key) ? info->Get(key) : 0;
    vtkPolyData* data = vtkPolyData::GetData(output, 0);
    data->ShallowCopy(SphereCloud(600, 1 + time, { 3 * time, 0, 0 }));
    data->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    return 1;
  }
};

/// The surface is one closed sphere; the largest error of its vertices is below 1% of its radius.
inline void CheckSphere(
  Checks& checks, vtkPolyData* surface, double radius, double centre, const std::string& what)
{
  checks.Equal(TopologyOf(surface), Topology{ 1, 0, 0, 0 }, what);
  double largest = 0;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double x[3];
    surface->GetPoint(i, x);
    x[0] -= centre;
    largest = std::max(largest, std::abs(vtkMath::Norm(x) - radius));
  }
  checks.AtMost(largest, 0.01 * radius, what + ": largest distance");
}

/// Forwards, backwards and twice the same, at the end of a chain.
inline void CheckTimeSteps(
  Checks& checks, vtkAlgorithm* source, vtkAlgorithm* filter, vtkPolyDataAlgorithm* surface)
{
  vtkNew<MessageObserver> messages;
  for (vtkAlgorithm* algorithm : { source, filter, static_cast<vtkAlgorithm*>(surface) })
  {
    messages->Watch(algorithm);
  }
  for (double time : { 0., 1., 2., 2., 0., 1. })
  {
    surface->UpdateTimeStep(time);
    CheckSphere(checks, surface->GetOutput(), 1 + time, 3 * time,
      Text("time ", time, " of ", filter->GetClassName(), " by ", surface->GetClassName()));
  }
  messages->CheckSilence(checks, Text("time steps of ", filter->GetClassName()));
}

/// Keeps all values of the progress and aborts where it is told to.
class ProgressObserver : public vtkCommand
{
public:
  static ProgressObserver* New() { return new ProgressObserver; }
  vtkTypeMacro(ProgressObserver, vtkCommand);

  void Execute(vtkObject* caller, unsigned long, void*) override
  {
    auto* algorithm = static_cast<vtkAlgorithm*>(caller);
    this->Values.push_back(algorithm->GetProgress());
    if (algorithm->GetProgress() >= this->AbortAt)
    {
      algorithm->SetAbortExecute(1);
    }
  }

  /// Progress rises from 0 to 1 and never falls.
  void CheckRise(Checks& checks, const std::string& what) const
  {
    checks.That(std::is_sorted(this->Values.begin(), this->Values.end()), what + " does not fall");
    checks.That(!this->Values.empty() && this->Values.front() < 0.01 && this->Values.back() == 1,
      what + ": 0 to 1");
  }

  std::vector<double> Values;
  double AbortAt = std::numeric_limits<double>::infinity();
};
}

#endif
