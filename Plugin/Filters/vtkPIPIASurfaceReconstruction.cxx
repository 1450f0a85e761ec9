// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPIPIASurfaceReconstruction.h"

#include "IPIAGather.h"
#include "IPIAPanel.h"
#include "vtkIPIAImplicitFitter.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>

vtkStandardNewMacro(vtkPIPIASurfaceReconstruction);

vtkPIPIASurfaceReconstruction::vtkPIPIASurfaceReconstruction()
  : UsePointBounds(true)
  , ModelBoundsOrigin{ 0, 0, 0 }
  , ModelBoundsLength{ 1, 1, 1 }
  , ExtraValues(new ipia::ExtraValuesChoice)
{
}

vtkPIPIASurfaceReconstruction::~vtkPIPIASurfaceReconstruction() = default;

void vtkPIPIASurfaceReconstruction::SetUsePointBounds(bool use)
{
  this->UsePointBounds = use;
  this->ApplyModelBounds();
}

void vtkPIPIASurfaceReconstruction::SetModelBoundsOrigin(double x, double y, double z)
{
  const double origin[3] = { x, y, z };
  std::copy_n(origin, 3, this->ModelBoundsOrigin);
  this->ApplyModelBounds();
}

void vtkPIPIASurfaceReconstruction::SetModelBoundsLength(double x, double y, double z)
{
  const double length[3] = { x, y, z };
  std::copy_n(length, 3, this->ModelBoundsLength);
  this->ApplyModelBounds();
}

void vtkPIPIASurfaceReconstruction::ApplyModelBounds()
{
  const auto bounds =
    ipia::boundsOfBox(this->UsePointBounds, this->ModelBoundsOrigin, this->ModelBoundsLength);
  this->GetFitter()->SetModelBounds(bounds.data());
}

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

void vtkPIPIASurfaceReconstruction::SetExtraValuesArray(const char* name)
{
  this->ExtraValues->Take(this, name);
}

void vtkPIPIASurfaceReconstruction::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  if (index == 0 && ipia::isUnchosen(index, name))
  {
    this->Superclass::SetInputArrayToProcess(
      index, port, connection, association, vtkDataSetAttributes::NORMALS);
  }
  else
  {
    this->Superclass::SetInputArrayToProcess(index, port, connection, association, name);
  }
}

vtkTypeBool vtkPIPIASurfaceReconstruction::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  const ipia::ExtraValuesChoice::Shown shown(*this->ExtraValues, this);
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkPIPIASurfaceReconstruction::RequestUpdateExtent(
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
  ipia::printBox(
    os, indent, this->UsePointBounds, this->ModelBoundsOrigin, this->ModelBoundsLength);
}
