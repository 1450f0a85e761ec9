// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIPIAOrientedPointCloud.h"

#include "IPIAGather.h"

#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPCANormalEstimation.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkIPIAOrientedPointCloud);

namespace
{
constexpr int FewestPoints = 4;
/// Below this share of outermost normals that point outward, a warning.
constexpr double Doubtful = 0.9;

/// All points of a data set, or of the leaves of a composite one, in one.
vtkSmartPointer<vtkPolyData> asOne(vtkDataObject* data)
{
  vtkNew<vtkAppendPolyData> append;
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  vtkSmartPointer<vtkPolyData> only;
  int parts = 0;
  const auto add = [&](vtkDataObject* part)
  {
    auto* points = vtkPointSet::SafeDownCast(part);
    if (!points || points->GetNumberOfPoints() == 0)
    {
      return;
    }
    vtkNew<vtkPolyData> bare; // cells are not wanted
    bare->SetPoints(points->GetPoints());
    bare->GetPointData()->ShallowCopy(points->GetPointData());
    append->AddInputData(bare);
    only = bare;
    ++parts;
  };
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      add(iterator->GetCurrentDataObject());
    }
  }
  else
  {
    add(data);
  }
  if (parts > 1)
  {
    append->Update();
    only = append->GetOutput();
  }
  return only;
}

/// Those points that have finite coordinates, with their arrays.
vtkSmartPointer<vtkPolyData> finitePoints(vtkPolyData* points)
{
  vtkNew<vtkIdList> kept, to;
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double x[3];
    points->GetPoint(i, x);
    if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]))
    {
      to->InsertNextId(kept->GetNumberOfIds());
      kept->InsertNextId(i);
    }
  }
  const vtkIdType n = kept->GetNumberOfIds();
  if (n == points->GetNumberOfPoints())
  {
    return points;
  }
  auto finite = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> positions;
  positions->SetDataType(points->GetPoints()->GetDataType());
  positions->SetNumberOfPoints(n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    positions->SetPoint(i, points->GetPoint(kept->GetId(i)));
  }
  finite->SetPoints(positions);
  finite->GetPointData()->CopyAllOn();
  finite->GetPointData()->CopyAllocate(points->GetPointData(), n);
  finite->GetPointData()->SetNumberOfTuples(n);
  finite->GetPointData()->CopyData(points->GetPointData(), kept, to);
  return finite;
}

/// The points about their centre: vtkPCANormalEstimation loses digits far from the origin.
vtkSmartPointer<vtkPolyData> centred(vtkPolyData* points)
{
  double bounds[6], x[3];
  points->GetBounds(bounds);
  vtkNew<vtkPoints> moved;
  moved->SetDataTypeToDouble();
  moved->SetNumberOfPoints(points->GetNumberOfPoints());
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    points->GetPoint(i, x);
    for (int axis = 0; axis < 3; ++axis)
    {
      x[axis] -= 0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]);
    }
    moved->SetPoint(i, x);
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(moved);
  return result;
}

/// Share of the outermost points, in 26 directions, whose normals point outward.
double shareOutward(vtkPolyData* points, vtkDataArray* normals)
{
  int outward = 0, directions = 0;
  for (int code = 0; code < 27; ++code)
  {
    const double direction[3] = { code % 3 - 1.0, code / 3 % 3 - 1.0, code / 9 - 1.0 };
    if (vtkMath::Norm(direction) == 0)
    {
      continue;
    }
    vtkIdType outermost = 0;
    double farthest = -VTK_DOUBLE_MAX, x[3];
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
    {
      points->GetPoint(i, x);
      const double along = vtkMath::Dot(x, direction);
      if (along > farthest)
      {
        farthest = along;
        outermost = i;
      }
    }
    double n[3];
    normals->GetTuple(outermost, n);
    outward += vtkMath::Dot(n, direction) > 0 ? 1 : 0;
    ++directions;
  }
  return static_cast<double>(outward) / directions;
}
}

vtkIPIAOrientedPointCloud::vtkIPIAOrientedPointCloud()
  : NormalSource(Neighbours)
  , NumberOfNeighbours(16)
  , Flip(false)
{
}

vtkIPIAOrientedPointCloud::~vtkIPIAOrientedPointCloud() = default;

int vtkIPIAOrientedPointCloud::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

int vtkIPIAOrientedPointCloud::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  return ipia::requestOwnParts(input, this->GetNumberOfInputPorts())
    ? 1
    : this->Superclass::RequestUpdateExtent(request, input, output);
}

