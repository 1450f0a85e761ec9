// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIPIAImplicitFitter.h"

#include "Core/AutomaticLattice.h"
#include "Core/ImplicitFit.h"
#include "IPIAControlLattice.h"
#include "IPIAPointCloud.h"
#include "vtkIPIAImplicitFunction.h"

#include "vtkCellArray.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkVersion.h"

#include "vtksys/SystemInformation.hxx"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

vtkStandardNewMacro(vtkIPIAImplicitFitter);

namespace
{
/// The automatic knot spacing in units of the point spacing: about 2.5 points per occupied cell.
constexpr double SpacingPerPoint = 1.6;
/// Limits of an automatic lattice: knot spacings along the longest side of the points.
constexpr double FewestSpacings = 8, MostSpacings = 256;
/// Distance of the automatic offset rows, in knot spacings.
constexpr double OffsetInSpacings = 1.5;
/// Iterations that fit well without following the noise; conjugate gradients converge much faster.
constexpr int AutomaticProgressiveIterations = 100, AutomaticConjugateIterations = 15;
/// No more samples than this unless the user asks for them.
constexpr double MostAutomaticSamples = 268435456; // 2^28
/// Share of the machine's memory that a fit may be expected to take.
constexpr double MemoryShare = 0.9;
/// Bytes that the fit needs per coefficient and per row, all its arrays together.
constexpr double BytesPerCoefficient = 96, BytesPerRow = 160;
/// Shares of the progress bar: up to the end of the iteration, and of the sampling.
constexpr double ProgressOfRows = 0.05, ProgressOfFit = 0.8;

template <typename... Parts>
std::string text(const Parts&... parts)
{
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

std::string triple(const double* v)
{
  return text("(", v[0], ", ", v[1], ", ", v[2], ")");
}

double memoryOfMachine()
{
  vtksys::SystemInformation information;
  information.RunMemoryCheck();
  return 1024.0 * static_cast<double>(information.GetHostMemoryTotal());
}

/// Everything a result depends on that identifies data: what it was made of and when.
void appendIdentity(vtkDataObject* data, std::vector<vtkMTimeType>& identity)
{
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      appendIdentity(iterator->GetCurrentDataObject(), identity);
    }
  }
  identity.push_back(reinterpret_cast<std::uintptr_t>(data));
  identity.push_back(data ? data->GetMTime() : 0);
}

void appendArrayIdentity(vtkDataArray* array, std::vector<vtkMTimeType>& identity)
{
  identity.push_back(reinterpret_cast<std::uintptr_t>(array));
  identity.push_back(array ? array->GetMTime() : 0);
}

/// The result of a fit in either dimension.
template <int Dim>
struct PlacedFit
{
  ipia::Placement<Dim> Place;
  ipia::FitResult<Dim> Result;
};
}

/// The input and the domain, lattice and samples that follow from it and from the parameters.
class vtkIPIAImplicitFitter::Problem
{
public:
  ipia::PointCloud Cloud;
  std::string Refusal; ///< empty if the problem can be solved
  vtkIdType OutsideBounds = 0;

  int Dimension = 3;
  int FlatAxis = -1; ///< the axis across the plane in 2-D
  double Origin[3] = { 0, 0, 0 };
  double Upper[3] = { 0, 0, 0 };
  double Spacing[3] = { 1, 1, 1 };
  int GridSize[3] = { 1, 1, 1 };
  double SampleSpacing[3] = { 1, 1, 1 };
  int WholeExtent[6] = { 0, -1, 0, -1, 0, -1 };

  void Prepare(const vtkIPIAImplicitFitter& parameters);

private:
  void ChooseDimension(const vtkIPIAImplicitFitter& parameters);
  template <int Dim>
  void ChooseLattice(const vtkIPIAImplicitFitter& parameters);
  void ChooseSamples(const vtkIPIAImplicitFitter& parameters);
  void DropPointsOutside();
  void CheckMemory(const vtkIPIAImplicitFitter& parameters);
};

