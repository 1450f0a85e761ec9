// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIPIAImplicitFitter.h"

#include "IPIAAttributes.h"
#include "IPIABrickContour.h"
#include "IPIAFitOutputs.h"
#include "IPIAFitSolution.h"
#include "IPIAIdentity.h"
#include "IPIAProgress.h"
#include "IPIAScanFeathering.h"
#include "IPIAText.h"
#include "vtkIPIAImplicitFunction.h"

#include "vtkCommand.h"
#include "vtkDataArraySelection.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>

vtkStandardNewMacro(vtkIPIAImplicitFitter);

namespace
{
/// Shares of the progress bar: up to the end of the fit; the rest is sampling.
constexpr double ProgressOfRows = 0.05, ProgressOfFit = 0.8;
/// And up to the end of f's, where point arrays are fitted too.
constexpr double ProgressOfFunction = 0.4;

using ipia::text;
}

/// What is kept between updates: the problem and its solution, each with what it depends on.
class vtkIPIAImplicitFitter::Internals
{
public:
  vtkNew<vtkIPIAImplicitFunction> Function;
  vtkNew<vtkDataArraySelection> PointArrays;
  ipia::AttributeFields Attributes;

  std::unique_ptr<ipia::FitProblem> Current;
  std::vector<vtkMTimeType> ProblemIdentity;
  std::vector<double> Feathering; ///< of the last scans that were feathered
  std::vector<vtkMTimeType> FeatheringIdentity;

  std::unique_ptr<ipia::FitSolution<2>> Planar;
  std::unique_ptr<ipia::FitSolution<3>> Spatial;
  /// What points may be added to; nullptr but with Incremental.
  std::unique_ptr<ipia::IncrementalFit<2>> PlanarMemory;
  std::unique_ptr<ipia::IncrementalFit<3>> SpatialMemory;
  /// The points of the fit, if some were left out.
  std::unique_ptr<ipia::PointCloud> WithoutOutliers;
  vtkNew<vtkImageData> ControlLattice;
  std::vector<vtkMTimeType> FitIdentity;
  std::vector<double> FitParameters;
  /// Those of the last fit that failed. Every output port may ask for it again; it failed once.
  std::vector<vtkMTimeType> FailedIdentity;
  std::vector<double> FailedParameters;
  bool HasFailed = false;

  /// Calls action with the fit of either dimension.
  template <typename Action>
  void WithFit(Action&& action) const
  {
    if (this->Planar)
    {
      action(*this->Planar);
    }
    else if (this->Spatial)
    {
      action(*this->Spatial);
    }
  }

  template <int Dim>
  std::unique_ptr<ipia::IncrementalFit<Dim>>& Memory()
  {
    if constexpr (Dim == 2)
    {
      return this->PlanarMemory;
    }
    else
    {
      return this->SpatialMemory;
    }
  }

  void Forget()
  {
    this->PlanarMemory.reset();
    this->SpatialMemory.reset();
  }

  template <int Dim>
  std::unique_ptr<ipia::FitSolution<Dim>>& Slot()
  {
    if constexpr (Dim == 2)
    {
      return this->Planar;
    }
    else
    {
      return this->Spatial;
    }
  }
};

