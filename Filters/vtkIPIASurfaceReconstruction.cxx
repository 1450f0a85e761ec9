// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIPIASurfaceReconstruction.h"

#include "IPIABrickContour.h"
#include "IPIAComponents.h"
#include "IPIAIdentity.h"
#include "IPIAPointCloud.h"
#include "IPIAProgress.h"
#include "IPIATrim.h"
#include "vtkIPIAImplicitFitter.h"
#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIAScanRegistration.h"

#include "vtkCommand.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkFlyingEdges2D.h"
#include "vtkFlyingEdges3D.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkReverseSense.h"
#include "vtkSMPTools.h"
#include "vtkStripper.h"

#include <algorithm>
#include <cmath>
#include <vector>

vtkStandardNewMacro(vtkIPIASurfaceReconstruction);

namespace
{
/// Shares of the progress: up to the end of the registration, and of the fit.
constexpr double ProgressOfRegistration = 0.4, ProgressOfFit = 0.7;
/// Data farther from a component than this many knot spacings are not its data.
constexpr double ReachOfData = 3;
/// Rounding to float shows beyond this share of the knot spacing.
constexpr double VisibleRounding = 1e-3;
constexpr double FloatRounding = 6e-8;
/// Data at a side of the domain are no farther from it than this many of their spacings.
constexpr double LeastTrimDistance = 1;
/// Points of a polyline, the most that vtkStripper takes; it leaves longer loops open.
constexpr int LongestPolyline = 100000;

/// The zero set of an image in space, its triangles facing towards f > 0.
void contourInSpace(vtkImageData* image, vtkPolyData* surface)
{
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image);
  contour->SetValue(0, 0);
  contour->ComputeNormalsOff();
  contour->ComputeScalarsOff();
  // Its triangles face towards smaller f.
  vtkNew<vtkReverseSense> outwards;
  outwards->SetInputConnection(contour->GetOutputPort());
  outwards->Update();
  surface->ShallowCopy(outwards->GetOutput());
}

/// The zero set of an image of one slice, as polylines.
void contourInPlane(vtkImageData* image, vtkPolyData* curve)
{
  const int* n = image->GetDimensions();
  const int across = n[2] == 1 ? 2 : n[1] == 1 ? 1 : 0;
  const int first = across == 0 ? 1 : 0, second = across == 2 ? 1 : 2;
  // vtkFlyingEdges2D puts every curve across z: give it an image there, and turn the curve back.
  vtkNew<vtkImageData> flat;
  flat->SetDimensions(n[first], n[second], 1);
  flat->SetOrigin(image->GetOrigin()[first], image->GetOrigin()[second], 0);
  flat->SetSpacing(image->GetSpacing()[first], image->GetSpacing()[second], 1);
  flat->GetPointData()->SetScalars(image->GetPointData()->GetScalars());
  vtkNew<vtkFlyingEdges2D> contour;
  contour->SetInputData(flat);
  contour->SetValue(0, 0);
  contour->ComputeScalarsOff();
  vtkNew<vtkStripper> polylines;
  polylines->SetInputConnection(contour->GetOutputPort());
  polylines->SetMaximumLength(LongestPolyline);
  polylines->JoinContiguousSegmentsOn();
  polylines->Update();
  curve->ShallowCopy(polylines->GetOutput());

  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(curve->GetNumberOfPoints());
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double from[3], to[3];
    curve->GetPoint(i, from);
    to[first] = from[0];
    to[second] = from[1];
    to[across] = image->GetOrigin()[across];
    points->SetPoint(i, to);
  }
  curve->SetPoints(points);
}

/// Newton's step of a vertex, and the direction of the gradient where it ends.
void moveOntoZeroSet(
  vtkIPIAImplicitFunction* function, const ipia::NewtonStep& newton, double x[3], double normal[3])
{
  const double f = function->EvaluateFunctionAndGradient(x, normal);
  const double slope = vtkMath::Norm(normal);
  const double step = newton.along(f, slope);
  if (step != 0)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      x[axis] += step * normal[axis] / slope;
    }
    function->EvaluateFunctionAndGradient(x, normal);
  }
  vtkMath::Normalize(normal);
}