void vtkIPIAImplicitFitter::Problem::Prepare(const vtkIPIAImplicitFitter& parameters)
{
  this->Refusal = this->Cloud.Refusal;
  const auto step = [this](auto&& action)
  {
    if (this->Refusal.empty())
    {
      action();
    }
  };
  step([&] { this->ChooseDimension(parameters); });
  step(
    [&]
    {
      if (this->Dimension == 2)
      {
        this->ChooseLattice<2>(parameters);
      }
      else
      {
        this->ChooseLattice<3>(parameters);
      }
    });
  step([&] { this->ChooseSamples(parameters); });
  step([&] { this->CheckMemory(parameters); });
  step([&] { this->DropPointsOutside(); });
  if (!this->Refusal.empty())
  {
    const int none[6] = { 0, -1, 0, -1, 0, -1 };
    std::copy_n(none, 6, this->WholeExtent);
  }
}

void vtkIPIAImplicitFitter::Problem::ChooseDimension(const vtkIPIAImplicitFitter& parameters)
{
  const int flat = this->Cloud.flatAxis();
  if (parameters.Dimension == 2 && flat < 0)
  {
    const int thin = this->Cloud.axisWithoutExtent();
    this->Refusal = thin < 0
      ? "Dimension is 2, but the points do not lie in a plane perpendicular to an axis."
      : text("Dimension is 2, but normals point out of the plane of the points (along axis ", thin,
          ").");
    return;
  }
  this->Dimension = parameters.Dimension == 3 || flat < 0 ? 3 : 2;
  this->FlatAxis = this->Dimension == 2 ? flat : -1;
  if (this->Dimension == 3 && this->Cloud.isLine())
  {
    this->Refusal = text("All ", this->Cloud.Positions.size(),
      " points lie on a line; a surface needs points off it.");
  }
}

template <int Dim>
void vtkIPIAImplicitFitter::Problem::ChooseLattice(const vtkIPIAImplicitFitter& parameters)
{
  const auto place = ipia::Placement<Dim>::withFlatAxis(this->FlatAxis);
  const double* bounds = parameters.ModelBounds;
  bool automatic = true;
  ipia::Box<Dim> box, model;
  ipia::Index<Dim> size;
  for (int a = 0; a < Dim; ++a)
  {
    const auto i = static_cast<std::size_t>(a);
    const auto axis = static_cast<std::size_t>(place.Axis[i]);
    box.Lower[a] = this->Cloud.Bounds[2 * axis];
    box.Upper[a] = this->Cloud.Bounds[2 * axis + 1];
    model.Lower[a] = bounds[2 * axis];
    model.Upper[a] = bounds[2 * axis + 1];
    automatic = automatic && !(bounds[2 * axis] <= bounds[2 * axis + 1]);
    size[i] = parameters.GridSize[axis];
    if (size[i] != 0 && size[i] < ipia::Order)
    {
      this->Refusal = text("GridSize is ", size[i], " along axis ", axis,
        "; a cubic lattice needs at least 4 coefficients (0: automatic).");
      return;
    }
  }

  const double longest = this->Cloud.longestSide();
  ipia::Points<Dim> positions(Dim, this->Cloud.Positions.size());
  ipia::Box<Dim> local = box;
  for (std::size_t k = 0; k < this->Cloud.Positions.size(); ++k)
  {
    positions.col(static_cast<Eigen::Index>(k)) = place.toLocal(this->Cloud.Positions[k].data());
  }
  const double wanted = SpacingPerPoint * ipia::pointSpacing(positions, local);
  const double h = std::min(std::max(wanted, longest / MostSpacings), longest / FewestSpacings);

  ipia::PlacedLattice<Dim> placed;
  if (automatic)
  {
    const bool anySize = std::any_of(size.begin(), size.end(), [](auto n) { return n > 0; });
    const double spacings = longest * (1 + 2 * parameters.Padding) / h;
    if (!anySize && !(spacings < VTK_INT_MAX))
    {
      this->Refusal = text("Padding is ", parameters.Padding, ", which would take ", spacings,
        " knot spacings along an axis. Reduce Padding or give GridSize.");
      return;
    }
    placed = ipia::latticeAround<Dim>(box, parameters.Padding, size, h);
  }
  else
  {
    for (int a = 0; a < Dim; ++a)
    {
      if (!(model.Lower[a] < model.Upper[a] && std::isfinite(model.sides()[a])))
      {
        this->Refusal = text("ModelBounds are empty or not finite along axis ",
          place.Axis[static_cast<std::size_t>(a)], ": [", model.Lower[a], ", ", model.Upper[a],
          "]. Give all axes a positive length, or leave all unset.");
        return;
      }
    }
    // A box much larger than its points does not get more than MostSpacings of its own.
    placed =
      ipia::latticeOn<Dim>(model, size, std::max(h, model.sides().maxCoeff() / MostSpacings));
  }

  for (int axis = 0; axis < 3; ++axis)
  {
    this->Origin[axis] = this->Upper[axis] = this->Cloud.Bounds[static_cast<std::size_t>(2 * axis)];
    this->Spacing[axis] = placed.Grid.Spacing[0];
    this->GridSize[axis] = 1;
  }
  for (int a = 0; a < Dim; ++a)
  {
    const int axis = place.Axis[static_cast<std::size_t>(a)];
    this->Origin[axis] = placed.Lower[a];
    this->Spacing[axis] = placed.Grid.Spacing[a];
    this->Upper[axis] = automatic ? placed.Lower[a] + placed.Grid.extent(a) : model.Upper[a];
    this->GridSize[axis] = static_cast<int>(placed.Grid.Size[static_cast<std::size_t>(a)]);
  }
}