vtkIPIAImplicitFitter::vtkIPIAImplicitFitter()
  : Padding(0.05)
  , GridSize{ 0, 0, 0 }
  , SampleDimensions{ 0, 0, 0 }
  , Dimension(0)
  , NormalConstraint(Gradient)
  , OffsetDistance(0)
  , OffsetValue(0)
  , InwardOffsetDistance(0)
  , InwardOffsetValue(0)
  , BasisType(BSpline)
  , WeightStepSize(0.01)
  , OscillationWeight(0)
  , OscillationStep(Energy)
  , FairingWeight(-1)
  , FairingOrder(2)
  , Solver(ConjugateGradient)
  , NumberOfLevels(0)
  , MaximumNumberOfIterations(0)
  , Tolerance(0)
  , StoppingRule(RelativeResidual)
  , StepSize(0)
  , UseNormalLengths(false)
  , FeatherScans(true)
  , GenerateGradient(false)
  , GenerateSupport(false)
  , OutputScalarType(VTK_FLOAT)
  , FitPointArrays(true)
  , Incremental(false)
  , FunctionOnly(false)
  , State(new Internals)
{
  vtkMath::UninitializeBounds(this->ModelBounds);
  this->ResetResults();
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
  this->SetInputArrayToProcess(ipia::PointCloud::NormalsIndex, 0, 0,
    vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::NORMALS);
  this->SetInputArrayToProcess(ipia::PointCloud::ExtraValuesIndex, 1, 0,
    vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
  this->State->PointArrays->SetUnknownArraySetting(1);
  this->State->PointArrays->AddObserver(
    vtkCommand::ModifiedEvent, this, &vtkIPIAImplicitFitter::Modified);
  // Makes the index known, without an array.
  this->GetInputArrayInformation(ipia::PointCloud::LocalFairingIndex);
}

vtkIPIAImplicitFitter::~vtkIPIAImplicitFitter() = default;

ipia::FitParameters vtkIPIAImplicitFitter::Parameters() const
{
  ipia::FitParameters p;
  std::copy_n(this->ModelBounds, 6, p.ModelBounds.begin());
  p.Padding = this->Padding;
  std::copy_n(this->GridSize, 3, p.GridSize.begin());
  std::copy_n(this->SampleDimensions, 3, p.SampleDimensions.begin());
  p.Dimension = this->Dimension;
  p.NormalConstraint = this->NormalConstraint;
  p.OffsetDistance = this->OffsetDistance;
  p.OffsetValue = this->OffsetValue;
  p.InwardOffsetDistance = this->InwardOffsetDistance;
  p.InwardOffsetValue = this->InwardOffsetValue;
  p.BasisType = this->BasisType;
  p.WeightStepSize = this->WeightStepSize;
  p.OscillationWeight = this->OscillationWeight;
  p.OscillationStep = this->OscillationStep;
  p.FairingWeight = this->FairingWeight;
  p.FairingOrder = this->FairingOrder;
  p.Solver = this->Solver;
  p.NumberOfLevels = this->NumberOfLevels;
  p.MaximumNumberOfIterations = this->MaximumNumberOfIterations;
  p.Tolerance = this->Tolerance;
  p.StoppingRule = this->StoppingRule;
  p.StepSize = this->StepSize;
  p.GenerateGradient = this->GenerateGradient;
  p.GenerateSupport = this->GenerateSupport;
  p.OutputScalarType = this->OutputScalarType;
  p.Incremental = this->Incremental;
  p.FunctionOnly = this->FunctionOnly;
  return p;
}

void vtkIPIAImplicitFitter::SetExtraRowsConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkIPIAImplicitFitter::SetExtraRowsData(vtkPolyData* rows)
{
  this->SetInputData(1, rows);
}

vtkDataArraySelection* vtkIPIAImplicitFitter::GetPointDataArraySelection()
{
  return this->State->PointArrays;
}

vtkIPIAImplicitFunction* vtkIPIAImplicitFitter::GetImplicitFunction()
{
  return this->State->Function;
}

int vtkIPIAImplicitFitter::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  if (port == 0)
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  }
  else
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkIPIAImplicitFitter::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 1 ? "vtkPolyData" : "vtkImageData");
  return 1;
}

vtkTypeBool vtkIPIAImplicitFitter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  // The points, hence an automatic domain, may differ from one time step to the next.
  if (request->Has(vtkStreamingDemandDrivenPipeline::REQUEST_TIME_DEPENDENT_INFORMATION()))
  {
    return this->RequestInformation(request, input, output);
  }
  return this->Superclass::ProcessRequest(request, input, output);
}

