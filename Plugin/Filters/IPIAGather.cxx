// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAGather.h"

#include "vtkAppendPolyData.h"
#include "vtkCommunicator.h"
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
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredGrid.h"

#include <algorithm>
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

/// Field data of a block that was a structured grid: its extent.
constexpr char ExtentName[] = "IPIA extent";

/// As appendPoints, with the lines and field data of poly data and the extent of a grid.
void appendShape(vtkDataObject* data, vtkMultiBlockDataSet* blocks)
{
  const unsigned int index = blocks->GetNumberOfBlocks();
  appendPoints(data, blocks);
  if (blocks->GetNumberOfBlocks() == index)
  {
    return;
  }
  auto* block = vtkPolyData::SafeDownCast(blocks->GetBlock(index));
  block->GetFieldData()->ShallowCopy(data->GetFieldData());
  if (auto* shape = vtkPolyData::SafeDownCast(data))
  {
    vtkNew<vtkPolyData> own;
    own->ShallowCopy(shape);
    own->RemoveGhostCells(); // lines that another rank has
    block->SetLines(own->GetLines());
  }
  else if (auto* grid = vtkStructuredGrid::SafeDownCast(data))
  {
    vtkNew<vtkIntArray> extent;
    extent->SetName(ExtentName);
    for (int k = 0; k < 6; ++k)
    {
      extent->InsertNextValue(grid->GetExtent()[k]);
    }
    block->GetFieldData()->AddArray(extent);
  }
}

using Append = void (*)(vtkDataObject*, vtkMultiBlockDataSet*);

