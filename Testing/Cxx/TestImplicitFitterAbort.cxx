// SPDX-License-Identifier: BSD-3-Clause
/**
 * Progress rises evenly; an abort ends the fit within an iteration and leaves nothing.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkIPIAImplicitFunction.h"

#include <limits>

namespace
{
using ipiatest::Checks;
using ipiatest::Text;

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

  std::vector<double> Values;
  double AbortAt = std::numeric_limits<double>::infinity();
};

vtkSmartPointer<vtkIPIAImplicitFitter> NewFitter()
{
  auto fitter = ipiatest::NewClassicFitter(ipiatest::SphereCloud(), 24);
  fitter->SetMaximumNumberOfIterations(100);
  return fitter;
}

void TestAbort(Checks& checks, double share)
{
  auto fitter = NewFitter();
  vtkNew<ProgressObserver> progress;
  progress->AbortAt = share;
  const unsigned long tag = fitter->AddObserver(vtkCommand::ProgressEvent, progress);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->Update();
  const std::string what = Text("abort at ", share);
  checks.That(ipiatest::OutputsAreEmpty(fitter), what + ": all outputs are empty");
  messages->CheckSilence(checks, what);
  // One more report may come: that of the end, or of the iteration that was under way.
  const auto late = std::count_if(
    progress->Values.begin(), progress->Values.end(), [&](double value) { return value >= share; });
  checks.AtMost(static_cast<double>(late), 2, what + ": reports after it");

  fitter->RemoveObserver(tag);
  fitter->Update();
  auto fresh = NewFitter();
  fresh->Update();
  checks.That(ipiatest::SameOutputs(fitter, fresh), what + ": the next Update is a whole one");
}

/// A good result does not survive an aborted run.
void TestAbortAfterGoodRun(Checks& checks)
{
  auto fitter = NewFitter();
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

void TestProgress(Checks& checks, int solver)
{
  auto fitter = NewFitter();
  fitter->SetSolver(solver);
  fitter->GenerateGradientOn();
  vtkNew<ProgressObserver> progress;
  fitter->AddObserver(vtkCommand::ProgressEvent, progress);
  fitter->Update();
  const auto& values = progress->Values;
  const std::string what = Text("progress with solver ", solver);
  checks.That(values.size() > 50, Text(what, ": many reports (", values.size(), ")"));
  checks.That(std::is_sorted(values.begin(), values.end()), what + " does not fall");
  checks.That(!values.empty() && values.front() < 0.01 && values.back() == 1, what + ": 0 to 1");
  double largest = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
  {
    largest = std::max(largest, values[i] - values[i - 1]);
  }
  checks.AtMost(largest, 0.1, what + ": largest step");
}
}

int TestImplicitFitterAbort(int, char*[])
{
  Checks checks;
  for (double share : { 0.0, 0.06, 0.5, 0.82 })
  {
    TestAbort(checks, share);
  }
  TestAbortAfterGoodRun(checks);
  TestProgress(checks, vtkIPIAImplicitFitter::ProgressiveIteration);
  TestProgress(checks, vtkIPIAImplicitFitter::ConjugateGradient);
  return checks.Result();
}