void vtkIPIAImplicitFitter::BringInputUpToDate(vtkInformation* outInfo)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const bool timed = outInfo->Has(Pipeline::UPDATE_TIME_STEP()) != 0;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < this->GetNumberOfInputConnections(port); ++i)
    {
      int producerPort = 0;
      vtkAlgorithm* producer = this->GetInputAlgorithm(port, i, producerPort);
      producer->UpdateInformation();
      vtkInformation* info = producer->GetOutputInformation(producerPort);
      if (timed && (info->Has(Pipeline::TIME_STEPS()) || info->Has(Pipeline::TIME_RANGE())))
      {
        info->Set(Pipeline::UPDATE_TIME_STEP(), outInfo->Get(Pipeline::UPDATE_TIME_STEP()));
      }
      producer->Update(producerPort);
    }
  }
}

void vtkIPIAImplicitFitter::FeatherScansOf(ipia::PointCloud& cloud, ipia::Identity identity)
{
  if (!this->FeatherScans || this->Incremental || this->Parameters().isClassic() ||
    !cloud.Refusal.empty() || cloud.Blocks.size() < 2)
  {
    return;
  }
  Internals& state = *this->State;
  identity[0] = this->UseNormalLengths; // of all parameters these change the factors
  identity[1] = 0;
  for (vtkDataArray* array : cloud.ChosenArrays)
  {
    ipia::appendArrayIdentity(array, identity);
  }
  if (identity != state.FeatheringIdentity)
  {
    state.Feathering = ipia::featherFactors(cloud);
    state.FeatheringIdentity = identity;
  }
  cloud.feather(state.Feathering);
}

void vtkIPIAImplicitFitter::PrepareProblem(vtkInformationVector** input)
{
  vtkDataObject* points = vtkDataObject::GetData(input[0]);
  vtkPolyData* extraRows = vtkPolyData::GetData(input[1]);
  std::vector<vtkMTimeType> identity{ this->GetMTime(), this->FunctionOnly };
  ipia::appendIdentity(points, identity);
  ipia::appendIdentity(extraRows, identity);
  if (this->State->Current && identity == this->State->ProblemIdentity)
  {
    return;
  }
  this->State->Current = std::make_unique<ipia::FitProblem>();
  this->State->Current->Cloud.UseNormalLengths = this->UseNormalLengths;
  const auto nameOf = [this](int index)
  {
    const char* name = this->GetInputArrayInformation(index)->Get(vtkDataObject::FIELD_NAME());
    // As ParaView names what is none.
    return name && std::string("None") != name ? std::string(name) : std::string();
  };
  this->State->Current->Cloud.gather([this](int index, vtkDataObject* data)
    { return this->GetInputArrayToProcess(index, data); },
    nameOf, points, extraRows);
  this->FeatherScansOf(this->State->Current->Cloud, identity);
  if (this->FitPointArrays)
  {
    this->State->Current->Arrays =
      ipia::choosePointArrays(this->State->Current->Cloud, this->State->PointArrays);
  }
  this->State->Current->Prepare(this->Parameters());
  this->State->ProblemIdentity = identity;
}

int vtkIPIAImplicitFitter::RequestInformation(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  this->BringInputUpToDate(output->GetInformationObject(0));
  this->AnnounceOutputs(input, output);
  return 1;
}

namespace
{
void announcePlace(const ipia::Frame& frame, const double origin[3], vtkInformation* info)
{
  const std::array<double, 3> world = frame.toWorld(origin);
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> direction = frame.direction();
  info->Set(vtkDataObject::ORIGIN(), world.data(), 3);
  info->Set(vtkDataObject::DIRECTION(), direction.data(), 9);
}
}