/// Trims in the frame of a fit, along whose axes its domain lies.
ipia::TrimResult trimInFrame(vtkPolyData* surface, const ipia::PointCloud& data,
  const ipia::Frame& frame, const ipia::TrimOptions& options)
{
  if (!frame.isTurned())
  {
    return ipia::trimUnsupported(surface, data, options);
  }
  const auto turn = [surface](const auto& map)
  {
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
    {
      surface->GetPoints()->SetPoint(i, map(surface->GetPoint(i)).data());
    }
  };
  ipia::PointCloud turned = data;
  for (std::size_t k = 0; k < turned.Positions.size(); ++k)
  {
    turned.Positions[k] = frame.toFrame(data.Positions[k].data());
    turned.Normals[k] = frame.vectorToFrame(data.Normals[k].data());
  }
  turn([&frame](const double* x) { return frame.toFrame(x); });
  ipia::TrimResult result = ipia::trimUnsupported(surface, turned, options);
  turn([&frame](const double* x) { return frame.toWorld(x); });
  return result;
}
}

vtkIPIASurfaceReconstruction::vtkIPIASurfaceReconstruction()
  : ComponentFilter(true)
  , TrimUnsupported(true)
  , TrimDistance(3)
  , HoleSize(0.15)
  , OutputPointsPrecision(DEFAULT_PRECISION)
  , RegisterScans(true)
  , NumberOfComponentsLeftOut(0)
  , NumberOfPartsTrimmed(0)
{
  this->SetNumberOfInputPorts(2);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::NORMALS);
  this->SetInputArrayToProcess(
    2, 1, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
  for (unsigned long event :
    { vtkCommand::ErrorEvent, vtkCommand::WarningEvent, vtkCommand::ProgressEvent })
  {
    this->Fitter->AddObserver(event, this, &vtkIPIASurfaceReconstruction::ForwardEvent);
    this->Registration->AddObserver(event, this, &vtkIPIASurfaceReconstruction::ForwardEvent);
  }
}

vtkIPIASurfaceReconstruction::~vtkIPIASurfaceReconstruction() = default;

vtkIPIAImplicitFitter* vtkIPIASurfaceReconstruction::GetFitter()
{
  return this->Fitter;
}

vtkIPIAScanRegistration* vtkIPIASurfaceReconstruction::GetRegistration()
{
  return this->Registration;
}

void vtkIPIASurfaceReconstruction::SetExtraRowsConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkIPIASurfaceReconstruction::SetExtraRowsData(vtkPolyData* rows)
{
  this->SetInputData(1, rows);
}

vtkDataArraySelection* vtkIPIASurfaceReconstruction::GetPointDataArraySelection()
{
  return this->Fitter->GetPointDataArraySelection();
}

vtkMTimeType vtkIPIASurfaceReconstruction::GetMTime()
{
  return std::max(
    { this->Superclass::GetMTime(), this->Fitter->GetMTime(), this->Registration->GetMTime() });
}

int vtkIPIASurfaceReconstruction::FillInputPortInformation(int port, vtkInformation* info)
{
  return this->Fitter->FillInputPortInformation(port, info);
}

void vtkIPIASurfaceReconstruction::ForwardEvent(vtkObject* caller, unsigned long event, void* data)
{
  if (event == vtkCommand::ProgressEvent)
  {
    const bool isFit = caller == this->Fitter;
    const double begin = isFit ? this->ProgressBeforeFit : 0;
    const double end = isFit ? ProgressOfFit : ProgressOfRegistration;
    const double share = *static_cast<double*>(data);
    const bool goOn = ipia::reportProgress(this, begin + (end - begin) * share);
    static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(goOn ? 0 : 1);
  }
  else
  {
    ipia::forwardMessage(this, event, data);
  }
}

