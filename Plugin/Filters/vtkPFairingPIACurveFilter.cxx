// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPFairingPIACurveFilter.h"

#include "IPIAGather.h"
#include "IPIAPanel.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkPFairingPIACurveFilter);

vtkPFairingPIACurveFilter::vtkPFairingPIACurveFilter()
  : UseMovablePoints(false)
  , Arrays(new ipia::HiddenArrays)
{
  this->Arrays->Hide(this, 1, 1, "FairingWeight");
  this->Arrays->Hide(this, 2, 1, ipia::HiddenArrays::NoArray);
  this->Arrays->Hide(this, 3, 0, ipia::HiddenArrays::NoArray);
}

vtkPFairingPIACurveFilter::~vtkPFairingPIACurveFilter() = default;

int vtkPFairingPIACurveFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  const int done = this->Superclass::FillInputPortInformation(port, info);
  if (ipia::parallelController())
  {
    // Otherwise each rank would be asked for the blocks that it has, and all must meet.
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  }
  return done;
}

void vtkPFairingPIACurveFilter::SetControlPointWeightsArray(const char* name)
{
  this->Arrays->Take(this, 1, name);
}

void vtkPFairingPIACurveFilter::SetMovablePointsArray(const char* name)
{
  this->MovablePoints = name ? name : "";
  this->Arrays->Take(
    this, 2, this->UseMovablePoints ? this->MovablePoints.c_str() : ipia::HiddenArrays::NoArray);
}

void vtkPFairingPIACurveFilter::SetUseMovablePoints(bool use)
{
  this->UseMovablePoints = use;
  this->SetMovablePointsArray(std::string(this->MovablePoints).c_str());
}

void vtkPFairingPIACurveFilter::SetParametersArray(const char* name)
{
  this->Arrays->Take(this, 3, name);
}

vtkTypeBool vtkPFairingPIACurveFilter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  const ipia::HiddenArrays::Shown shown(*this->Arrays, this);
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkPFairingPIACurveFilter::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkMultiProcessController* controller = ipia::parallelController();
  if (!controller)
  {
    return this->Superclass::RequestUpdateExtent(request, input, output);
  }
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < input[port]->GetNumberOfInformationObjects(); ++i)
    {
      ipia::requestOwnPart(controller, input[port]->GetInformationObject(i));
    }
  }
  return 1;
}

int vtkPFairingPIACurveFilter::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkMultiProcessController* controller = ipia::parallelController();
  if (!controller)
  {
    return this->Superclass::RequestData(request, input, output);
  }
  ipia::GatheredShapes gathered(controller, input, this->GetNumberOfInputPorts());
  if (controller->GetLocalProcessId() != 0 || !gathered.Refusal.empty())
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkPolyData::GetData(output, port)->Initialize();
    }
    this->FittingError = this->FairingEnergy = this->IterationError = 0;
    this->NumberOfIterationsUsed = 0;
    if (!gathered.Refusal.empty())
    {
      vtkErrorMacro(<< gathered.Refusal);
    }
    return 1;
  }
  if (gathered.RanksWithPoints > 1)
  {
    vtkWarningMacro(<< ipia::gatheredWarning(
                      gathered.RanksWithPoints, controller->GetNumberOfProcesses()));
  }
  return this->Superclass::RequestData(request, gathered.Input.Get(), output);
}