void vtkIPIAImplicitFitter::Problem::ChooseSamples(const vtkIPIAImplicitFitter& parameters)
{
  double total = 1;
  double dimensions[3];
  bool anyAutomatic = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool automatic = parameters.SampleDimensions[axis] == 0;
    dimensions[axis] = axis == this->FlatAxis ? 1
      : automatic                             ? 2. * (this->GridSize[axis] - 3) + 1
                                              : parameters.SampleDimensions[axis];
    if (axis != this->FlatAxis && dimensions[axis] < 2)
    {
      this->Refusal = text("SampleDimensions is ", parameters.SampleDimensions[axis],
        " along axis ", axis, "; at least 2 sample points are needed (0: automatic).");
      return;
    }
    anyAutomatic = anyAutomatic || (automatic && axis != this->FlatAxis);
    total *= dimensions[axis];
  }
  const double shrink = anyAutomatic
    ? std::min(1.0, std::pow(MostAutomaticSamples / total, 1. / this->Dimension))
    : 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (parameters.SampleDimensions[axis] == 0 && axis != this->FlatAxis)
    {
      dimensions[axis] = std::max(2.0, std::floor(dimensions[axis] * shrink));
    }
    this->WholeExtent[2 * axis] = 0;
    this->WholeExtent[2 * axis + 1] = static_cast<int>(dimensions[axis]) - 1;
    this->SampleSpacing[axis] = axis == this->FlatAxis
      ? this->Spacing[axis]
      : (this->Upper[axis] - this->Origin[axis]) / (dimensions[axis] - 1);
  }
}

void vtkIPIAImplicitFitter::Problem::CheckMemory(const vtkIPIAImplicitFitter& parameters)
{
  double coefficients = 1, samples = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    coefficients *= this->GridSize[axis];
    samples *= this->WholeExtent[2 * axis + 1] + 1.;
  }
  const double scalar = parameters.OutputScalarType == VTK_DOUBLE ? 8 : 4;
  const double arrays =
    1 + (parameters.GenerateGradient ? 4 : 0) + (parameters.GenerateSupport ? 1 : 0);
  const double rows = 3. * static_cast<double>(this->Cloud.Positions.size());
  const double needed =
    coefficients * BytesPerCoefficient + rows * BytesPerRow + samples * arrays * scalar;
  const double available = memoryOfMachine();
  if (needed > MemoryShare * available)
  {
    constexpr double gibibyte = 1073741824;
    this->Refusal = text("The fit would take about ", needed / gibibyte,
      " GiB of memory (GridSize ", this->GridSize[0], " x ", this->GridSize[1], " x ",
      this->GridSize[2], ", ", this->WholeExtent[1] + 1, " x ", this->WholeExtent[3] + 1, " x ",
      this->WholeExtent[5] + 1, " samples); the machine has ", available / gibibyte,
      " GiB. Reduce GridSize or SampleDimensions.");
  }
}

