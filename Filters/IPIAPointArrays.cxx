// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAPointArrays.h"

#include "Core/Parallel.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace ipia
{
namespace
{
/// Names are how arrays of several blocks belong together and how they are chosen.
bool mayBeCarried(const PointCloud& cloud, vtkPolyData* block, vtkDataArray* array)
{
  vtkPointData* data = block->GetPointData();
  return array && array->GetName() && *array->GetName() &&
    array->GetNumberOfTuples() == block->GetNumberOfPoints() &&
    array->GetNumberOfComponents() > 0 && array != data->GetGlobalIds() &&
    array != data->GetPedigreeIds() &&
    std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) != 0 &&
    std::find(cloud.ChosenArrays.begin(), cloud.ChosenArrays.end(), array) ==
    cloud.ChosenArrays.end();
}

template <typename T>
T rounded(double value)
{
  if constexpr (std::is_integral_v<T>)
  {
    // The ends of 64-bit integers are rounded up as doubles.
    using Limits = std::numeric_limits<T>;
    return value >= static_cast<double>(Limits::max()) ? Limits::max()
      : value <= static_cast<double>(Limits::lowest()) ? Limits::lowest()
                                                       : static_cast<T>(std::round(value));
  }
  else
  {
    return static_cast<T>(value);
  }
}

template <typename T>
void writeValues(T* to, int components, vtkIdType tuples, const double* values, int stride)
{
  parallelChunks(tuples, resolveThreads(0),
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        to[i * components] = rounded<T>(values[i * stride]);
      }
    });
}
}

int PointArray::NumberOfComponents() const
{
  return this->Prototype->GetNumberOfComponents();
}

std::vector<PointArray> choosePointArrays(const PointCloud& cloud, vtkDataArraySelection* selection)
{
  std::vector<PointArray> chosen;
  for (std::size_t b = 0; b < cloud.Blocks.size(); ++b)
  {
    vtkPolyData* block = cloud.Blocks[b];
    for (int i = 0; i < block->GetPointData()->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = block->GetPointData()->GetArray(i);
      if (!mayBeCarried(cloud, block, array) || !selection->ArrayIsEnabled(array->GetName()))
      {
        continue;
      }
      auto found = std::find_if(chosen.begin(), chosen.end(),
        [array](const PointArray& entry)
        { return std::strcmp(entry.Prototype->GetName(), array->GetName()) == 0; });
      if (found == chosen.end())
      {
        PointArray entry;
        entry.Prototype.TakeReference(vtkDataArray::CreateDataArray(array->GetDataType()));
        entry.Prototype->SetName(array->GetName());
        entry.Prototype->SetNumberOfComponents(array->GetNumberOfComponents());
        entry.Prototype->CopyComponentNames(array);
        entry.Attribute = block->GetPointData()->IsArrayAnAttribute(i);
        entry.OfBlocks.assign(cloud.Blocks.size(), nullptr);
        found = chosen.insert(chosen.end(), entry);
      }
      if (found->NumberOfComponents() == array->GetNumberOfComponents())
      {
        found->OfBlocks[b] = array;
      }
    }
  }
  return chosen;
}

vtkSmartPointer<vtkDataArray> newArray(vtkDataArray* prototype, vtkIdType tuples)
{
  auto array = vtkSmartPointer<vtkDataArray>::Take(prototype->NewInstance());
  array->SetName(prototype->GetName());
  array->SetNumberOfComponents(prototype->GetNumberOfComponents());
  array->CopyComponentNames(prototype);
  array->SetNumberOfTuples(tuples);
  return array;
}

void writeComponent(vtkDataArray* array, int component, const double* values, int stride)
{
  const vtkIdType tuples = array->GetNumberOfTuples();
  const int components = array->GetNumberOfComponents();
  switch (array->GetDataType())
  {
    vtkTemplateMacro(writeValues(static_cast<VTK_TT*>(array->GetVoidPointer(0)) + component,
      components, tuples, values, stride));
    default: // bits
      for (vtkIdType i = 0; i < tuples; ++i)
      {
        array->SetComponent(i, component, std::round(values[i * stride]));
      }
  }
}
}
