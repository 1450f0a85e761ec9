// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPFairingPIASurfaceFilter.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPFairingPIASurfaceFilter);

vtkPFairingPIASurfaceFilter::vtkPFairingPIASurfaceFilter()
  : Arrays(this)
{
}

vtkPFairingPIASurfaceFilter::~vtkPFairingPIASurfaceFilter() = default;

int vtkPFairingPIASurfaceFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  const int done = this->Superclass::FillInputPortInformation(port, info);
  ipia::takeBlocksAsOne(info);
  return done;
}

vtkTypeBool vtkPFairingPIASurfaceFilter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  const ipia::HiddenArrays::Shown shown(this->Arrays);
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkPFairingPIASurfaceFilter::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  return ipia::requestOwnParts(input, this->GetNumberOfInputPorts())
    ? 1
    : this->Superclass::RequestUpdateExtent(request, input, output);
}

int vtkPFairingPIASurfaceFilter::RequestData(
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