void vtkIPIAImplicitFitter::AnnounceOutputs(
  vtkInformationVector** input, vtkInformationVector* output)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* imageInfo = output->GetInformationObject(0);
  this->PrepareProblem(input);
  const ipia::FitProblem& problem = *this->State->Current;

  imageInfo->Set(Pipeline::WHOLE_EXTENT(), problem.WholeExtent, 6);
  announcePlace(problem.Frame, problem.Origin, imageInfo);
  imageInfo->Set(vtkDataObject::SPACING(), problem.SampleSpacing, 3);
  imageInfo->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  vtkDataObject::SetPointDataActiveScalarInfo(imageInfo, this->OutputScalarType, 1);

  vtkInformation* latticeInfo = output->GetInformationObject(2);
  double origin[3];
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool flat = axis == problem.FlatAxis;
    origin[axis] = problem.Origin[axis] - (flat ? 0 : problem.Spacing[axis]);
    extent[2 * axis + 1] = problem.Refusal.empty() ? problem.GridSize[axis] - 1 : -1;
  }
  latticeInfo->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  announcePlace(problem.Frame, origin, latticeInfo);
  latticeInfo->Set(vtkDataObject::SPACING(), problem.Spacing, 3);
  vtkDataObject::SetPointDataActiveScalarInfo(latticeInfo, VTK_DOUBLE, 1);

  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    output->GetInformationObject(port)->Set(Pipeline::TIME_DEPENDENT_INFORMATION(), 1);
  }
}

int vtkIPIAImplicitFitter::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  // Any part of the image needs all points.
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < input[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* info = input[port]->GetInformationObject(i);
      info->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
      info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
      info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    }
  }
  return 1;
}

namespace
{
void addResult(vtkFieldData* field, const char* name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  field->AddArray(array);
}
}

void vtkIPIAImplicitFitter::ResetResults()
{
  this->NumberOfIterationsUsed = 0;
  this->StepSizeUsed = this->EnergyReached = this->AverageError = this->MaximumError = 0;
  this->Oscillation = this->OffsetDistanceUsed = this->WeightStepSizeUsed = 0;
  this->NumberOfLevelsUsed = 0;
  this->NoiseFound = this->SmoothingLengthUsed = 0;
  this->FlippedNormalsFound = this->OutliersFound = 0;
  this->NumberOfPointsAdded = this->NumberOfCoefficientsSolved = 0;
  std::fill_n(this->GridSizeUsed, 3, 0);
  vtkMath::UninitializeBounds(this->ModelBoundsUsed);
}

template <int Dim>
bool vtkIPIAImplicitFitter::FitInDimension()
{
  // Noisy data are fitted again with smoothing; progress stands still until that catches up.
  double farthest = 0;
  const auto progress = [this, &farthest](double share)
  {
    farthest = std::max(farthest, share);
    const double end = this->State->Current->Arrays.empty() ? ProgressOfFit : ProgressOfFunction;
    return ipia::reportProgress(this, ProgressOfRows + (end - ProgressOfRows) * farthest);
  };
  auto& memory = this->State->Memory<Dim>();
  if (!this->Incremental || this->Parameters().isClassic())
  {
    this->State->Forget();
  }
  else if (!memory)
  {
    this->State->Forget();
    memory = std::make_unique<ipia::IncrementalFit<Dim>>();
  }
  auto& slot = this->State->Slot<Dim>();
  slot = std::make_unique<ipia::FitSolution<Dim>>(
    ipia::solve<Dim>(*this->State->Current, this->Parameters(), progress, memory.get()));
  if (!slot->Error.empty())
  {
    vtkErrorMacro(<< slot->Error);
    this->State->HasFailed = true;
  }
  if (!slot->isValid())
  {
    return false;
  }
  if (!slot->Warning.empty())
  {
    vtkWarningMacro(<< slot->Warning);
  }
  this->NumberOfIterationsUsed = slot->Solver.NumberOfIterations;
  this->StepSizeUsed = slot->Solver.StepSize;
  this->EnergyReached = slot->Solver.Energy;
  this->AverageError = slot->AverageError;
  this->MaximumError = slot->MaximumError;
  this->Oscillation = slot->Oscillation;
  this->WeightStepSizeUsed = slot->WeightStepSize;
  this->OffsetDistanceUsed = slot->OffsetDistance;
  this->NumberOfLevelsUsed = slot->NumberOfLevels;
  this->NoiseFound = slot->Noise;
  this->SmoothingLengthUsed = slot->SmoothingLength;
  this->FlippedNormalsFound = slot->FlippedNormals;
  this->OutliersFound = slot->ShareOfOutliers;
  this->State->WithoutOutliers = ipia::withoutPoints(this->State->Current->Cloud, slot->Outliers);
  this->NumberOfPointsAdded = slot->NumberOfPointsAdded;
  this->NumberOfCoefficientsSolved = slot->NumberOfCoefficientsSolved;
  this->State->Function->SetSpline(slot->placed());
  if (slot->Function)
  {
    ipia::toControlLattice(*slot->Function, slot->Place, this->State->ControlLattice);
  }
  return true;
}

