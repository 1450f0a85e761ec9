// SPDX-License-Identifier: BSD-3-Clause
/**
 * Composite data sets of point clouds make one fit, that of the appended clouds.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkAppendPolyData.h"
#include "vtkIPIAImplicitFunction.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"

namespace
{
using ipiatest::Checks;
using ipiatest::NewClassicFitter;

/// A part of a sphere: every third point from the given one on.
vtkSmartPointer<vtkPolyData> Third(int first)
{
  const auto sphere = ipiatest::SpherePoints(900);
  ipiatest::OrientedPoints part;
  for (std::size_t i = static_cast<std::size_t>(first); i < sphere.Positions.size(); i += 3)
  {
    part.Add(sphere.Positions[i], sphere.Normals[i]);
  }
  return ipiatest::ToPolyData(part);
}

vtkSmartPointer<vtkIPIAImplicitFitter> FitOfAppended(int blocks)
{
  vtkNew<vtkAppendPolyData> append;
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  for (int i = 0; i < blocks; ++i)
  {
    append->AddInputData(Third(i));
  }
  append->Update();
  auto fitter = NewClassicFitter(append->GetOutput());
  fitter->Update();
  return fitter;
}

void CheckAsAppended(Checks& checks, vtkDataObject* input, int blocks, const std::string& what)
{
  auto fitter = NewClassicFitter(input);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->Update();
  checks.That(ipiatest::SameOutputs(fitter, FitOfAppended(blocks)), what + " is as appended");
  messages->CheckSilence(checks, what);
}

void TestMultiBlock(Checks& checks)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (unsigned i = 0; i < 3; ++i)
  {
    blocks->SetBlock(i, Third(static_cast<int>(i)));
  }
  CheckAsAppended(checks, blocks, 3, "vtkMultiBlockDataSet");
}

void TestSingleBlock(Checks& checks)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, Third(0));
  CheckAsAppended(checks, blocks, 1, "one block");
}

void TestPartitioned(Checks& checks)
{
  vtkNew<vtkPartitionedDataSet> parts;
  for (unsigned i = 0; i < 3; ++i)
  {
    parts->SetPartition(i, Third(static_cast<int>(i)));
  }
  CheckAsAppended(checks, parts, 3, "vtkPartitionedDataSet");
}

void TestNestedWithHoles(Checks& checks)
{
  vtkNew<vtkPolyData> empty;
  vtkNew<vtkMultiBlockDataSet> inner, outer;
  inner->SetBlock(0, Third(1));
  inner->SetBlock(1, nullptr);
  inner->SetBlock(2, Third(2));
  outer->SetBlock(0, Third(0));
  outer->SetBlock(1, empty);
  outer->SetBlock(2, nullptr);
  outer->SetBlock(3, inner);
  CheckAsAppended(checks, outer, 3, "nested blocks, some null or empty");
}

/// Changing the samples alone does not fit the blocks anew; changing a block does.
void TestRefit(Checks& checks)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, Third(0));
  blocks->SetBlock(1, Third(1));
  auto fitter = NewClassicFitter(blocks);
  fitter->Update();
  const vtkMTimeType before = fitter->GetImplicitFunction()->GetMTime();
  fitter->SetSampleDimensions(20, 20, 20);
  fitter->Update();
  checks.Equal(fitter->GetImplicitFunction()->GetMTime(), before,
    "the time of the function after changed samples");

  fitter->SetSampleDimensions(0, 0, 0);
  blocks->SetBlock(2, Third(2));
  fitter->Update();
  checks.That(ipiatest::SameOutputs(fitter, FitOfAppended(3)), "a new block is fitted");
}
}

int TestImplicitFitterComposite(int, char*[])
{
  Checks checks;
  TestMultiBlock(checks);
  TestSingleBlock(checks);
  TestPartitioned(checks);
  TestNestedWithHoles(checks);
  TestRefit(checks);
  return checks.Result();
}
