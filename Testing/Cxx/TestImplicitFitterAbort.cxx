// SPDX-License-Identifier: BSD-3-Clause
/**
 * Progress rises evenly; an abort ends the fit within an iteration and leaves nothing.
 */
#include "IPIATestPipeline.h"

#include "vtkIPIAImplicitFunction.h"

namespace
{
using ipiatest::Checks;
using ipiatest::Method;
using ipiatest::ProgressObserver;
using ipiatest::Text;

vtkSmartPointer<vtkIPIAImplicitFitter> NewLongFit(Method method)
{
  auto fitter = ipiatest::NewFitter(method, ipiatest::SphereCloud(), 24);
  fitter->SetMaximumNumberOfIterations(method == Method::Classic ? 100 : 0);
  return fitter;
}

void TestAbort(Checks& checks, Method method, double share)
{
  auto fitter = NewLongFit(method);
  vtkNew<ProgressObserver> progress;
  progress->AbortAt = share;
  const unsigned long tag = fitter->AddObserver(vtkCommand::ProgressEvent, progress);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->Update();
  const std::string what = Text("abort at ", share, ", ", NameOf(method));
  checks.That(ipiatest::OutputsAreEmpty(fitter), what + ": all outputs are empty");
  messages->CheckSilence(checks, what);
  // One more report may come: that of the end, or of the iteration that was under way.
  const auto late = std::count_if(
    progress->Values.begin(), progress->Values.end(), [&](double value) { return value >= share; });
  checks.AtMost(static_cast<double>(late), 2, what + ": reports after it");

  fitter->RemoveObserver(tag);
  fitter->Update();
  auto fresh = NewLongFit(method);
  fresh->Update();
  checks.That(ipiatest::SameOutputs(fitter, fresh), what + ": the next Update is a whole one");
}

/// A good result does not survive an aborted run.
void TestAbortAfterGoodRun(Checks& checks, Method method)
{
  auto fitter = NewLongFit(method);
  fitter->Update();
  checks.That(ipiatest::OutputsAreSound(fitter), "good run");
  vtkNew<ProgressObserver> progress;
  progress->AbortAt = 0.4;
  fitter->AddObserver(vtkCommand::ProgressEvent, progress);
  fitter->SetGridSize(26, 26, 26);
  fitter->Update();
  checks.That(ipiatest::OutputsAreEmpty(fitter), "abort after a good run: outputs are empty");
  checks.That(!fitter->GetImplicitFunction()->HasControlLattice(),
    "abort after a good run: no function is left");
}

/// Of the classic method in steps of no more than a tenth.
void TestProgress(Checks& checks, int solver)
{
  auto fitter = NewLongFit(Method::Classic);
  fitter->SetSolver(solver);
  fitter->GenerateGradientOn();
  vtkNew<ProgressObserver> progress;
  fitter->AddObserver(vtkCommand::ProgressEvent, progress);
  fitter->Update();
  const auto& values = progress->Values;
  const std::string what = Text("progress with solver ", solver);
  progress->CheckRise(checks, what);
  checks.That(values.size() > 50, Text(what, ": many reports (", values.size(), ")"));
  double largest = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
  {
    largest = std::max(largest, values[i] - values[i - 1]);
  }
  checks.AtMost(largest, 0.1, what + ": largest step");
}

/// Of the hierarchy, on clean data and on noisy ones, which are fitted more than once.
void TestProgressOfLevels(Checks& checks)
{
  for (double noise : { 0., 0.1 })
  {
    auto fitter = ipiatest::NewFitter(
      Method::Default, ipiatest::ToPolyData(ipiatest::NoisySphere(20000, noise)), 70);
    fitter->GenerateGradientOn();
    vtkNew<ProgressObserver> progress;
    fitter->AddObserver(vtkCommand::ProgressEvent, progress);
    fitter->Update();
    const std::string what = Text("progress with noise ", noise);
    progress->CheckRise(checks, what);
    checks.Equal(fitter->GetSmoothingLengthUsed() > 0, noise > 0, what + ": smoothing");
  }
}
}

int TestImplicitFitterAbort(int, char*[])
{
  Checks checks;
  for (Method method : ipiatest::Methods)
  {
    for (double share : { 0.0, 0.06, 0.5, 0.82 })
    {
      TestAbort(checks, method, share);
    }
    TestAbortAfterGoodRun(checks, method);
  }
  TestProgress(checks, vtkIPIAImplicitFitter::ProgressiveIteration);
  TestProgress(checks, vtkIPIAImplicitFitter::ConjugateGradient);
  TestProgressOfLevels(checks);
  return checks.Result();
}
