// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAPanelArrays.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"

namespace ipia
{
HiddenArrays::HiddenArrays(vtkAlgorithm* filter)
  : Filter(filter)
{
}

void HiddenArrays::Take(int index, const char* name)
{
  const std::string chosen = !name ? "" : *name == 0 ? NoArray : name;
  if (chosen != this->Names[index])
  {
    this->Names[index] = chosen;
    this->Filter->Modified();
  }
}

void HiddenArrays::TakeOr(const char* label, int index, const char* name)
{
  this->Take(index, name && *name != 0 && std::string(label) != name ? name : nullptr);
}

void HiddenArrays::Hide(int index, int port, const char* name)
{
  this->Filter->SetInputArrayToProcess(
    index, port, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
  this->Filter->GetInputArrayInformation(index)->Remove(vtkDataObject::FIELD_NAME());
  this->Names[index] = name;
}

HiddenArrays::Shown::Shown(const HiddenArrays& hidden)
  : Filter(hidden.Filter)
{
  for (const auto& [index, name] : hidden.Names)
  {
    if (!name.empty())
    {
      vtkInformation* info = this->Filter->GetInputArrayInformation(index);
      auto& before = this->Before[index];
      before = vtkSmartPointer<vtkInformation>::New();
      before->Copy(info);
      info->Remove(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
      info->Set(vtkDataObject::FIELD_NAME(), name.c_str());
    }
  }
}

HiddenArrays::Shown::~Shown()
{
  for (const auto& [index, before] : this->Before)
  {
    this->Filter->GetInputArrayInformation(index)->Copy(before);
  }
}

void setArrayOrNormals(
  vtkAlgorithm* filter, int index, int port, int connection, int association, const char* name)
{
  // What ParaView has not chosen has the index in place of a name.
  if (index == 0 && (!name || std::to_string(index) == name))
  {
    filter->SetInputArrayToProcess(
      index, port, connection, association, vtkDataSetAttributes::NORMALS);
  }
  else
  {
    filter->vtkAlgorithm::SetInputArrayToProcess(index, port, connection, association, name);
  }
}
}
