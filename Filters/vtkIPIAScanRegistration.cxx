// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIPIAScanRegistration.h"

#include "Core/Parallel.h"
#include "Core/ScanMotions.h"
#include "IPIAPointCloud.h"
#include "IPIAProgress.h"
#include "IPIAScanPoses.h"
#include "vtkIPIAImplicitFitter.h"
#include "vtkIPIAImplicitFunction.h"

#include "vtkCommand.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>
#include <cmath>

vtkStandardNewMacro(vtkIPIAScanRegistration);

namespace
{
/// The fit that scans are compared with has at most so many knot spacings along its longest side.
constexpr int LargestNumberOfCells = 128;
/// In knot spacings: how far from the surface points may be, and sides of the cubes.
constexpr double ReachInSpacings = 3, CubeInSpacings = 4;
/// Normals of points are within 60 degrees of the surface's.
constexpr double LeastAgreement = 0.5;
/// Motions that would take away less than this share of the misfit are not made.
constexpr double LeastGain = 0.01;
/// Scans no farther apart than this share of a knot spacing agree.
constexpr double Negligible = 1e-3;
/// Points that cannot be used.
constexpr int NoScan = -1;

/// Keeps the fit as coarse as it needs to be.
void chooseResolution(vtkIPIAImplicitFitter* fitter)
{
  fitter->UpdateInformation();
  std::array<int, 6> extent{};
  fitter->GetOutputInformation(2)->Get(
    vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
  std::array<int, 3> cells{}, size{};
  for (std::size_t a = 0; a < 3; ++a)
  {
    cells[a] = extent[2 * a + 1] - extent[2 * a] + 1 - 3;
  }
  const int most = *std::max_element(cells.begin(), cells.end());
  if (most <= LargestNumberOfCells)
  {
    return;
  }
  for (std::size_t a = 0; a < 3; ++a)
  {
    const double scaled = std::ceil(static_cast<double>(cells[a]) * LargestNumberOfCells / most);
    size[a] = cells[a] > 0 ? static_cast<int>(scaled) + 3 : 0;
  }
  fitter->SetGridSize(size.data());
}
}

vtkIPIAScanRegistration::vtkIPIAScanRegistration()
  : RequiredReduction(0.5)
  , MaximumNumberOfIterations(10)
  , MisfitBefore(0)
  , MisfitAfter(0)
  , LargestMotion(0)
  , NumberOfIterationsUsed(0)
{
  this->SetInputArrayToProcess(ipia::PointCloud::NormalsIndex, 0, 0,
    vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::NORMALS);
}

vtkIPIAScanRegistration::~vtkIPIAScanRegistration() = default;

int vtkIPIAScanRegistration::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

void vtkIPIAScanRegistration::ForwardEvent(vtkObject* caller, unsigned long event, void* data)
{
  if (event == vtkCommand::ProgressEvent)
  {
    // Every iteration takes half of what is left.
    const double left = std::pow(0.5, this->NumberOfIterationsUsed);
    const bool goOn = ipia::reportProgress(this, 1 - left * (1 - *static_cast<double*>(data) / 2));
    static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(goOn ? 0 : 1);
  }
  else if (event == vtkCommand::ErrorEvent) // warnings are for those who fit the result
  {
    ipia::forwardMessage(this, event, data);
  }
}

int vtkIPIAScanRegistration::RequestData(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkCompositeDataSet* given = vtkCompositeDataSet::GetData(input[0]);
  vtkCompositeDataSet* result = vtkCompositeDataSet::GetData(output);
  result->Initialize();
  this->MisfitBefore = this->MisfitAfter = this->LargestMotion = 0;
  this->NumberOfIterationsUsed = 0;
  if (std::isnan(this->RequiredReduction))
  {
    vtkErrorMacro("RequiredReduction is not a number. Set one.");
    return 1;
  }
  ipia::ScanPoses scans;
  const auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(given->NewIterator());
  const auto isScan = [](vtkDataObject* leaf)
  {
    vtkPolyData* scan = vtkPolyData::SafeDownCast(leaf);
    return scan && scan->GetNumberOfPoints() > 0 ? scan : nullptr;
  };
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    if (vtkPolyData* scan = isScan(iterator->GetCurrentDataObject()))
    {
      scans.add(scan, this->GetInputArrayToProcess(ipia::PointCloud::NormalsIndex, scan));
    }
  }
  if (scans.size() > 1 && !this->Register(scans))
  {
    return 1;
  }
  result->CopyStructure(given);
  result->GetFieldData()->ShallowCopy(given->GetFieldData());
  int index = 0;
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    vtkDataObject* leaf = iterator->GetCurrentDataObject();
    vtkSmartPointer<vtkDataObject> copy;
    if (isScan(leaf))
    {
      copy = scans.moved(index++);
    }
    else
    {
      copy.TakeReference(leaf->NewInstance());
      copy->ShallowCopy(leaf);
    }
    result->SetDataSet(iterator, copy);
  }
  ipia::reportProgress(this, 1);
  return 1;
}

