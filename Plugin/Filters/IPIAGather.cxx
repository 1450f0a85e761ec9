// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAGather.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationExecutivePortKey.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cstdint>
#include <vector>

namespace ipia
{
namespace
{
/// The points of a data set and their arrays, as the next block.
void appendPoints(vtkDataObject* data, vtkMultiBlockDataSet* blocks)
{
  auto* points = vtkPointSet::SafeDownCast(data);
  if (!points)
  {
    return;
  }
  vtkNew<vtkPolyData> block;
  block->SetPoints(points->GetPoints());
  block->GetPointData()->ShallowCopy(points->GetPointData());
  blocks->SetBlock(blocks->GetNumberOfBlocks(), block);
}

/// The leaves of a data object, which may be composite or nullptr.
void appendLeaves(vtkDataObject* data, vtkMultiBlockDataSet* blocks)
{
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      appendPoints(iterator->GetCurrentDataObject(), blocks);
    }
  }
  else
  {
    appendPoints(data, blocks);
  }
}

/// What changes if a data set does: its points and point arrays, and when they were changed.
void appendIdentity(vtkDataObject* data, std::vector<vtkMTimeType>& identity)
{
  const auto add = [&identity](vtkObject* part)
  {
    identity.push_back(reinterpret_cast<std::uintptr_t>(part));
    identity.push_back(part ? part->GetMTime() : 0);
  };
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      appendIdentity(iterator->GetCurrentDataObject(), identity);
    }
  }
  else if (auto* points = vtkPointSet::SafeDownCast(data))
  {
    add(points->GetPoints());
    for (int i = 0; i < points->GetPointData()->GetNumberOfArrays(); ++i)
    {
      add(points->GetPointData()->GetAbstractArray(i));
    }
    for (int type : { vtkDataSetAttributes::NORMALS, vtkDataSetAttributes::SCALARS })
    {
      identity.push_back(
        reinterpret_cast<std::uintptr_t>(points->GetPointData()->GetAbstractAttribute(type)));
    }
  }
}

vtkPolyData* blockOf(vtkMultiBlockDataSet* blocks, unsigned int i)
{
  return vtkPolyData::SafeDownCast(blocks->GetBlock(i));
}
}

vtkMultiProcessController* parallelController()
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return controller && controller->GetNumberOfProcesses() > 1 ? controller : nullptr;
}

void requestOwnPart(vtkMultiProcessController* controller, vtkInformation* inputInfo)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  inputInfo->Set(Pipeline::UPDATE_PIECE_NUMBER(), controller->GetLocalProcessId());
  inputInfo->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), controller->GetNumberOfProcesses());
  inputInfo->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
}

Gathered gatherPoints(vtkMultiProcessController* controller, vtkDataObject* part)
{
  vtkNew<vtkMultiBlockDataSet> own;
  appendLeaves(part, own);
  std::vector<vtkSmartPointer<vtkDataObject>> parts;
  controller->Gather(own, parts, 0);

  Gathered gathered;
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkSmartPointer<vtkPolyData> empty;
  for (const auto& received : parts)
  {
    auto* ofRank = vtkMultiBlockDataSet::SafeDownCast(received);
    const unsigned int before = blocks->GetNumberOfBlocks();
    for (unsigned int i = 0; ofRank && i < ofRank->GetNumberOfBlocks(); ++i)
    {
      vtkPolyData* block = blockOf(ofRank, i);
      if (block && block->GetNumberOfPoints() > 0)
      {
        blocks->SetBlock(blocks->GetNumberOfBlocks(), block);
      }
      else if (block)
      {
        empty = block;
      }
    }
    gathered.RanksWithPoints += blocks->GetNumberOfBlocks() > before ? 1 : 0;
  }
  if (blocks->GetNumberOfBlocks() > 1)
  {
    gathered.Data = blocks;
  }
  else
  {
    gathered.Data = blocks->GetNumberOfBlocks() == 1 ? blockOf(blocks, 0) : empty.Get();
  }
  return gathered;
}

vtkDataObject* SteadyCopy::Of(vtkInformation* input)
{
  vtkDataObject* data = input ? vtkDataObject::GetData(input) : nullptr;
  if (!data)
  {
    this->Copy = nullptr;
    return nullptr;
  }
  std::vector<vtkMTimeType> identity;
  // Values changed in place are known to whoever made them: the source.
  vtkExecutive* producer = nullptr;
  int port = 0;
  vtkExecutive::PRODUCER()->Get(input, producer, port);
  if (auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(producer))
  {
    identity.push_back(pipeline->GetPipelineMTime());
  }
  appendIdentity(data, identity);
  if (!this->Copy || identity != this->Identity)
  {
    this->Copy.TakeReference(data->NewInstance());
    this->Copy->ShallowCopy(data);
    this->Identity = identity;
  }
  return this->Copy;
}

ReplacedInput::ReplacedInput(vtkInformationVector** input, int numberOfPorts)
  : NumberOfPorts(numberOfPorts)
  , Vectors(new vtkInformationVector*[static_cast<std::size_t>(numberOfPorts)])
{
  for (int port = 0; port < numberOfPorts; ++port)
  {
    this->Vectors[port] = vtkInformationVector::New();
    this->Vectors[port]->Copy(input[port], 1);
  }
}

ReplacedInput::~ReplacedInput()
{
  for (int port = 0; port < this->NumberOfPorts; ++port)
  {
    this->Vectors[port]->Delete();
  }
  delete[] this->Vectors;
}

void ReplacedInput::Set(int port, vtkDataObject* data)
{
  vtkInformationVector* vector = this->Vectors[port];
  vector->SetNumberOfInformationObjects(data ? 1 : 0);
  if (data)
  {
    vector->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), data);
  }
}

vtkInformationVector** ReplacedInput::Get()
{
  return this->Vectors;
}
}
