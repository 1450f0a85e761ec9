// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Scans as rigid bodies: data sets, where they are moved to, and copies of them there.
 */
#ifndef IPIAScanPoses_h
#define IPIAScanPoses_h

#include "vtkMultiBlockDataSet.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <Eigen/Geometry>

#include <vector>

class vtkDataArray;

namespace ipia
{
class ScanPoses
{
public:
  /// Of a scan, relative to Centre.
  using Pose = Eigen::Isometry3d;

  /// A scan where it is given; @a normals is the array of it that counts.
  void add(vtkPolyData* scan, vtkDataArray* normals);

  /// After all are added: the middle and half the diagonal of what they cover.
  void findExtent();

  int size() const { return static_cast<int>(this->Scans.size()); }

  /// The scan that a point is of, points being counted through all of them.
  int scanOf(vtkIdType point) const;

  /// Moves all on. A twist is a rotation vector about Centre, and a shift.
  void move(const std::vector<Eigen::Matrix<double, 6, 1>>& twists);

  /// Copies of the scans in their poses.
  vtkSmartPointer<vtkMultiBlockDataSet> moved() const;

  /// One of them, with its matrix as field data; the given points and arrays if it is not moved.
  vtkSmartPointer<vtkPolyData> moved(int scan) const;

  /// The longest way of a corner of the box of a scan.
  double largestMotion() const;

  Eigen::Vector3d Centre = Eigen::Vector3d::Zero();
  double Radius = 0;
  std::vector<Pose> Poses;

private:
  struct Scan
  {
    vtkSmartPointer<vtkPolyData> Data;
    vtkDataArray* Normals;
    vtkIdType End; ///< number of points up to its last
  };
  std::vector<Scan> Scans;
};
}

#endif