bool vtkIPIAImplicitFitter::Fit()
{
  Internals& state = *this->State;
  if (!this->Incremental)
  {
    state.Forget();
  }
  const ipia::FitProblem& problem = *state.Current;
  // What the fit depends on, to reuse it when only the samples change.
  std::vector<vtkMTimeType> identity = state.ProblemIdentity;
  identity[0] = 0; // the filter's own time covers more than the fit's parameters
  for (vtkDataArray* array : problem.Cloud.ChosenArrays)
  {
    ipia::appendArrayIdentity(array, identity);
  }
  std::vector<double> parameters{ this->OffsetDistance, this->OffsetValue,
    this->InwardOffsetDistance, this->InwardOffsetValue, this->WeightStepSize,
    this->OscillationWeight, this->FairingWeight, this->Tolerance, this->StepSize };
  for (int value :
    { this->NormalConstraint, this->BasisType, this->OscillationStep, this->FairingOrder,
      this->Solver, this->NumberOfLevels, this->MaximumNumberOfIterations, this->StoppingRule,
      static_cast<int>(this->GenerateSupport), problem.FlatAxis,
      static_cast<int>(this->UseNormalLengths), static_cast<int>(!problem.Cloud.Feathering.empty()),
      static_cast<int>(problem.staysInBricks(this->Parameters())) })
  {
    parameters.push_back(value);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    parameters.push_back(problem.Origin[axis]);
    parameters.push_back(problem.Spacing[axis]);
    parameters.push_back(problem.GridSize[axis]);
  }
  if ((state.Planar || state.Spatial) && identity == state.FitIdentity &&
    parameters == state.FitParameters)
  {
    return true;
  }

  this->DiscardFit();
  if (state.HasFailed && identity == state.FailedIdentity && parameters == state.FailedParameters)
  {
    return false;
  }
  state.HasFailed = false;
  if (problem.Cloud.LeftOut.Total() + problem.OutsideBounds > 0)
  {
    const auto& left = problem.Cloud.LeftOut;
    std::string parts;
    const auto add = [&parts](vtkIdType count, const char* what)
    {
      if (count > 0)
      {
        parts += text(parts.empty() ? "" : ", ", count, " ", what);
      }
    };
    add(left.NonFinitePoints, "non-finite point(s)");
    add(left.InvalidWeights, "point(s) with a negative or non-finite weight");
    add(left.NonFiniteExtraRows, "non-finite extra row(s)");
    add(problem.OutsideBounds, "point(s) outside ModelBounds");
    add(left.InvalidNormals, "zero or non-finite normal(s) with the rows they would give");
    vtkWarningMacro("Left out of the fit: " << parts << ".");
  }
  const bool done = problem.Dimension == 2 ? this->FitInDimension<2>() : this->FitInDimension<3>();
  if (!done)
  {
    state.FailedIdentity = identity;
    state.FailedParameters = parameters;
    this->DiscardFit();
    state.Forget();
    return false;
  }
  std::copy_n(problem.GridSize, 3, this->GridSizeUsed);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->ModelBoundsUsed[2 * axis] = problem.Origin[axis];
    this->ModelBoundsUsed[2 * axis + 1] = problem.Upper[axis];
  }
  state.FitIdentity = identity;
  state.FitParameters = parameters;
  return true;
}