void vtkIPIAImplicitFitter::Problem::DropPointsOutside()
{
  const auto inside = [this](const std::array<double, 3>& x)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double value = x[static_cast<std::size_t>(axis)];
      const double slack = 1e-12 * (this->Upper[axis] - this->Origin[axis]);
      if (axis != this->FlatAxis &&
        !(value >= this->Origin[axis] - slack && value <= this->Upper[axis] + slack))
      {
        return false;
      }
    }
    return true;
  };
  ipia::PointCloud& cloud = this->Cloud;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < cloud.Positions.size(); ++k)
  {
    if (inside(cloud.Positions[k]))
    {
      cloud.Positions[kept] = cloud.Positions[k];
      cloud.Normals[kept] = cloud.Normals[k];
      cloud.Ids[kept] = cloud.Ids[k];
      if (!cloud.Weights.empty())
      {
        cloud.Weights[kept] = cloud.Weights[k];
      }
      ++kept;
    }
  }
  this->OutsideBounds = static_cast<vtkIdType>(cloud.Positions.size() - kept);
  cloud.Positions.resize(kept);
  cloud.Normals.resize(kept);
  cloud.Ids.resize(kept);
  cloud.Weights.resize(cloud.Weights.empty() ? 0 : kept);
  std::size_t keptRows = 0;
  for (std::size_t k = 0; k < cloud.ExtraPositions.size(); ++k)
  {
    if (inside(cloud.ExtraPositions[k]))
    {
      cloud.ExtraPositions[keptRows] = cloud.ExtraPositions[k];
      cloud.ExtraValues[keptRows] = cloud.ExtraValues[k];
      ++keptRows;
    }
  }
  this->OutsideBounds += static_cast<vtkIdType>(cloud.ExtraPositions.size() - keptRows);
  cloud.ExtraPositions.resize(keptRows);
  cloud.ExtraValues.resize(keptRows);
  if (kept == 0)
  {
    this->Refusal = text("None of the points lies in the ModelBounds from ", triple(this->Origin),
      " to ", triple(this->Upper), ".");
  }
}

/// What is kept between updates: the problem and its solution, each with what it depends on.
class vtkIPIAImplicitFitter::Internals
{
public:
  vtkNew<vtkIPIAImplicitFunction> Function;

  std::unique_ptr<Problem> Current;
  std::vector<vtkMTimeType> ProblemIdentity;

  std::unique_ptr<PlacedFit<2>> Planar;
  std::unique_ptr<PlacedFit<3>> Spatial;
  vtkNew<vtkImageData> ControlLattice;
  std::vector<vtkMTimeType> FitIdentity;
  std::vector<double> FitParameters;

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
  std::unique_ptr<PlacedFit<Dim>>& Slot()
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
  , NormalConstraint(TwoSidedOffset)
  , OffsetDistance(0)
  , OffsetValue(0)
  , InwardOffsetDistance(0)
  , InwardOffsetValue(0)
  , Solver(ProgressiveIteration)
  , NumberOfLevels(1)
  , MaximumNumberOfIterations(0)
  , Tolerance(0)
  , StoppingRule(RelativeResidual)
  , StepSize(0)
  , GenerateGradient(false)
  , GenerateSupport(false)
  , OutputScalarType(VTK_FLOAT)
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
}

vtkIPIAImplicitFitter::~vtkIPIAImplicitFitter() = default;