bool vtkIPIASurfaceReconstruction::IsToRegister(vtkDataObject* points) const
{
  return this->RegisterScans && !this->Fitter->GetIncremental() &&
    vtkCompositeDataSet::SafeDownCast(points);
}

std::vector<vtkMTimeType> vtkIPIASurfaceReconstruction::IdentityOf(vtkInformationVector** input)
{
  ipia::Identity identity;
  for (int port = 0; port < 2; ++port)
  {
    ipia::appendIdentity(vtkDataObject::GetData(input[port]), identity);
  }
  vtkDataObject* points = vtkDataObject::GetData(input[0]);
  const bool registers = this->IsToRegister(points);
  identity.push_back(registers ? this->Registration->GetMTime() : 0);
  if (registers)
  {
    auto* scans = static_cast<vtkCompositeDataSet*>(points);
    const auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(scans->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      for (int index : { ipia::PointCloud::NormalsIndex, ipia::PointCloud::WeightsIndex })
      {
        ipia::appendArrayIdentity(
          this->GetInputArrayToProcess(index, iterator->GetCurrentDataObject()), identity);
      }
    }
  }
  return identity;
}

vtkSmartPointer<vtkDataObject> vtkIPIASurfaceReconstruction::Registered(vtkDataObject* scans)
{
  for (int index : { ipia::PointCloud::NormalsIndex, ipia::PointCloud::WeightsIndex })
  {
    this->Registration->SetInputArrayToProcess(index, this->GetInputArrayInformation(index));
  }
  this->Registration->SetInputDataObject(scans);
  this->Registration->Update();
  this->ProgressBeforeFit = ProgressOfRegistration;
  auto* registered = vtkCompositeDataSet::SafeDownCast(this->Registration->GetOutputDataObject(0));
  const bool failed = registered->GetNumberOfPoints() == 0 &&
    static_cast<vtkCompositeDataSet*>(scans)->GetNumberOfPoints() > 0;
  vtkSmartPointer<vtkDataObject> points = failed ? nullptr : scans;
  if (this->Registration->GetLargestMotion() > 0)
  {
    points.TakeReference(registered->NewInstance());
    points->ShallowCopy(registered);
    vtkWarningMacro("The scans were moved, by up to "
      << this->Registration->GetLargestMotion() << ", until they lay "
      << this->Registration->GetMisfitAfter() << " apart instead of "
      << this->Registration->GetMisfitBefore()
      << " (root mean square). With RegisterScans off they stay where they are.");
  }
  registered->Initialize(); // the fitter has what it needs
  return points;
}