bool vtkIPIAImplicitFitter::FitAttributes()
{
  Internals& state = *this->State;
  ipia::Identity identity = state.ProblemIdentity;
  // Of all parameters and what is wanted of the fit these change the weights.
  identity[0] = this->UseNormalLengths;
  identity[1] = !state.Current->Cloud.Feathering.empty();
  for (vtkDataArray* array : state.Current->Cloud.ChosenArrays)
  {
    ipia::appendArrayIdentity(array, identity);
  }
  const auto progress = [this](double share)
  {
    return ipia::reportProgress(
      this, ProgressOfFunction + (ProgressOfFit - ProgressOfFunction) * share);
  };
  state.WithFit([&identity](const auto& fit)
    { identity.insert(identity.end(), fit.Outliers.begin(), fit.Outliers.end()); });
  const bool done = state.Attributes.fit(*state.Current, this->FittedCloud(), identity, progress);
  this->WarnOfAttributes();
  if (!done)
  {
    this->DiscardFit();
  }
  return done;
}

void vtkIPIAImplicitFitter::WarnOfAttributes()
{
  const std::string warning = this->State->Attributes.takeWarning();
  if (!warning.empty())
  {
    vtkWarningMacro(<< warning);
  }
}

void vtkIPIAImplicitFitter::EvaluateAttributes(vtkPolyData* surface)
{
  if (surface->GetNumberOfPoints() > 0)
  {
    this->State->Attributes.evaluate(surface->GetPoints(), surface->GetPointData());
    this->WarnOfAttributes();
  }
}

void vtkIPIAImplicitFitter::DiscardFit()
{
  this->State->Planar.reset();
  this->State->Spatial.reset();
  this->State->WithoutOutliers.reset();
  this->State->ControlLattice->Initialize();
  this->State->Function->SetControlLattice(nullptr);
  this->ResetResults();
}

bool vtkIPIAImplicitFitter::SampleImage(vtkImageData* image)
{
  ipia::ImageContents contents;
  contents.ScalarType = this->OutputScalarType;
  contents.Gradient = this->GenerateGradient;
  contents.Support = this->GenerateSupport;
  // Where nothing but the function is wanted, point arrays are evaluated where they are needed.
  contents.Arrays = this->FunctionOnly ? nullptr : &this->State->Attributes;
  const auto progress = [this](double share)
  { return ipia::reportProgress(this, ProgressOfFit + (1 - ProgressOfFit) * share); };
  bool done = false;
  this->State->WithFit([&](const auto& fit)
    { done = ipia::sampleFit(*this->State->Current, fit, contents, progress, image); });
  this->WarnOfAttributes();
  return done;
}

void vtkIPIAImplicitFitter::WriteResults(vtkFieldData* field) const
{
  addResult(field, "NumberOfIterationsUsed", this->NumberOfIterationsUsed);
  addResult(field, "StepSizeUsed", this->StepSizeUsed);
  addResult(field, "Energy", this->EnergyReached);
  addResult(field, "AverageError", this->AverageError);
  addResult(field, "MaximumError", this->MaximumError);
  addResult(field, "Oscillation", this->Oscillation);
  addResult(field, "WeightStepSizeUsed", this->WeightStepSizeUsed);
  addResult(field, "OffsetDistanceUsed", this->OffsetDistanceUsed);
  addResult(field, "NumberOfLevelsUsed", this->NumberOfLevelsUsed);
  addResult(field, "NoiseFound", this->NoiseFound);
  addResult(field, "SmoothingLengthUsed", this->SmoothingLengthUsed);
  addResult(field, "FlippedNormalsFound", this->FlippedNormalsFound);
  addResult(field, "OutliersFound", this->OutliersFound);
  addResult(field, "NumberOfPointsAdded", static_cast<double>(this->NumberOfPointsAdded));
  addResult(
    field, "NumberOfCoefficientsSolved", static_cast<double>(this->NumberOfCoefficientsSolved));
  vtkNew<vtkIntArray> grid;
  grid->SetName("GridSizeUsed");
  grid->SetNumberOfComponents(3);
  grid->InsertNextTypedTuple(this->GridSizeUsed);
  field->AddArray(grid);
  vtkNew<vtkDoubleArray> bounds;
  bounds->SetName("ModelBoundsUsed");
  bounds->SetNumberOfComponents(6);
  bounds->InsertNextTypedTuple(this->ModelBoundsUsed);
  field->AddArray(bounds);
  vtkNew<vtkDoubleArray> history;
  history->SetName("ResidualHistory");
  this->State->WithFit(
    [&](const auto& fit)
    {
      for (double r : fit.Solver.ResidualHistory)
      {
        history->InsertNextValue(r);
      }
    });
  field->AddArray(history);
}