void vtkIPIAImplicitFitter::SetExtraRowsConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkIPIAImplicitFitter::SetExtraRowsData(vtkPolyData* rows)
{
  this->SetInputData(1, rows);
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

void vtkIPIAImplicitFitter::PrepareProblem(vtkInformationVector** input)
{
  vtkDataObject* points = vtkDataObject::GetData(input[0]);
  vtkPolyData* extraRows = vtkPolyData::GetData(input[1]);
  std::vector<vtkMTimeType> identity{ this->GetMTime() };
  appendIdentity(points, identity);
  appendIdentity(extraRows, identity);
  if (this->State->Current && identity == this->State->ProblemIdentity)
  {
    return;
  }
  this->State->Current = std::make_unique<Problem>();
  this->State->Current->Cloud.gather([this](int index, vtkDataObject* data)
    { return this->GetInputArrayToProcess(index, data); },
    points, extraRows);
  this->State->Current->Prepare(*this);
  this->State->ProblemIdentity = identity;
}

int vtkIPIAImplicitFitter::RequestInformation(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* imageInfo = output->GetInformationObject(0);
  this->BringInputUpToDate(imageInfo);
  this->PrepareProblem(input);
  const Problem& problem = *this->State->Current;

  imageInfo->Set(Pipeline::WHOLE_EXTENT(), problem.WholeExtent, 6);
  imageInfo->Set(vtkDataObject::ORIGIN(), problem.Origin, 3);
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
  latticeInfo->Set(vtkDataObject::ORIGIN(), origin, 3);
  latticeInfo->Set(vtkDataObject::SPACING(), problem.Spacing, 3);
  vtkDataObject::SetPointDataActiveScalarInfo(latticeInfo, VTK_DOUBLE, 1);

  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    output->GetInformationObject(port)->Set(Pipeline::TIME_DEPENDENT_INFORMATION(), 1);
  }
  return 1;
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
template <int Dim>
ipia::Points<Dim> toLocal(
  const ipia::Placement<Dim>& place, const std::vector<std::array<double, 3>>& positions)
{
  ipia::Points<Dim> local(Dim, static_cast<Eigen::Index>(positions.size()));
  for (std::size_t k = 0; k < positions.size(); ++k)
  {
    local.col(static_cast<Eigen::Index>(k)) = place.toLocal(positions[k].data());
  }
  return local;
}

ipia::Vector toVector(const std::vector<double>& values)
{
  return Eigen::Map<const ipia::Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// The given distance for all points, or the automatic one, drawn in where other points are near.
ipia::Vector offsetDistances(
  const ipia::PointCloud& cloud, double given, double automatic, double side)
{
  return given > 0
    ? ipia::Vector::Constant(static_cast<Eigen::Index>(cloud.Positions.size()), given)
    : toVector(cloud.offsetDistances(automatic, side));
}

void addResult(vtkFieldData* field, const char* name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  field->AddArray(array);
}

/// Samples one quantity of the fit into component c of an array over an extent.
template <int Dim, typename ArrayType>
bool sampleInto(ArrayType* array, int component, const ipia::ImplicitSpline<Dim>& function,
  const ipia::AxisPositions<Dim>& positions, int derivativeAxis,
  const ipia::ProgressCallback& progress)
{
  using Scalar = typename ArrayType::ValueType;
  const int components = array->GetNumberOfComponents();
  if (components == 1)
  {
    return function.sample(positions, array->GetPointer(0), 0, derivativeAxis, progress);
  }
  std::vector<Scalar> plane(static_cast<std::size_t>(array->GetNumberOfTuples()));
  const bool done = function.sample(positions, plane.data(), 0, derivativeAxis, progress);
  Scalar* values = array->GetPointer(0);
  for (std::size_t i = 0; i < plane.size(); ++i)
  {
    values[i * static_cast<std::size_t>(components) + static_cast<std::size_t>(component)] =
      plane[i];
  }
  return done;
}
}

void vtkIPIAImplicitFitter::ResetResults()
{
  this->NumberOfIterationsUsed = 0;
  this->StepSizeUsed = this->Energy = this->AverageError = this->MaximumError = 0;
  this->Oscillation = this->OffsetDistanceUsed = 0;
  std::fill_n(this->GridSizeUsed, 3, 0);
  vtkMath::UninitializeBounds(this->ModelBoundsUsed);
}

bool vtkIPIAImplicitFitter::ReportProgress(double share)
{
  this->UpdateProgress(share);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
  return !this->CheckAbort();
#else
  return !this->GetAbortExecute();
#endif
}

template <int Dim>
bool vtkIPIAImplicitFitter::FitInDimension()
{
  const Problem& problem = *this->State->Current;
  const ipia::PointCloud& cloud = problem.Cloud;
  auto place = ipia::Placement<Dim>::withFlatAxis(problem.FlatAxis);
  std::copy_n(problem.Origin, 3, place.Origin.begin());
  ipia::Lattice<Dim> lattice;
  for (int a = 0; a < Dim; ++a)
  {
    const auto i = static_cast<std::size_t>(a);
    lattice.Size[i] = problem.GridSize[place.Axis[i]];
    lattice.Spacing[a] = problem.Spacing[place.Axis[i]];
  }

  ipia::FitInput<Dim> input;
  input.Positions = toLocal(place, cloud.Positions);
  input.Normals.resize(Dim, input.Positions.cols());
  for (Eigen::Index k = 0; k < input.Normals.cols(); ++k)
  {
    for (int a = 0; a < Dim; ++a)
    {
      input.Normals(a, k) = cloud.Normals[static_cast<std::size_t>(k)][static_cast<std::size_t>(
        place.Axis[static_cast<std::size_t>(a)])];
    }
  }
  input.Weights = toVector(cloud.Weights);
  input.ExtraPositions = toLocal(place, cloud.ExtraPositions);
  input.ExtraValues = toVector(cloud.ExtraValues);

  const double automatic = OffsetInSpacings * lattice.Spacing.maxCoeff();
  this->OffsetDistanceUsed = this->OffsetDistance > 0 ? this->OffsetDistance : automatic;
  input.OutwardDistance = offsetDistances(cloud, this->OffsetDistance, automatic, 1);
  input.OutwardValue = this->OffsetValue;
  if (this->NormalConstraint == TwoSidedOffset)
  {
    const double inward =
      this->InwardOffsetDistance > 0 ? this->InwardOffsetDistance : this->OffsetDistance;
    input.InwardDistance = offsetDistances(cloud, inward, automatic, -1);
    input.InwardValue = this->InwardOffsetValue > 0 ? this->InwardOffsetValue : this->OffsetValue;
  }

  ipia::FitOptions options;
  options.Solver.Type = this->Solver == ConjugateGradient ? ipia::SolverType::ConjugateGradient
                                                          : ipia::SolverType::ProgressiveIteration;
  options.Solver.MaximumNumberOfIterations = this->MaximumNumberOfIterations > 0
    ? this->MaximumNumberOfIterations
    : this->Solver == ConjugateGradient ? AutomaticConjugateIterations
                                        : AutomaticProgressiveIterations;
  options.Solver.Tolerance = this->Tolerance;
  options.Solver.Rule = this->StoppingRule == EnergyChange ? ipia::StoppingRule::EnergyChange
                                                           : ipia::StoppingRule::RelativeResidual;
  options.Solver.StepSize = this->StepSize;
  options.FarField.Magnitude = this->OffsetValue > 0 ? this->OffsetValue : this->OffsetDistanceUsed;

  const auto progress = [this](double share)
  { return this->ReportProgress(ProgressOfRows + (ProgressOfFit - ProgressOfRows) * share); };
  auto& slot = this->State->Slot<Dim>();
  slot.reset(
    new PlacedFit<Dim>{ place, ipia::fitImplicit<Dim>(lattice, input, options, progress) });
  const ipia::FitResult<Dim>& result = slot->Result;
  if (result.Solver.Status == ipia::SolverStatus::Diverged)
  {
    vtkErrorMacro("The iteration diverges with StepSize "
      << result.Solver.StepSize << ": the energy rose in iteration "
      << result.Solver.NumberOfIterations << ". Reduce StepSize, or leave it 0 for "
      << "2 / max_i sum_k w_k B_i(x_k).");
  }
  if (result.Solver.Status != ipia::SolverStatus::Done)
  {
    return false;
  }
  if (result.Function.farField().NumberOfMixedRegions > 0)
  {
    vtkWarningMacro(
      << result.Function.farField().NumberOfMixedRegions
      << " region(s) without data border on both sides of the surface, which is open "
         "there or has wide holes; f takes the sign of the larger share of the border.");
  }
  this->NumberOfIterationsUsed = result.Solver.NumberOfIterations;
  this->StepSizeUsed = result.Solver.StepSize;
  this->Energy = result.Solver.Energy;
  this->AverageError = result.AverageError;
  this->MaximumError = result.MaximumError;
  this->Oscillation = result.Oscillation;
  ipia::toControlLattice(result.Function, place, this->State->ControlLattice);
  return true;
}

bool vtkIPIAImplicitFitter::Fit()
{
  Internals& state = *this->State;
  const Problem& problem = *state.Current;
  // What the fit depends on, to reuse it when only the samples change.
  std::vector<vtkMTimeType> identity = state.ProblemIdentity;
  identity.front() = 0; // the filter's own time covers more than the fit's parameters
  for (vtkDataArray* array : problem.Cloud.ChosenArrays)
  {
    appendArrayIdentity(array, identity);
  }
  std::vector<double> parameters{ this->OffsetDistance, this->OffsetValue,
    this->InwardOffsetDistance, this->InwardOffsetValue, this->Tolerance, this->StepSize };
  for (int value : { this->NormalConstraint, this->Solver, this->NumberOfLevels,
         this->MaximumNumberOfIterations, this->StoppingRule, problem.FlatAxis })
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
    add(left.InvalidNormals, "zero or non-finite normal(s) with their offset rows");
    vtkWarningMacro("Left out of the fit: " << parts << ".");
  }
  const bool done = problem.Dimension == 2 ? this->FitInDimension<2>() : this->FitInDimension<3>();
  if (!done)
  {
    this->DiscardFit();
    return false;
  }
  std::copy_n(problem.GridSize, 3, this->GridSizeUsed);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->ModelBoundsUsed[2 * axis] = problem.Origin[axis];
    this->ModelBoundsUsed[2 * axis + 1] = problem.Upper[axis];
  }
  state.Function->SetControlLattice(state.ControlLattice);
  state.FitIdentity = identity;
  state.FitParameters = parameters;
  return true;
}