int vtkIPIASurfaceReconstruction::RequestData(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkPolyData* surface = vtkPolyData::GetData(output);
  surface->Initialize();
  this->NumberOfComponentsLeftOut = this->NumberOfPartsTrimmed = 0;
  if (std::isnan(this->TrimDistance) || std::isnan(this->HoleSize))
  {
    vtkErrorMacro(<< (std::isnan(this->TrimDistance) ? "TrimDistance" : "HoleSize")
                  << " is not a number. Set one.");
    return 1;
  }
  ipia::Identity identity = this->IdentityOf(input);
  this->ProgressBeforeFit = 0;
  for (int port = 0; port < 2 && identity != this->InputIdentity; ++port)
  {
    // A copy of its own keeps the fitter out of this filter's pipeline.
    vtkSmartPointer<vtkDataObject> copy;
    if (vtkDataObject* data = vtkDataObject::GetData(input[port]))
    {
      copy.TakeReference(data->NewInstance());
      copy->ShallowCopy(data);
    }
    if (port == 0 && this->IsToRegister(copy))
    {
      copy = this->Registered(copy);
      if (!copy) // refused, or aborted
      {
        this->Fitter->DiscardFit();
        this->InputIdentity.clear();
        return 1;
      }
      identity = this->IdentityOf(input);
    }
    this->Fitter->SetInputDataObject(port, copy);
  }
  this->InputIdentity = std::move(identity);
  for (int index = 0; index < 4; ++index)
  {
    this->Fitter->SetInputArrayToProcess(index, this->GetInputArrayInformation(index));
  }
  this->Fitter->UpdateFunctionOnly();
  bool done = this->Fitter->GetImplicitFunction()->HasControlLattice();
  std::vector<vtkIdType> component; // of each vertex
  const auto contourProgress = [this](double share)
  { return ipia::reportProgress(this, ProgressOfFit + (1 - ProgressOfFit) * share); };
  if (done)
  {
    if (this->Fitter->IsInBricks())
    {
      done = this->Fitter->ContourBricks(this->PointType(), contourProgress, surface, component);
    }
    else
    {
      this->ContourImage(surface);
      done = contourProgress(0.5);
      if (done)
      {
        this->MoveOntoZeroSet(surface, this->Fitter->GetOutput());
        component = ipia::componentsOf(surface);
      }
    }
    surface->GetFieldData()->ShallowCopy(this->Fitter->GetOutput()->GetFieldData());
  }
  if (done && this->ComponentFilter)
  {
    this->LeaveOutComponents(surface, component);
  }
  if (done && this->TrimUnsupported)
  {
    this->Trim(surface);
  }
  if (done)
  {
    this->Fitter->EvaluateAttributes(surface);
  }
  else
  {
    this->InputIdentity.clear(); // so that the same input is refused as loudly again
  }
  // The samples are not needed any more; the function and the figures stay.
  for (int port = 0; port < this->Fitter->GetNumberOfOutputPorts(); ++port)
  {
    this->Fitter->GetOutputDataObject(port)->Initialize();
  }
  if (!done || !ipia::reportProgress(this, 1))
  {
    surface->Initialize();
  }
  return 1;
}

void vtkIPIASurfaceReconstruction::LeaveOutComponents(
  vtkPolyData* surface, const std::vector<vtkIdType>& component)
{
  this->NumberOfComponentsLeftOut += ipia::leaveOutComponents(surface, component,
    this->Fitter->FittedCloud().Positions, ReachOfData * this->Fitter->KnotSpacing());
}

void vtkIPIASurfaceReconstruction::Trim(vtkPolyData* surface)
{
  ipia::TrimOptions options;
  options.Distance = this->TrimDistance;
  options.HoleSize = this->HoleSize;
  std::copy_n(this->Fitter->GetModelBoundsUsed(), 6, options.Domain.begin());
  bool automatic = true;         // as the fitter tells
  std::array<double, 3> spacing; // of samples
  this->Fitter->GetOutput()->GetSpacing(spacing.data());
  for (std::size_t a = 0; a < 3; ++a)
  {
    options.Cells[a] = std::max(0, this->Fitter->GetGridSizeUsed()[a] - 3);
    if (this->Fitter->IsInBricks())
    {
      spacing[a] = (options.Domain[2 * a + 1] - options.Domain[2 * a]) / (2 * options.Cells[a]);
    }
    options.SampleSpacing[a] = options.Cells[a] > 0 ? spacing[a] : 0;
    const double* given = this->Fitter->GetModelBounds() + 2 * a;
    automatic = automatic && (options.Cells[a] == 0 || !(given[0] <= given[1]));
  }
  // An automatic domain goes on beyond the data on every side.
  options.DistanceOnSide = automatic ? LeastTrimDistance : this->TrimDistance;
  const ipia::TrimResult trimmed =
    trimInFrame(surface, this->Fitter->FittedCloud(), this->Fitter->FittedFrame(), options);
  this->NumberOfPartsTrimmed = trimmed.Parts;
  if (trimmed.Parts == 0)
  {
    return;
  }
  const ipia::NewtonStep newton(spacing.data());
  vtkDataArray* normals = surface->GetPointData()->GetNormals();
  for (const vtkIdType i : trimmed.NewPoints)
  {
    double x[3], normal[3];
    surface->GetPoint(i, x);
    moveOntoZeroSet(this->Fitter->GetImplicitFunction(), newton, x, normal);
    surface->GetPoints()->SetPoint(i, x);
    normals->SetTuple(i, normal);
  }
  if (this->ComponentFilter)
  {
    // What held a piece together may be gone.
    this->LeaveOutComponents(surface, ipia::componentsOf(surface));
  }
}