int vtkIPIAImplicitFitter::RequestData(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkImageData* image = vtkImageData::GetData(output, 0);
  vtkPolyData* points = vtkPolyData::GetData(output, 1);
  vtkImageData* lattice = vtkImageData::GetData(output, 2);
  const auto clear = [&]
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject::GetData(output, port)->Initialize();
    }
  };
  clear();

  this->PrepareProblem(input);
  const ipia::FitProblem& problem = *this->State->Current;
  if (!problem.Refusal.empty())
  {
    this->DiscardFit();
    this->State->Forget();
    vtkErrorMacro(<< problem.Refusal);
    return 1;
  }
  if (!ipia::reportProgress(this, 0))
  {
    this->DiscardFit();
    return 1;
  }
  if (!this->Fit() || !this->FitAttributes())
  {
    return 1;
  }

  if (this->IsInBricks())
  {
    this->WriteResults(image->GetFieldData());
    ipia::reportProgress(this, 1);
    return 1;
  }
  vtkInformation* imageInfo = output->GetInformationObject(0);
  int extent[6];
  std::copy_n(problem.WholeExtent, 6, extent);
  if (imageInfo->Has(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT()))
  {
    imageInfo->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
  }
  image->SetExtent(extent);
  ipia::placeImage(problem.Frame, problem.Origin, image);
  image->SetSpacing(problem.SampleSpacing);
  if (!this->SampleImage(image))
  {
    clear();
    return 1;
  }
  this->WriteResults(image->GetFieldData());
  this->State->WithFit([&](const auto& fit)
    { ipia::writeFittedPoints(problem.Cloud, fit.Outliers, this->State->Function, points); });
  lattice->ShallowCopy(this->State->ControlLattice);
  ipia::reportProgress(this, 1);
  return 1;
}

void vtkIPIAImplicitFitter::UpdateFunctionOnly()
{
  this->FunctionOnly = true;
  this->Update();
  this->FunctionOnly = false;
}

bool vtkIPIAImplicitFitter::IsInBricks() const
{
  return this->State->Spatial && !this->State->Spatial->Function;
}

bool vtkIPIAImplicitFitter::ContourBricks(int pointType,
  const std::function<bool(double)>& progress, vtkPolyData* surface,
  std::vector<vtkIdType>& component) const
{
  const ipia::FitSolution<3>& fit = *this->State->Spatial;
  return ipia::contourBricks(*fit.Bricks, fit.Place, pointType, progress, surface, component);
}

const ipia::PointCloud& vtkIPIAImplicitFitter::FittedCloud() const
{
  return this->State->WithoutOutliers ? *this->State->WithoutOutliers : this->State->Current->Cloud;
}

const ipia::Frame& vtkIPIAImplicitFitter::FittedFrame() const
{
  return this->State->Current->Frame;
}

double vtkIPIAImplicitFitter::KnotSpacing() const
{
  double spacing = VTK_DOUBLE_MAX;
  const double* bounds = this->ModelBoundsUsed;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int cells = this->GridSizeUsed[axis] - 3;
    if (cells > 0)
    {
      spacing = std::min(spacing, (bounds[2 * axis + 1] - bounds[2 * axis]) / cells);
    }
  }
  return spacing;
}