vtkSmartPointer<vtkDataArray> vtkIPIAOrientedPointCloud::Estimate(vtkPolyData* points)
{
  if (points->GetNumberOfPoints() < FewestPoints)
  {
    vtkErrorMacro("The input has " << points->GetNumberOfPoints() << " point(s); at least "
                                   << FewestPoints << " are needed to estimate normals.");
    return nullptr;
  }
  const auto cloud = centred(points);
  vtkNew<vtkPCANormalEstimation> estimation;
  estimation->SetInputData(cloud);
  estimation->SetSampleSize(
    static_cast<int>(std::min<vtkIdType>(this->NumberOfNeighbours, points->GetNumberOfPoints())));
  estimation->SetNormalOrientationToGraphTraversal();
  estimation->Update();
  vtkSmartPointer<vtkDataArray> normals = estimation->GetOutput()->GetPointData()->GetNormals();
  const double outward = shareOutward(cloud, normals);
  if (outward < 0.5)
  {
    for (vtkIdType i = 0; i < normals->GetNumberOfTuples(); ++i)
    {
      double n[3];
      normals->GetTuple(i, n);
      normals->SetTuple3(i, -n[0], -n[1], -n[2]);
    }
  }
  const double right = std::max(outward, 1 - outward);
  if (right < Doubtful)
  {
    vtkWarningMacro("Only " << std::lround(100 * right)
                            << " % of the outermost of the estimated normals point outward. Where "
                               "their side is wrong the surface will be, too; try another "
                               "NumberOfNeighbours, or take normals of the scanner.");
  }
  return normals;
}

vtkSmartPointer<vtkDataArray> vtkIPIAOrientedPointCloud::Compose(vtkPolyData* points)
{
  auto normals = vtkSmartPointer<vtkFloatArray>::New();
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(points->GetNumberOfPoints());
  for (int axis = 0; axis < 3; ++axis)
  {
    vtkDataArray* values = this->GetInputArrayToProcess(axis, points);
    if (!values || values->GetNumberOfComponents() != 1 ||
      values->GetNumberOfTuples() != points->GetNumberOfPoints())
    {
      vtkErrorMacro("There is no point array of one component chosen for the "
        << "xyz"[axis] << " component of the normals.");
      return nullptr;
    }
    normals->CopyComponent(axis, values, 0);
  }
  return normals;
}

int vtkIPIAOrientedPointCloud::RequestData(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkPolyData* result = vtkPolyData::GetData(output);
  result->Initialize();
  vtkSmartPointer<vtkDataObject> data = vtkDataObject::GetData(input[0]);
  if (vtkMultiProcessController* controller = ipia::parallelController())
  {
    data = ipia::gatherPoints(controller, data).Data;
    if (controller->GetLocalProcessId() != 0)
    {
      return 1;
    }
  }
  const auto all = asOne(data);
  if (!all)
  {
    vtkErrorMacro("The input has no points.");
    return 1;
  }
  const auto points = finitePoints(all);
  const vtkIdType leftOut = all->GetNumberOfPoints() - points->GetNumberOfPoints();
  if (leftOut > 0)
  {
    vtkWarningMacro("Left out: " << leftOut << " non-finite point(s).");
  }
  this->UpdateProgress(0.1);
  const auto normals =
    this->NormalSource == Components ? this->Compose(points) : this->Estimate(points);
  if (!normals)
  {
    return 1;
  }
  if (this->Flip)
  {
    for (vtkIdType i = 0; i < normals->GetNumberOfTuples(); ++i)
    {
      double n[3];
      normals->GetTuple(i, n);
      normals->SetTuple3(i, -n[0], -n[1], -n[2]);
    }
  }
  normals->SetName("Normals");
  result->ShallowCopy(points);
  result->GetPointData()->RemoveArray("Normals");
  result->GetPointData()->SetNormals(normals);
  vtkNew<vtkCellArray> vertices;
  for (vtkIdType i = 0; i < result->GetNumberOfPoints(); ++i)
  {
    vertices->InsertNextCell(1, &i);
  }
  result->SetVerts(vertices);
  this->UpdateProgress(1);
  return 1;
}

void vtkIPIAOrientedPointCloud::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NormalSource: " << this->NormalSource << "\n";
  os << indent << "NumberOfNeighbours: " << this->NumberOfNeighbours << "\n";
  os << indent << "Flip: " << this->Flip << "\n";
}