/// The leaves of a data object, which may be composite or nullptr.
void appendLeaves(vtkDataObject* data, vtkMultiBlockDataSet* blocks, Append append)
{
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      append(iterator->GetCurrentDataObject(), blocks);
    }
  }
  else
  {
    append(data, blocks);
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

Gathered gather(vtkMultiProcessController* controller, vtkDataObject* part, Append append)
{
  vtkNew<vtkMultiBlockDataSet> own;
  appendLeaves(part, own, append);
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

constexpr char NotOneGrid[] =
  "The pieces of the grid that the ranks of the server or the blocks of the input have do not make "
  "up one grid: ";

/// The grid that pieces make up, whose points and arrays are in `points` one piece after the other,
/// and why there is none. What several pieces have must be the same.
std::string assembleGrid(
  const std::vector<vtkIntArray*>& extents, vtkPolyData* points, vtkStructuredGrid* grid)
{
  int whole[6] = { VTK_INT_MAX, VTK_INT_MIN, VTK_INT_MAX, VTK_INT_MIN, VTK_INT_MAX, VTK_INT_MIN };
  for (vtkIntArray* extent : extents)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      whole[2 * axis] = std::min(whole[2 * axis], extent->GetValue(2 * axis));
      whole[2 * axis + 1] = std::max(whole[2 * axis + 1], extent->GetValue(2 * axis + 1));
    }
  }
  vtkIdType total = 1;
  vtkIdType step[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    step[axis] = total;
    total *= static_cast<vtkIdType>(whole[2 * axis + 1]) - whole[2 * axis] + 1;
    if (total > points->GetNumberOfPoints())
    {
      return std::string(NotOneGrid) + "points are missing.";
    }
  }
  std::vector<vtkIdType> source(static_cast<std::size_t>(total), -1);
  vtkIdType next = 0;
  for (vtkIntArray* extent : extents)
  {
    const int* e = extent->GetPointer(0);
    for (int k = e[4]; k <= e[5]; ++k)
    {
      for (int j = e[2]; j <= e[3]; ++j)
      {
        for (int i = e[0]; i <= e[1]; ++i, ++next)
        {
          vtkIdType& id = source[static_cast<std::size_t>(
            step[0] * (i - whole[0]) + step[1] * (j - whole[2]) + step[2] * (k - whole[4]))];
          double x[3], other[3];
          points->GetPoint(next, x);
          points->GetPoint(id < 0 ? next : id, other);
          if (!std::equal(x, x + 3, other))
          {
            return std::string(NotOneGrid) + "a point of several pieces is not at one place.";
          }
          id = id < 0 ? next : id;
        }
      }
    }
  }
  if (std::find(source.begin(), source.end(), -1) != source.end())
  {
    return std::string(NotOneGrid) + "points are missing.";
  }
  grid->SetExtent(whole);
  vtkNew<vtkPoints> ordered;
  ordered->SetDataType(points->GetPoints()->GetDataType());
  ordered->SetNumberOfPoints(total);
  grid->SetPoints(ordered);
  vtkPointData* arrays = grid->GetPointData();
  arrays->CopyAllOn();
  arrays->CopyAllocate(points->GetPointData(), total);
  for (vtkIdType i = 0; i < total; ++i)
  {
    const vtkIdType id = source[static_cast<std::size_t>(i)];
    ordered->SetPoint(i, points->GetPoint(id));
    arrays->CopyData(points->GetPointData(), id, i);
  }
  arrays->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  return {};
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

bool requestOwnParts(vtkInformationVector** input, int numberOfPorts)
{
  vtkMultiProcessController* controller = parallelController();
  for (int port = 0; controller && port < numberOfPorts; ++port)
  {
    for (int i = 0; i < input[port]->GetNumberOfInformationObjects(); ++i)
    {
      requestOwnPart(controller, input[port]->GetInformationObject(i));
    }
  }
  return controller != nullptr;
}

Gathered gatherPoints(vtkMultiProcessController* controller, vtkDataObject* part)
{
  Gathered gathered = gather(controller, part, appendPoints);
  const int isOfBlocks = vtkCompositeDataSet::SafeDownCast(part) ? 1 : 0;
  int anyOfBlocks = 0;
  controller->Reduce(&isOfBlocks, &anyOfBlocks, 1, vtkCommunicator::MAX_OP, 0);
  auto* pieces = vtkMultiBlockDataSet::SafeDownCast(gathered.Data);
  if (pieces && !anyOfBlocks)
  {
    vtkNew<vtkAppendPolyData> append;
    for (unsigned int i = 0; i < pieces->GetNumberOfBlocks(); ++i)
    {
      append->AddInputData(blockOf(pieces, i));
    }
    append->Update();
    gathered.Data = append->GetOutput();
  }
  return gathered;
}

GatheredShape gatherShape(vtkMultiProcessController* controller, vtkDataObject* part)
{
  const Gathered gathered = gather(controller, part, appendShape);
  GatheredShape shape;
  shape.RanksWithPoints = gathered.RanksWithPoints;
  std::vector<vtkPolyData*> blocks;
  if (auto* several = vtkMultiBlockDataSet::SafeDownCast(gathered.Data))
  {
    for (unsigned int i = 0; i < several->GetNumberOfBlocks(); ++i)
    {
      blocks.push_back(blockOf(several, i));
    }
  }
  else if (auto* one = vtkPolyData::SafeDownCast(gathered.Data))
  {
    blocks.push_back(one);
  }
  shape.NumberOfParts = static_cast<int>(blocks.size());
  std::vector<vtkIntArray*> extents;
  vtkNew<vtkAppendPolyData> append;
  for (vtkPolyData* block : blocks)
  {
    append->AddInputData(block);
    auto* extent = vtkIntArray::SafeDownCast(block->GetFieldData()->GetArray(ExtentName));
    if (extent && block->GetNumberOfPoints() > 0)
    {
      extents.push_back(extent);
    }
  }
  vtkSmartPointer<vtkPolyData> points = vtkSmartPointer<vtkPolyData>::New();
  if (blocks.size() == 1)
  {
    points = blocks.front(); // with its field data
  }
  else if (!blocks.empty())
  {
    append->Update();
    points = append->GetOutput();
  }
  if (extents.empty())
  {
    shape.Data = points;
  }
  else if (extents.size() < blocks.size())
  {
    shape.Refusal = std::string(NotOneGrid) + "some are no structured grids.";
  }
  else
  {
    vtkNew<vtkStructuredGrid> grid;
    shape.Refusal = assembleGrid(extents, points, grid);
    shape.Data = grid;
  }
  return shape;
}

std::string gatheredWarning(int ranksWithPoints, int ranks)
{
  return "The points of " + std::to_string(ranksWithPoints) + " ranks are fitted on the first of " +
    std::to_string(ranks) +
    ", which has all of the output: the result is that of a single rank and takes its memory and "
    "time.";
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
