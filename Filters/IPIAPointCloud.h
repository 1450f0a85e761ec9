// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The input of the fit, taken out of VTK's data sets and sorted into what can be used and what not.
 */
#ifndef IPIAPointCloud_h
#define IPIAPointCloud_h

#include "Core/BulkVector.h"
#include "IPIAFrame.h"

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataObject;

namespace ipia
{
/// Positions or normals in space.
using SpacePoints = BulkVector<std::array<double, 3>>;

/**
 * Points with unit normals in world coordinates, and what was found about them.
 */
class PointCloud
{
public:
  /// Indices of SetInputArrayToProcess.
  enum ArrayIndex
  {
    NormalsIndex = 0,
    WeightsIndex = 1,
    ExtraValuesIndex = 2,
    LocalFairingIndex = 3
  };

  /// The array of a data set that was chosen for an index, or nullptr.
  using ArrayChooser = std::function<vtkDataArray*(int index, vtkDataObject* data)>;

  /// The name that was given for an index, or nothing.
  using ArrayNamer = std::function<std::string(int index)>;

  /**
   * Takes all finite points of @a input (vtkPolyData or a composite of them) and of @a extraRows
   * (vtkPolyData or nullptr), with the arrays that @a choose finds; an optional one that is not
   * there although it has a name is refused.
   */
  void gather(const ArrayChooser& choose, const ArrayNamer& nameOf, vtkDataObject* input,
    vtkPolyData* extraRows);

  /// Whether the lengths of normals count as weights, on gather().
  bool UseNormalLengths = false;

  /// Why nothing can be fitted; empty if all is well.
  std::string Refusal;

  /// The input as one data set; Ids are the points of it that were taken.
  vtkSmartPointer<vtkPolyData> Source;
  /// The parts that it was made of, in the order of its points.
  std::vector<vtkSmartPointer<vtkPolyData>> Blocks;
  /// The arrays of normals, weights and local fairing weights that were chosen in each block
  /// (nullptr: none), and that of the values of extra rows.
  std::vector<vtkDataArray*> ChosenArrays;
  BulkVector<vtkIdType> Ids;
  SpacePoints Positions;
  SpacePoints Normals;              ///< unit length, or 0 where there is none
  std::vector<double> Weights;      ///< empty: 1
  std::vector<double> LocalFairing; ///< empty: 1
  std::vector<double> Feathering;   ///< factors that Weights have; empty: not feathered
  SpacePoints ExtraPositions;
  std::vector<double> ExtraValues;

  /// What was left out, for one warning.
  struct LeftOutCounts
  {
    vtkIdType NonFinitePoints = 0;
    vtkIdType InvalidNormals = 0;
    vtkIdType InvalidWeights = 0;
    vtkIdType NonFiniteExtraRows = 0;

    vtkIdType Total() const
    {
      return this->NonFinitePoints + this->InvalidNormals + this->InvalidWeights +
        this->NonFiniteExtraRows;
    }
  } LeftOut;

  /// min and max per axis.
  std::array<double, 6> Bounds{};

  double longestSide() const;

  /// True if the points lie on a line, whatever its direction.
  bool isLine() const;

  /// The axis that all points and normals are perpendicular to, or -1.
  int flatAxis() const;

  /// Whether all points and normals lie in a plane that is perpendicular to no axis; a frame, and
  /// the axis of it that is across the plane. False for points on a line.
  bool tiltedPlane(Frame& frame, int& axis) const;

  /// min and max per axis in a frame.
  std::array<double, 6> boundsIn(const Frame& frame) const;

  /// The axis along which the points have no extent, or -1; normals may have any direction.
  int axisWithoutExtent() const;

  /**
   * For each point the largest distance up to @a distance along @a side (+1 or -1) times its normal
   * at which the position is not nearer to another data point, a tenth forgiven so that noise does
   * not draw it in: the shrinking ball of the medial axis. 0 where there is no normal.
   */
  std::vector<double> offsetDistances(double distance, double side) const;

  /// Multiplies the weights of all points by factors, if there are any.
  void feather(const std::vector<double>& factors);

  /// Leaves out the other points, with all that belongs to them.
  void keepIf(const std::function<bool(std::size_t)>& stays);

private:
  struct Found;

  Found takePoints(vtkDataArray* normals, vtkDataArray* weights, vtkDataArray* fairing);
  void gatherExtraRows(const ArrayChooser& choose, vtkPolyData* extraRows);
};

/// A copy without some of the points, whose numbers are ascending; nullptr if there are none.
std::unique_ptr<PointCloud> withoutPoints(
  const PointCloud& cloud, const std::vector<std::int64_t>& points);
}

#endif
