// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPFairingPIACurveFilter.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPFairingPIACurveFilter);

vtkPFairingPIACurveFilter::vtkPFairingPIACurveFilter()
  : Arrays(this)
{
  this->Arrays.Hide(3, 0, ipia::HiddenArrays::NoArray);
}

vtkPFairingPIACurveFilter::~vtkPFairingPIACurveFilter() = default;

int vtkPFairingPIACurveFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  const int done = this->Superclass::FillInputPortInformation(port, info);
  ipia::takeBlocksAsOne(info);
  return done;
}

vtkTypeBool vtkPFairingPIACurveFilter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  const ipia::HiddenArrays::Shown shown(this->Arrays);
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkPFairingPIACurveFilter::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  return ipia::requestOwnParts(input, this->GetNumberOfInputPorts())
    ? 1
    : this->Superclass::RequestUpdateExtent(request, input, output);
}

int vtkPFairingPIACurveFilter::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  const ipia::FairingInput gathered(this, input);
  if (gathered.Get())
  {
    return this->Superclass::RequestData(request, gathered.Get(), output);
  }
  this->Clear(output);
  return 1;
}
