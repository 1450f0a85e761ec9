// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAScanPoses.h"

#include "vtkBoundingBox.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkTransform.h"

#include <algorithm>
#include <set>

namespace ipia
{
namespace
{
/// The motion of a pose about a centre, row by row.
Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrixOf(
  const ScanPoses::Pose& pose, const Eigen::Vector3d& centre)
{
  const Eigen::Isometry3d motion =
    Eigen::Translation3d(centre) * pose * Eigen::Translation3d(-centre);
  return motion.matrix();
}

/// What turns with the points: normals and vectors.
std::set<vtkDataArray*> directionsOf(vtkPointData* arrays, vtkDataArray* normals)
{
  std::set<vtkDataArray*> directions{ normals, arrays->GetNormals(), arrays->GetVectors() };
  directions.erase(nullptr);
  return directions;
}
}

void ScanPoses::add(vtkPolyData* scan, vtkDataArray* normals)
{
  const vtkIdType before = this->Scans.empty() ? 0 : this->Scans.back().End;
  this->Scans.push_back({ scan, normals, before + scan->GetNumberOfPoints() });
  this->Poses.push_back(Pose::Identity());
}

void ScanPoses::findExtent()
{
  vtkBoundingBox box;
  for (const Scan& scan : this->Scans)
  {
    box.AddBounds(scan.Data->GetBounds());
  }
  box.GetCenter(this->Centre.data());
  this->Radius = box.GetDiagonalLength() / 2;
}

int ScanPoses::scanOf(vtkIdType point) const
{
  const auto scan = std::upper_bound(this->Scans.begin(), this->Scans.end(), point,
    [](vtkIdType id, const Scan& candidate) { return id < candidate.End; });
  return static_cast<int>(scan - this->Scans.begin());
}

void ScanPoses::move(const std::vector<Eigen::Matrix<double, 6, 1>>& twists)
{
  for (std::size_t scan = 0; scan < this->Poses.size(); ++scan)
  {
    const Eigen::Vector3d rotation = twists[scan].head<3>();
    Pose step = Pose::Identity();
    if (!rotation.isZero(0))
    {
      step.rotate(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
    }
    step.pretranslate(twists[scan].tail<3>());
    this->Poses[scan] = step * this->Poses[scan];
  }
}

vtkSmartPointer<vtkPolyData> ScanPoses::moved(int index) const
{
  const Scan& scan = this->Scans[static_cast<std::size_t>(index)];
  const Pose& pose = this->Poses[static_cast<std::size_t>(index)];
  auto copy = vtkSmartPointer<vtkPolyData>::New();
  copy->ShallowCopy(scan.Data);
  const auto elements = matrixOf(pose, this->Centre);
  const bool stays = pose.matrix() == Eigen::Matrix4d::Identity();
  if (!stays)
  {
    vtkNew<vtkTransform> motion;
    motion->SetMatrix(elements.data());
    vtkNew<vtkPoints> points;
    points->SetDataType(scan.Data->GetPoints()->GetDataType());
    points->Allocate(scan.Data->GetNumberOfPoints());
    motion->TransformPoints(scan.Data->GetPoints(), points);
    copy->SetPoints(points);
    for (vtkDataArray* array : directionsOf(scan.Data->GetPointData(), scan.Normals))
    {
      const auto turned = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
      turned->SetName(array->GetName());
      turned->SetNumberOfComponents(array->GetNumberOfComponents());
      turned->Allocate(array->GetNumberOfValues());
      motion->TransformVectors(array, turned);
      vtkPointData* arrays = copy->GetPointData();
      const bool isNormals = array == arrays->GetNormals(),
                 isVectors = array == arrays->GetVectors();
      arrays->AddArray(turned);
      if (isNormals)
      {
        arrays->SetNormals(turned);
      }
      if (isVectors)
      {
        arrays->SetVectors(turned);
      }
    }
  }
  vtkNew<vtkDoubleArray> matrix;
  matrix->SetName("RegistrationMatrix");
  matrix->SetNumberOfComponents(16);
  matrix->InsertNextTypedTuple(elements.data());
  copy->GetFieldData()->AddArray(matrix);
  return copy;
}

vtkSmartPointer<vtkMultiBlockDataSet> ScanPoses::moved() const
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (int scan = 0; scan < this->size(); ++scan)
  {
    blocks->SetBlock(static_cast<unsigned int>(scan), this->moved(scan));
  }
  return blocks;
}

double ScanPoses::largestMotion() const
{
  double largest = 0;
  for (std::size_t scan = 0; scan < this->Scans.size(); ++scan)
  {
    const double* bounds = this->Scans[scan].Data->GetBounds();
    for (int corner = 0; corner < 8; ++corner)
    {
      const Eigen::Vector3d x = Eigen::Vector3d(bounds[corner & 1], bounds[2 + (corner >> 1 & 1)],
                                  bounds[4 + (corner >> 2)]) -
        this->Centre;
      largest = std::max(largest, (this->Poses[scan] * x - x).norm());
    }
  }
  return largest;
}
}