void vtkIPIAImplicitFitter::DiscardFit()
{
  this->State->Planar.reset();
  this->State->Spatial.reset();
  this->State->ControlLattice->Initialize();
  this->State->Function->SetControlLattice(nullptr);
  this->ResetResults();
}

template <int Dim, typename ArrayType>
bool vtkIPIAImplicitFitter::SampleImage(vtkImageData* image)
{
  const Problem& problem = *this->State->Current;
  const PlacedFit<Dim>& fit = *this->State->Slot<Dim>();
  ipia::AxisPositions<Dim> positions;
  for (int a = 0; a < Dim; ++a)
  {
    const int axis = fit.Place.Axis[static_cast<std::size_t>(a)];
    const int* extent = image->GetExtent();
    for (int i = extent[2 * axis]; i <= extent[2 * axis + 1]; ++i)
    {
      // As vtkImageData places its points, so that samples equal the function at those.
      const double world = problem.Origin[axis] + i * problem.SampleSpacing[axis];
      positions[static_cast<std::size_t>(a)].push_back(world - problem.Origin[axis]);
    }
  }

  const int quantities = 1 + (this->GenerateGradient ? Dim : 0) + (this->GenerateSupport ? 1 : 0);
  int finished = 0;
  const auto progress = [&](double share)
  {
    return this->ReportProgress(
      ProgressOfFit + (1 - ProgressOfFit) * (finished + share) / quantities);
  };
  const auto newArray = [image](const char* name, int components)
  {
    auto array = vtkSmartPointer<ArrayType>::New();
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(image->GetNumberOfPoints());
    return array;
  };

  // Sampling reports from one thread, which may find nothing left to do; so each end is reported.
  const auto finish = [&]
  {
    ++finished;
    return progress(0);
  };

  auto f = newArray("f", 1);
  if (!sampleInto<Dim>(f.Get(), 0, fit.Result.Function, positions, -1, progress) || !finish())
  {
    return false;
  }
  image->GetPointData()->SetScalars(f);
  if (this->GenerateGradient)
  {
    auto gradient = newArray("Gradient", 3);
    gradient->Fill(0);
    for (int a = 0; a < Dim; ++a)
    {
      if (!sampleInto<Dim>(gradient.Get(), fit.Place.Axis[static_cast<std::size_t>(a)],
            fit.Result.Function, positions, a, progress) ||
        !finish())
      {
        return false;
      }
    }
    image->GetPointData()->AddArray(gradient);
  }
  if (this->GenerateSupport)
  {
    auto support = newArray("Support", 1);
    const ipia::ImplicitSpline<Dim> density(fit.Result.Function.lattice(), fit.Result.Support);
    if (!sampleInto<Dim>(support.Get(), 0, density, positions, -1, progress) || !finish())
    {
      return false;
    }
    image->GetPointData()->AddArray(support);
  }
  return true;
}