int vtkIPIASurfaceReconstruction::PointType() const
{
  const double* bounds = this->Fitter->GetModelBoundsUsed();
  double farthest = 0;
  for (int k = 0; k < 6; ++k)
  {
    farthest = std::max(farthest, std::abs(bounds[k]));
  }
  const bool wide = this->OutputPointsPrecision == DOUBLE_PRECISION ||
    (this->OutputPointsPrecision == DEFAULT_PRECISION &&
      farthest * FloatRounding > VisibleRounding * this->Fitter->KnotSpacing());
  return wide ? VTK_DOUBLE : VTK_FLOAT;
}

void vtkIPIASurfaceReconstruction::ContourImage(vtkPolyData* surface)
{
  // Contour filters write float points: contour at the origin, and move (and turn) in double.
  vtkImageData* sampled = this->Fitter->GetOutput();
  const double none[3] = { 0, 0, 0 };
  vtkNew<vtkImageData> image;
  image->ShallowCopy(sampled);
  image->SetOrigin(none);
  image->SetDirectionMatrix(vtkNew<vtkMatrix3x3>());
  if (sampled->GetDataDimension() == 3)
  {
    contourInSpace(image, surface);
  }
  else
  {
    contourInPlane(image, surface);
  }
}

void vtkIPIASurfaceReconstruction::MoveOntoZeroSet(vtkPolyData* surface, vtkImageData* sampled)
{
  vtkPoints* before = surface->GetPoints();
  const vtkIdType n = before->GetNumberOfPoints();
  const double* origin = sampled->GetOrigin();
  const double* direction = sampled->GetDirectionMatrix()->GetData();
  const ipia::NewtonStep newton(sampled->GetSpacing());
  vtkNew<vtkPoints> after;
  after->SetDataType(this->PointType());
  after->SetNumberOfPoints(n);
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(n);
  vtkIPIAImplicitFunction* function = this->Fitter->GetImplicitFunction();
  vtkSMPTools::For(0, n,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType i = begin; i < end; ++i)
      {
        double x[3], normal[3];
        before->GetPoint(i, x);
        vtkMatrix3x3::MultiplyPoint(direction, x, x);
        vtkMath::Add(x, origin, x);
        moveOntoZeroSet(function, newton, x, normal);
        after->SetPoint(i, x);
        normals->SetTuple(i, normal);
      }
    });
  surface->SetPoints(after);
  surface->GetPointData()->SetNormals(normals);
}

void vtkIPIASurfaceReconstruction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ComponentFilter: " << this->ComponentFilter << "\n";
  os << indent << "TrimUnsupported: " << this->TrimUnsupported << "\n";
  os << indent << "TrimDistance: " << this->TrimDistance << "\n";
  os << indent << "HoleSize: " << this->HoleSize << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  os << indent << "RegisterScans: " << this->RegisterScans << "\n";
  os << indent << "NumberOfComponentsLeftOut: " << this->NumberOfComponentsLeftOut << "\n";
  os << indent << "NumberOfPartsTrimmed: " << this->NumberOfPartsTrimmed << "\n";
  os << indent << "Fitter:\n";
  this->Fitter->PrintSelf(os, indent.GetNextIndent());
  os << indent << "Registration:\n";
  this->Registration->PrintSelf(os, indent.GetNextIndent());
}