bool vtkIPIAScanRegistration::Register(ipia::ScanPoses& scans)
{
  scans.findExtent();
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetFitPointArrays(false);
  fitter->SetFeatherScans(false); // all that overlaps tells how scans lie
  for (unsigned long event :
    { vtkCommand::ErrorEvent, vtkCommand::WarningEvent, vtkCommand::ProgressEvent })
  {
    fitter->AddObserver(event, this, &vtkIPIAScanRegistration::ForwardEvent);
  }
  for (int index : { ipia::PointCloud::NormalsIndex, ipia::PointCloud::WeightsIndex })
  {
    fitter->SetInputArrayToProcess(index, this->GetInputArrayInformation(index));
  }
  fitter->SetInputDataObject(scans.moved());
  chooseResolution(fitter);

  std::vector<ipia::ScanPoses::Pose> best = scans.Poses;
  const std::vector<ipia::ScanPoses::Pose> given = scans.Poses;
  for (;; ++this->NumberOfIterationsUsed)
  {
    ipia::ScanMotions motions;
    if (!this->FindMotions(fitter, scans, motions))
    {
      return false;
    }
    const bool isFirst = this->NumberOfIterationsUsed == 0;
    if (isFirst)
    {
      this->MisfitBefore = this->MisfitAfter = motions.Misfit;
    }
    else if (motions.Misfit < this->MisfitAfter)
    {
      this->MisfitAfter = motions.Misfit;
      best = scans.Poses;
    }
    // The first motions need not reach what is required, but come half way.
    const double leastGain = isFirst ? this->RequiredReduction / 2 : 0.0;
    if ((isFirst && motions.Misfit <= Negligible * fitter->KnotSpacing()) ||
      !(motions.Misfit - motions.Predicted > std::max(leastGain, LeastGain) * motions.Misfit) ||
      this->NumberOfIterationsUsed == this->MaximumNumberOfIterations)
    {
      break;
    }
    scans.move(motions.Twists);
    fitter->SetInputDataObject(scans.moved());
  }
  const bool isWorthIt = this->MisfitAfter <= (1 - this->RequiredReduction) * this->MisfitBefore;
  scans.Poses = isWorthIt ? best : given;
  this->MisfitAfter = isWorthIt ? this->MisfitAfter : this->MisfitBefore;
  this->LargestMotion = scans.largestMotion();
  return true;
}

bool vtkIPIAScanRegistration::FindMotions(
  vtkIPIAImplicitFitter* fitter, const ipia::ScanPoses& scans, ipia::ScanMotions& motions)
{
  fitter->UpdateFunctionOnly();
  vtkIPIAImplicitFunction* function = fitter->GetImplicitFunction();
  if (!function->HasControlLattice())
  {
    return false;
  }
  const double spacing = fitter->KnotSpacing();
  const ipia::PointCloud& cloud = fitter->FittedCloud();
  const auto n = static_cast<std::int64_t>(cloud.Positions.size());
  std::vector<ipia::ScanPoint> points(cloud.Positions.size());
  ipia::parallelChunks(n, ipia::resolveThreads(0),
    [&](std::int64_t begin, std::int64_t end)
    {
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      {
        ipia::ScanPoint& point = points[k];
        point.Position = Eigen::Map<const Eigen::Vector3d>(cloud.Positions[k].data());
        const double f =
          function->EvaluateFunctionAndGradient(point.Position.data(), point.Normal.data());
        const double slope = point.Normal.norm();
        const Eigen::Map<const Eigen::Vector3d> normal(cloud.Normals[k].data());
        const bool isNear = std::abs(f) < ReachInSpacings * spacing * slope &&
          normal.dot(point.Normal) > LeastAgreement * slope;
        const bool counts = cloud.Weights.empty() || cloud.Weights[k] > 0;
        point.Scan = isNear && counts ? scans.scanOf(cloud.Ids[k]) : NoScan;
        point.Normal /= slope;
        point.Distance = f / slope;
      }
    });
  points.erase(std::remove_if(points.begin(), points.end(),
                 [](const ipia::ScanPoint& point) { return point.Scan == NoScan; }),
    points.end());
  motions = ipia::findScanMotions(
    points, scans.size(), scans.Centre, scans.Radius, CubeInSpacings * spacing);
  return true;
}

void vtkIPIAScanRegistration::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RequiredReduction: " << this->RequiredReduction << "\n";
  os << indent << "MaximumNumberOfIterations: " << this->MaximumNumberOfIterations << "\n";
  os << indent << "MisfitBefore: " << this->MisfitBefore << "\n";
  os << indent << "MisfitAfter: " << this->MisfitAfter << "\n";
  os << indent << "LargestMotion: " << this->LargestMotion << "\n";
  os << indent << "NumberOfIterationsUsed: " << this->NumberOfIterationsUsed << "\n";
}