void vtkIPIAImplicitFitter::WriteFittedPoints(vtkPolyData* output)
{
  const ipia::PointCloud& cloud = this->State->Current->Cloud;
  const auto n = static_cast<vtkIdType>(cloud.Ids.size());
  vtkNew<vtkIdList> from, to;
  from->SetNumberOfIds(n);
  to->SetNumberOfIds(n);
  vtkNew<vtkPoints> points;
  points->SetDataType(cloud.Source->GetPoints()->GetDataType());
  points->SetNumberOfPoints(n);
  vtkNew<vtkDoubleArray> residual, distance;
  residual->SetName("Residual");
  distance->SetName("Distance");
  residual->SetNumberOfTuples(n);
  distance->SetNumberOfTuples(n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    from->SetId(i, cloud.Ids[k]);
    to->SetId(i, i);
    points->SetPoint(i, cloud.Source->GetPoint(cloud.Ids[k]));
    this->State->WithFit(
      [&](const auto& fit)
      {
        const auto local = fit.Place.toLocal(cloud.Positions[k].data());
        const double f = fit.Result.Function.value(local);
        const double slope = fit.Result.Function.gradient(local).norm();
        residual->SetValue(i, f);
        // Where f is flat there is no distance to tell; f itself is the best guess.
        distance->SetValue(i, slope > 0 ? f / slope : f);
      });
  }
  output->SetPoints(points);
  output->GetPointData()->CopyAllOn();
  output->GetPointData()->CopyAllocate(cloud.Source->GetPointData(), n);
  output->GetPointData()->SetNumberOfTuples(n);
  output->GetPointData()->CopyData(cloud.Source->GetPointData(), from, to);
  output->GetPointData()->AddArray(residual);
  output->GetPointData()->AddArray(distance);
  vtkNew<vtkCellArray> vertices;
  vertices->InsertNextCell(to);
  output->SetVerts(vertices);
}

