// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIPIAOrientedPointCloud
 * @brief   points with normals from points without: estimated, or from three columns
 *
 * vtkIPIAOrientedPointCloud prepares points for the other filters of IPIA. Its output is a
 * vtkPolyData of the input's points, one vertex each, with all point arrays and the active point
 * normals `Normals`, which come
 * - from the neighbours of each point (vtkPCANormalEstimation), and point outward: neighbours agree
 *   with each other, and on the outermost points, in 26 directions, most normals point outward; or
 * - from three point arrays of one component each, such as the columns nx, ny, nz of a table that
 *   became points (vtkTableToPolyData).
 *
 * Non-finite points are left out, with a warning that counts them; fewer than 4 points to estimate
 * from, and arrays that are not there, are errors. Estimated normals of parts thinner than a few
 * point spacings, and of surfaces that touch, can have the wrong side. A warning tells if fewer
 * than nine in ten of the outermost normals point outward. Normals of the scanner are better.
 *
 * With more than one rank the points of all are gathered on the first, as neighbours may lie on
 * another.
 *
 * @sa vtkPCANormalEstimation vtkPIPIASurfaceReconstruction
 */
#ifndef vtkIPIAOrientedPointCloud_h
#define vtkIPIAOrientedPointCloud_h

#include "vtkFiltersIPIAParaViewModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

class vtkDataArray;

class VTKFILTERSIPIAPARAVIEW_EXPORT vtkIPIAOrientedPointCloud : public vtkPolyDataAlgorithm
{
public:
  static vtkIPIAOrientedPointCloud* New();
  vtkTypeMacro(vtkIPIAOrientedPointCloud, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Where the normals come from.
  enum NormalSources
  {
    Neighbours = 0, ///< estimated (default)
    Components = 1  ///< three arrays, SetInputArrayToProcess 0, 1 and 2
  };

  ///@{
  /**
   * Where the normals come from. Default Neighbours.
   */
  vtkSetClampMacro(NormalSource, int, Neighbours, Components);
  vtkGetMacro(NormalSource, int);
  ///@}

  ///@{
  /**
   * Number of nearest points from which a normal is estimated, >= 4. More for noisy points, fewer
   * for fine detail. Default 16.
   */
  vtkSetClampMacro(NumberOfNeighbours, int, 4, VTK_INT_MAX);
  vtkGetMacro(NumberOfNeighbours, int);
  ///@}

  ///@{
  /**
   * Turn all normals round. Default off.
   */
  vtkSetMacro(Flip, bool);
  vtkGetMacro(Flip, bool);
  vtkBooleanMacro(Flip, bool);
  ///@}

protected:
  vtkIPIAOrientedPointCloud();
  ~vtkIPIAOrientedPointCloud() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

  int NormalSource;
  int NumberOfNeighbours;
  bool Flip;

private:
  vtkIPIAOrientedPointCloud(const vtkIPIAOrientedPointCloud&) = delete;
  void operator=(const vtkIPIAOrientedPointCloud&) = delete;

  vtkSmartPointer<vtkDataArray> Estimate(vtkPolyData* points);
  vtkSmartPointer<vtkDataArray> Compose(vtkPolyData* points);
};

#endif