void vtkIPIAImplicitFitter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  using ipia::triple;
  const auto bounds = [](const double* b)
  { return text("(", b[0], ", ", b[1], ", ", b[2], ", ", b[3], ", ", b[4], ", ", b[5], ")"); };
  os << indent << "ModelBounds: " << bounds(this->ModelBounds) << "\n";
  os << indent << "Padding: " << this->Padding << "\n";
  os << indent << "GridSize: " << triple(this->GridSize) << "\n";
  os << indent << "SampleDimensions: " << triple(this->SampleDimensions) << "\n";
  os << indent << "Dimension: " << this->Dimension << "\n";
  os << indent << "NormalConstraint: " << this->NormalConstraint << "\n";
  os << indent << "OffsetDistance: " << this->OffsetDistance << "\n";
  os << indent << "OffsetValue: " << this->OffsetValue << "\n";
  os << indent << "InwardOffsetDistance: " << this->InwardOffsetDistance << "\n";
  os << indent << "InwardOffsetValue: " << this->InwardOffsetValue << "\n";
  os << indent << "BasisType: " << this->BasisType << "\n";
  os << indent << "WeightStepSize: " << this->WeightStepSize << "\n";
  os << indent << "OscillationWeight: " << this->OscillationWeight << "\n";
  os << indent << "OscillationStep: " << this->OscillationStep << "\n";
  os << indent << "FairingWeight: " << this->FairingWeight << "\n";
  os << indent << "FairingOrder: " << this->FairingOrder << "\n";
  os << indent << "Solver: " << this->Solver << "\n";
  os << indent << "NumberOfLevels: " << this->NumberOfLevels << "\n";
  os << indent << "MaximumNumberOfIterations: " << this->MaximumNumberOfIterations << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "StoppingRule: " << this->StoppingRule << "\n";
  os << indent << "StepSize: " << this->StepSize << "\n";
  os << indent << "UseNormalLengths: " << this->UseNormalLengths << "\n";
  os << indent << "FeatherScans: " << this->FeatherScans << "\n";
  os << indent << "GenerateGradient: " << this->GenerateGradient << "\n";
  os << indent << "GenerateSupport: " << this->GenerateSupport << "\n";
  os << indent << "OutputScalarType: " << this->OutputScalarType << "\n";
  os << indent << "FitPointArrays: " << this->FitPointArrays << "\n";
  os << indent << "PointDataArraySelection:\n";
  this->State->PointArrays->PrintSelf(os, indent.GetNextIndent());
  os << indent << "Incremental: " << this->Incremental << "\n";
  os << indent << "NumberOfIterationsUsed: " << this->NumberOfIterationsUsed << "\n";
  os << indent << "StepSizeUsed: " << this->StepSizeUsed << "\n";
  os << indent << "Energy: " << this->EnergyReached << "\n";
  os << indent << "AverageError: " << this->AverageError << "\n";
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "Oscillation: " << this->Oscillation << "\n";
  os << indent << "WeightStepSizeUsed: " << this->WeightStepSizeUsed << "\n";
  os << indent << "OffsetDistanceUsed: " << this->OffsetDistanceUsed << "\n";
  os << indent << "NumberOfLevelsUsed: " << this->NumberOfLevelsUsed << "\n";
  os << indent << "NoiseFound: " << this->NoiseFound << "\n";
  os << indent << "SmoothingLengthUsed: " << this->SmoothingLengthUsed << "\n";
  os << indent << "FlippedNormalsFound: " << this->FlippedNormalsFound << "\n";
  os << indent << "OutliersFound: " << this->OutliersFound << "\n";
  os << indent << "NumberOfPointsAdded: " << this->NumberOfPointsAdded << "\n";
  os << indent << "NumberOfCoefficientsSolved: " << this->NumberOfCoefficientsSolved << "\n";
  os << indent << "GridSizeUsed: " << triple(this->GridSizeUsed) << "\n";
  os << indent << "ModelBoundsUsed: " << bounds(this->ModelBoundsUsed) << "\n";
}
