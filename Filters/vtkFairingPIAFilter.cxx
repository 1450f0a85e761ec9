// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFairingPIAFilter.h"

#include "IPIAFairingRound.h"
#include "IPIAProgress.h"

#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

vtkFairingPIAFilter::vtkFairingPIAFilter()
  : Degree(3)
  , DerivativeOrder(2)
  , Parametrization(Chord)
  , FairingWeight(1e-6)
  , AutomaticFairing(Off)
  , AutomaticShare(0.25)
  , AutomaticFairingWeight(1e-4)
  , Solver(ProgressiveIteration)
  , MaximumNumberOfIterations(1000)
  , Tolerance(1e-6)
  , StepSize(0)
  , FittingError(0)
  , FairingEnergy(0)
  , NumberOfIterationsUsed(0)
  , IterationError(0)
  , Aborted(false)
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
  // Makes the indices known, without an array.
  this->GetInputArrayInformation(3);
  this->SetInputArrayToProcess(1, 1, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "FairingWeight");
}

vtkFairingPIAFilter::~vtkFairingPIAFilter() = default;

void vtkFairingPIAFilter::SetControlPointsConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkFairingPIAFilter::SetControlPointsData(vtkPolyData* controlPoints)
{
  this->SetInputData(1, controlPoints);
}

int vtkFairingPIAFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

ipia::FairingParameters vtkFairingPIAFilter::Parameters() const
{
  ipia::FairingParameters p;
  p.Degree = this->Degree;
  p.DerivativeOrder = this->DerivativeOrder;
  p.FairingWeight = this->FairingWeight;
  p.AutomaticFairing = this->AutomaticFairing;
  p.AutomaticShare = this->AutomaticShare;
  p.AutomaticFairingWeight = this->AutomaticFairingWeight;
  p.Options.Solver = this->Solver == SparseDirect ? ipia::FairingSolver::SparseDirect
    : this->Solver == BiconjugateGradient         ? ipia::FairingSolver::BiconjugateGradient
                                                  : ipia::FairingSolver::ProgressiveIteration;
  p.Options.MaximumNumberOfIterations = this->MaximumNumberOfIterations;
  p.Options.Tolerance = this->Tolerance;
  p.Options.StepSize = this->StepSize;
  return p;
}

bool vtkFairingPIAFilter::Report(double share)
{
  if (!ipia::reportProgress(this, share))
  {
    this->Aborted = true;
  }
  return this->Aborted;
}

void vtkFairingPIAFilter::SetResults(const std::vector<ipia::FairingRound>& rounds)
{
  double squared = 0, count = 0;
  int unfinished = 0, unfinishedChoices = 0;
  this->FairingEnergy = this->IterationError = 0;
  this->NumberOfIterationsUsed = 0;
  for (const ipia::FairingRound& round : rounds)
  {
    squared += round.Residuals.squaredNorm();
    count += static_cast<double>(round.Residuals.rows());
    this->FairingEnergy += round.FairingEnergy;
    this->NumberOfIterationsUsed =
      std::max(this->NumberOfIterationsUsed, round.Result.NumberOfIterations);
    this->IterationError =
      std::max(this->IterationError, round.Result.History.IterationError.back());
    unfinishedChoices += round.ChoiceUnfinished ? 1 : 0;
    unfinished += round.Result.Status == ipia::FairingStatus::NotConverged ? 1 : 0;
  }
  this->FittingError = count > 0 ? std::sqrt(squared / count) : 0.0;
  if (unfinished == 0 && unfinishedChoices > 0)
  {
    vtkWarningMacro("The fit by which AutomaticFairing chose did not reach the tolerance "
      << this->Tolerance << " in " << this->MaximumNumberOfIterations << " iterations ("
      << unfinishedChoices << " of " << rounds.size()
      << " fits). Set a larger MaximumNumberOfIterations or Tolerance.");
  }
  if (unfinished > 0)
  {
    vtkWarningMacro("The iteration did not reach the tolerance "
      << this->Tolerance << ": after " << this->NumberOfIterationsUsed
      << " iterations its error is " << this->IterationError << " times that at the beginning ("
      << unfinished << " of " << rounds.size()
      << " fits). Set a larger MaximumNumberOfIterations or Tolerance, or another Solver.");
  }
}

void vtkFairingPIAFilter::Clear(vtkInformationVector* output)
{
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    vtkPolyData::GetData(output, port)->Initialize();
  }
  this->FittingError = this->FairingEnergy = this->IterationError = 0;
  this->NumberOfIterationsUsed = 0;
}

int vtkFairingPIAFilter::RequestData(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  this->Clear(output);
  this->Aborted = false;
  if (this->Report(0))
  {
    return 1;
  }
  const ipia::FairingParameters parameters = this->Parameters();
  std::string refusal = parameters.refusal();
  if (refusal.empty())
  {
    refusal = this->Fair(input, output, parameters);
  }
  if (!refusal.empty())
  {
    this->Clear(output);
    vtkErrorMacro(<< refusal);
  }
  else if (this->Aborted || this->Report(1))
  {
    this->Clear(output);
  }
  else
  {
    vtkFieldData* field = vtkPolyData::GetData(output, 0)->GetFieldData();
    ipia::addFieldArray(field, "FittingError", std::vector<double>{ this->FittingError });
    ipia::addFieldArray(field, "FairingEnergy", std::vector<double>{ this->FairingEnergy });
    ipia::addFieldArray(
      field, "NumberOfIterationsUsed", std::vector<std::int64_t>{ this->NumberOfIterationsUsed });
  }
  return 1;
}

void vtkFairingPIAFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Degree: " << this->Degree << "\n";
  os << indent << "DerivativeOrder: " << this->DerivativeOrder << "\n";
  os << indent << "Parametrization: " << this->Parametrization << "\n";
  os << indent << "FairingWeight: " << this->FairingWeight << "\n";
  os << indent << "AutomaticFairing: " << this->AutomaticFairing << "\n";
  os << indent << "AutomaticShare: " << this->AutomaticShare << "\n";
  os << indent << "AutomaticFairingWeight: " << this->AutomaticFairingWeight << "\n";
  os << indent << "Solver: " << this->Solver << "\n";
  os << indent << "MaximumNumberOfIterations: " << this->MaximumNumberOfIterations << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "StepSize: " << this->StepSize << "\n";
  os << indent << "FittingError: " << this->FittingError << "\n";
  os << indent << "FairingEnergy: " << this->FairingEnergy << "\n";
  os << indent << "NumberOfIterationsUsed: " << this->NumberOfIterationsUsed << "\n";
  os << indent << "IterationError: " << this->IterationError << "\n";
}
