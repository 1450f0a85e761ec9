// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPIPIAImplicitFitter.h"

#include "IPIAGather.h"

#include "vtkDataArraySelection.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>

vtkStandardNewMacro(vtkPIPIAImplicitFitter);

namespace
{
constexpr int ImagePorts[] = { 0, 2 };

/// What is announced of an image, in numbers of one type, so that one message takes it.
using Announcement = std::array<double, 12>;

Announcement announcedIn(vtkInformation* info)
{
  Announcement numbers{};
  int extent[6];
  info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
  std::copy_n(extent, 6, numbers.begin());
  info->Get(vtkDataObject::ORIGIN(), numbers.data() + 6);
  info->Get(vtkDataObject::SPACING(), numbers.data() + 9);
  return numbers;
}

void announce(const Announcement& numbers, vtkInformation* info)
{
  int extent[6];
  for (std::size_t k = 0; k < 6; ++k)
  {
    extent[k] = static_cast<int>(numbers[k]);
  }
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  info->Set(vtkDataObject::ORIGIN(), numbers.data() + 6, 3);
  info->Set(vtkDataObject::SPACING(), numbers.data() + 9, 3);
}
}

vtkPIPIAImplicitFitter::vtkPIPIAImplicitFitter()
  : Box(this)
  , Arrays(this)
  , Copies(new ipia::SteadyCopy[2])
  , RanksWithPoints(0)
{
  // The panel names the arrays that are wanted.
  this->GetPointDataArraySelection()->SetUnknownArraySetting(0);
}

vtkPIPIAImplicitFitter::~vtkPIPIAImplicitFitter() = default;

void vtkPIPIAImplicitFitter::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  ipia::setArrayOrNormals(this, index, port, connection, association, name);
}

void vtkPIPIAImplicitFitter::BringInputUpToDate(vtkInformation* outInfo)
{
  vtkMultiProcessController* controller = ipia::parallelController();
  for (int port = 0; controller && port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < this->GetNumberOfInputConnections(port); ++i)
    {
      int producerPort = 0;
      vtkAlgorithm* producer = this->GetInputAlgorithm(port, i, producerPort);
      ipia::requestOwnPart(controller, producer->GetOutputInformation(producerPort));
    }
  }
  this->Superclass::BringInputUpToDate(outInfo);
}

std::unique_ptr<ipia::ReplacedInput> vtkPIPIAImplicitFitter::Steady(vtkInformationVector** input)
{
  auto steady = std::make_unique<ipia::ReplacedInput>(input, this->GetNumberOfInputPorts());
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    steady->Set(port, this->Copies[port].Of(input[port]->GetInformationObject(0)));
  }
  return steady;
}

int vtkPIPIAImplicitFitter::RequestInformation(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkMultiProcessController* controller = ipia::parallelController();
  if (!controller)
  {
    this->BringInputUpToDate(output->GetInformationObject(0));
    this->AnnounceOutputs(this->Steady(input)->Get(), output);
    return 1;
  }
  // Every rank is asked for information, so all meet here; not every rank is asked for data.
  this->BringInputUpToDate(output->GetInformationObject(0));
  ipia::ReplacedInput gathered(input, this->GetNumberOfInputPorts());
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    const bool used = this->GetNumberOfInputConnections(port) > 0;
    const ipia::Gathered points =
      used ? ipia::gatherPoints(controller, vtkDataObject::GetData(input[port])) : ipia::Gathered();
    this->GatheredPoints[port] = points.Data;
    this->RanksWithPoints = port == 0 ? points.RanksWithPoints : this->RanksWithPoints;
    gathered.Set(port, points.Data);
  }
  const bool isFirst = controller->GetLocalProcessId() == 0;
  if (isFirst)
  {
    this->AnnounceOutputs(gathered.Get(), output);
  }
  for (int port : ImagePorts)
  {
    vtkInformation* info = output->GetInformationObject(port);
    Announcement numbers{};
    if (isFirst)
    {
      numbers = announcedIn(info);
    }
    controller->Broadcast(numbers.data(), static_cast<vtkIdType>(numbers.size()), 0);
    announce(numbers, info);
    info->Remove(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT());
  }
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    output->GetInformationObject(port)->Set(
      vtkStreamingDemandDrivenPipeline::TIME_DEPENDENT_INFORMATION(), 1);
  }
  return 1;
}

vtkTypeBool vtkPIPIAImplicitFitter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  const ipia::HiddenArrays::Shown shown(this->Arrays);
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkPIPIAImplicitFitter::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  return ipia::requestOwnParts(input, this->GetNumberOfInputPorts())
    ? 1
    : this->Superclass::RequestUpdateExtent(request, input, output);
}

int vtkPIPIAImplicitFitter::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkMultiProcessController* controller = ipia::parallelController();
  if (!controller)
  {
    return this->Superclass::RequestData(request, this->Steady(input)->Get(), output);
  }
  if (controller->GetLocalProcessId() != 0)
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject::GetData(output, port)->Initialize();
    }
    return 1;
  }
  ipia::ReplacedInput gathered(input, this->GetNumberOfInputPorts());
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    gathered.Set(port, this->GatheredPoints[port]);
  }
  if (this->RanksWithPoints > 1)
  {
    vtkWarningMacro(<< ipia::gatheredWarning(
                      this->RanksWithPoints, controller->GetNumberOfProcesses()));
  }
  return this->Superclass::RequestData(request, gathered.Get(), output);
}

void vtkPIPIAImplicitFitter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->Box.Print(os, indent);
}
