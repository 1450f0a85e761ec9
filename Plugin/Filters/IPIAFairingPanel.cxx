// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAFairingPanel.h"

#include "vtkFairingPIAFilter.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"

namespace ipia
{
OptionalArray::OptionalArray(HiddenArrays& arrays, int index, const char* name, bool use)
  : Arrays(arrays)
  , Index(index)
  , Name(name)
  , Use(use)
{
  arrays.Hide(index, 1, use ? name : HiddenArrays::NoArray);
}

void OptionalArray::SetName(const char* name)
{
  this->Name = name ? name : "";
  this->Take();
}

void OptionalArray::SetUse(bool use)
{
  this->Use = use;
  this->Take();
}

void OptionalArray::Take()
{
  this->Arrays.Take(this->Index, this->Use ? this->Name.c_str() : HiddenArrays::NoArray);
}

FairingArrays::FairingArrays(vtkFairingPIAFilter* filter)
  : HiddenArrays(filter)
  , Weights(*this, 1, "FairingWeight", true)
  , Movable(*this, 2, "", false)
{
}

void takeBlocksAsOne(vtkInformation* portInfo)
{
  if (parallelController())
  {
    portInfo->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  }
}

FairingInput::FairingInput(vtkFairingPIAFilter* filter, vtkInformationVector** input)
{
  vtkMultiProcessController* controller = parallelController();
  if (!controller)
  {
    this->Vectors = input;
    return;
  }
  this->Gathered = std::make_unique<ReplacedInput>(input, filter->GetNumberOfInputPorts());
  int ranksWithPoints = 0;
  std::string refusal;
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    // The same on all ranks: connections are those of the session.
    if (input[port]->GetNumberOfInformationObjects() == 0)
    {
      continue;
    }
    const GatheredShape shape = gatherShape(controller, vtkDataObject::GetData(input[port]));
    this->Gathered->Set(port, shape.Data);
    refusal = refusal.empty() ? shape.Refusal : refusal;
    if (port == 0)
    {
      ranksWithPoints = shape.RanksWithPoints;
    }
    else if (shape.NumberOfParts > 1 && refusal.empty())
    {
      refusal = "The control points on port 1 are in several parts, on several ranks of the server "
                "or in several blocks. Connect output 1 of an earlier round.";
    }
  }
  if (!refusal.empty())
  {
    vtkErrorWithObjectMacro(filter, << refusal);
  }
  else if (controller->GetLocalProcessId() == 0)
  {
    if (ranksWithPoints > 1)
    {
      vtkWarningWithObjectMacro(
        filter, << gatheredWarning(ranksWithPoints, controller->GetNumberOfProcesses()));
    }
    this->Vectors = this->Gathered->Get();
  }
}
}