void vtkIPIAImplicitFitter::WriteResults(vtkFieldData* field) const
{
  addResult(field, "NumberOfIterationsUsed", this->NumberOfIterationsUsed);
  addResult(field, "StepSizeUsed", this->StepSizeUsed);
  addResult(field, "Energy", this->Energy);
  addResult(field, "AverageError", this->AverageError);
  addResult(field, "MaximumError", this->MaximumError);
  addResult(field, "Oscillation", this->Oscillation);
  addResult(field, "OffsetDistanceUsed", this->OffsetDistanceUsed);
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
      for (double r : fit.Result.Solver.ResidualHistory)
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
  const Problem& problem = *this->State->Current;
  if (!problem.Refusal.empty())
  {
    this->DiscardFit();
    vtkErrorMacro(<< problem.Refusal);
    return 1;
  }
  if (!this->ReportProgress(0) || !this->Fit())
  {
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
  image->SetOrigin(problem.Origin);
  image->SetSpacing(problem.SampleSpacing);
  const bool planar = problem.Dimension == 2, wide = this->OutputScalarType == VTK_DOUBLE;
  const bool sampled = planar ? (wide ? this->SampleImage<2, vtkDoubleArray>(image)
                                      : this->SampleImage<2, vtkFloatArray>(image))
                              : (wide ? this->SampleImage<3, vtkDoubleArray>(image)
                                      : this->SampleImage<3, vtkFloatArray>(image));
  if (!sampled)
  {
    clear();
    return 1;
  }
  this->WriteResults(image->GetFieldData());
  this->WriteFittedPoints(points);
  lattice->ShallowCopy(this->State->ControlLattice);
  this->ReportProgress(1);
  return 1;
}

void vtkIPIAImplicitFitter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto triple = [](const auto* v) { return text("(", v[0], ", ", v[1], ", ", v[2], ")"); };
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
  os << indent << "Solver: " << this->Solver << "\n";
  os << indent << "NumberOfLevels: " << this->NumberOfLevels << "\n";
  os << indent << "MaximumNumberOfIterations: " << this->MaximumNumberOfIterations << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "StoppingRule: " << this->StoppingRule << "\n";
  os << indent << "StepSize: " << this->StepSize << "\n";
  os << indent << "GenerateGradient: " << this->GenerateGradient << "\n";
  os << indent << "GenerateSupport: " << this->GenerateSupport << "\n";
  os << indent << "OutputScalarType: " << this->OutputScalarType << "\n";
  os << indent << "NumberOfIterationsUsed: " << this->NumberOfIterationsUsed << "\n";
  os << indent << "StepSizeUsed: " << this->StepSizeUsed << "\n";
  os << indent << "Energy: " << this->Energy << "\n";
  os << indent << "AverageError: " << this->AverageError << "\n";
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "Oscillation: " << this->Oscillation << "\n";
  os << indent << "OffsetDistanceUsed: " << this->OffsetDistanceUsed << "\n";
  os << indent << "GridSizeUsed: " << triple(this->GridSizeUsed) << "\n";
  os << indent << "ModelBoundsUsed: " << bounds(this->ModelBoundsUsed) << "\n";
}
