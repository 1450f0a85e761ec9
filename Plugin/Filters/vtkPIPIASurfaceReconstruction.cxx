// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPIPIASurfaceReconstruction.h"

#include "IPIAGather.h"
#include "vtkIPIAImplicitFitter.h"

#include "vtkDataArraySelection.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkPIPIASurfaceReconstruction);

vtkPIPIASurfaceReconstruction::vtkPIPIASurfaceReconstruction()
  : Box(this->GetFitter())
  , Arrays(this)
{
  // The panel names the arrays that are wanted.
  this->GetPointDataArraySelection()->SetUnknownArraySetting(0);
}

vtkPIPIASurfaceReconstruction::~vtkPIPIASurfaceReconstruction() = default;

void vtkPIPIASurfaceReconstruction::SetGridSize(int x, int y, int z)
{
  this->GetFitter()->SetGridSize(x, y, z);
}

void vtkPIPIASurfaceReconstruction::SetSampleDimensions(int x, int y, int z)
{
  this->GetFitter()->SetSampleDimensions(x, y, z);
}

void vtkPIPIASurfaceReconstruction::SetPadding(double value)
{
  this->GetFitter()->SetPadding(value);
}

void vtkPIPIASurfaceReconstruction::SetDimension(int value)
{
  this->GetFitter()->SetDimension(value);
}

void vtkPIPIASurfaceReconstruction::SetNormalConstraint(int value)
{
  this->GetFitter()->SetNormalConstraint(value);
}

void vtkPIPIASurfaceReconstruction::SetOffsetDistance(double value)
{
  this->GetFitter()->SetOffsetDistance(value);
}

void vtkPIPIASurfaceReconstruction::SetOffsetValue(double value)
{
  this->GetFitter()->SetOffsetValue(value);
}

void vtkPIPIASurfaceReconstruction::SetInwardOffsetDistance(double value)
{
  this->GetFitter()->SetInwardOffsetDistance(value);
}

void vtkPIPIASurfaceReconstruction::SetInwardOffsetValue(double value)
{
  this->GetFitter()->SetInwardOffsetValue(value);
}

void vtkPIPIASurfaceReconstruction::SetBasisType(int value)
{
  this->GetFitter()->SetBasisType(value);
}

void vtkPIPIASurfaceReconstruction::SetWeightStepSize(double value)
{
  this->GetFitter()->SetWeightStepSize(value);
}

void vtkPIPIASurfaceReconstruction::SetOscillationWeight(double value)
{
  this->GetFitter()->SetOscillationWeight(value);
}

void vtkPIPIASurfaceReconstruction::SetOscillationStep(int value)
{
  this->GetFitter()->SetOscillationStep(value);
}

void vtkPIPIASurfaceReconstruction::SetFairingWeight(double value)
{
  this->GetFitter()->SetFairingWeight(value);
}

void vtkPIPIASurfaceReconstruction::SetFairingOrder(int value)
{
  this->GetFitter()->SetFairingOrder(value);
}

void vtkPIPIASurfaceReconstruction::SetSolver(int value)
{
  this->GetFitter()->SetSolver(value);
}

void vtkPIPIASurfaceReconstruction::SetNumberOfLevels(int value)
{
  this->GetFitter()->SetNumberOfLevels(value);
}

void vtkPIPIASurfaceReconstruction::SetMaximumNumberOfIterations(int value)
{
  this->GetFitter()->SetMaximumNumberOfIterations(value);
}

void vtkPIPIASurfaceReconstruction::SetTolerance(double value)
{
  this->GetFitter()->SetTolerance(value);
}

void vtkPIPIASurfaceReconstruction::SetStoppingRule(int value)
{
  this->GetFitter()->SetStoppingRule(value);
}

void vtkPIPIASurfaceReconstruction::SetStepSize(double value)
{
  this->GetFitter()->SetStepSize(value);
}

void vtkPIPIASurfaceReconstruction::SetUseNormalLengths(bool value)
{
  this->GetFitter()->SetUseNormalLengths(value);
}

void vtkPIPIASurfaceReconstruction::SetFeatherScans(bool value)
{
  this->GetFitter()->SetFeatherScans(value);
}

void vtkPIPIASurfaceReconstruction::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  ipia::setArrayOrNormals(this, index, port, connection, association, name);
}

vtkTypeBool vtkPIPIASurfaceReconstruction::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  const ipia::HiddenArrays::Shown shown(this->Arrays);
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkPIPIASurfaceReconstruction::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  return ipia::requestOwnParts(input, this->GetNumberOfInputPorts())
    ? 1
    : this->Superclass::RequestUpdateExtent(request, input, output);
}

int vtkPIPIASurfaceReconstruction::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkMultiProcessController* controller = ipia::parallelController();
  if (!controller)
  {
    return this->Superclass::RequestData(request, input, output);
  }
  ipia::ReplacedInput gathered(input, this->GetNumberOfInputPorts());
  int ranksWithPoints = 0;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    if (this->GetNumberOfInputConnections(port) > 0)
    {
      const ipia::Gathered points =
        ipia::gatherPoints(controller, vtkDataObject::GetData(input[port]));
      gathered.Set(port, points.Data);
      ranksWithPoints = port == 0 ? points.RanksWithPoints : ranksWithPoints;
    }
  }
  if (controller->GetLocalProcessId() != 0)
  {
    vtkPolyData::GetData(output)->Initialize();
    return 1;
  }
  if (ranksWithPoints > 1)
  {
    vtkWarningMacro(<< ipia::gatheredWarning(ranksWithPoints, controller->GetNumberOfProcesses()));
  }
  return this->Superclass::RequestData(request, gathered.Get(), output);
}

void vtkPIPIASurfaceReconstruction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->Box.Print(os, indent);
}
