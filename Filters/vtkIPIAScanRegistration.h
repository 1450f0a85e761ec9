// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIPIAScanRegistration
 * @brief   moves scans by small rigid motions until they agree on one surface
 *
 * The blocks of a composite data set are scans of one object, placed in the same coordinates, but
 * each a little off: turned by fractions of a degree and shifted by fractions of a percent. Where
 * they overlap their surfaces lie apart, and a surface fitted to all runs somewhere between.
 * vtkIPIAScanRegistration refines their registration: it moves every scan as a rigid body so that
 * they agree, all at once, and passes them on with all their arrays.
 *
 * @code
 *   vtkNew<vtkIPIAScanRegistration> registration;
 *   registration->SetInputDataObject(scans); // blocks of vtkPolyData with point normals
 *   reconstruction->SetInputConnection(registration->GetOutputPort());
 * @endcode
 *
 * vtkIPIASurfaceReconstruction does this by itself, see its RegisterScans.
 *
 * ### Method
 * In each iteration vtkIPIAImplicitFitter fits f to the points of all scans, with at most 128 knot
 * spacings along the longest side. Points within three of these from f = 0, whose normals do not
 * oppose its gradient and which are no outliers, have the signed distance d = f / |grad f|. In
 * cubes of four knot spacings, apart by the direction that the surface faces, the differences
 * between the mean distances of the scans tell how these lie apart: the misfit is their root mean
 * square over the cubes that more than one scan reaches. The twists of all scans (rotation vector
 * about the middle of the bounding box, and shift) that make it least, to first order, are the
 * solution of one sparse linear system with robust weights; scans move by them and f is fitted
 * again, until that would lower the misfit by less than a hundredth. Scans that are off by
 * 0.3 degrees and 0.15 % of the diagonal agree to their noise after three or four iterations.
 *
 * What the data do not determine stays: scans that overlap with none are not moved, nor is a plane
 * along itself. Nothing tells which scan is right, so all count alike: in every group of scans that
 * overlap the mean of the twists is 0, and what the scans have in common (the mean of their errors)
 * remains.
 *
 * ### Scans that agree stay where they are
 * All stay, bit for bit, unless the misfit is more than a thousandth of a knot spacing and falls by
 * RequiredReduction: data that are registered as well as rigid motions can do are not touched. That
 * takes one fit.
 *
 * This is for scans that are nearly in place, off by less than about two knot spacings (1 % of the
 * diagonal); vtkIterativeClosestPointTransform or vtkLandmarkTransform bring them there.
 *
 * ### Input and output
 * Port 0: a composite data set; its blocks of vtkPolyData that have points are the scans, at least
 * two to be moved. SetInputArrayToProcess: 0, the normals (3 components; default: the active point
 * normals); 1, optional row weights, as of vtkIPIAImplicitFitter. Output: the same structure.
 * Points and normals of scans that moved (the chosen and the active ones, and active vectors) are
 * new, of the same type; all else is shared with the input. Each scan has the field data array
 * `RegistrationMatrix`, its motion as 4 x 4 matrix, row by row, world units; the identity if it
 * stays.
 *
 * ### Errors
 * Scans that vtkIPIAImplicitFitter refuses, such as without normals, are refused with its message;
 * so is a RequiredReduction that is not a number. The output is empty then, and after an abort.
 *
 * Results do not depend on the number of threads, bit for bit.
 *
 * @sa vtkIPIASurfaceReconstruction vtkIPIAImplicitFitter vtkIterativeClosestPointTransform
 */
#ifndef vtkIPIAScanRegistration_h
#define vtkIPIAScanRegistration_h

#include "vtkFiltersIPIAModule.h" // for the export macro
#include "vtkPassInputTypeAlgorithm.h"

class vtkIPIAImplicitFitter;
class vtkMultiBlockDataSet;

namespace ipia
{
struct ScanMotions;
class ScanPoses;
}

class VTKFILTERSIPIA_EXPORT vtkIPIAScanRegistration : public vtkPassInputTypeAlgorithm
{
public:
  static vtkIPIAScanRegistration* New();
  vtkTypeMacro(vtkIPIAScanRegistration, vtkPassInputTypeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The share of the misfit that motions must take away, or else all scans stay: 0, any gain will
   * do; 1, they always stay. 0 to 1, default 0.5.
   */
  vtkSetClampMacro(RequiredReduction, double, 0.0, 1.0);
  vtkGetMacro(RequiredReduction, double);
  ///@}

  ///@{
  /**
   * The most iterations. >= 1, default 10.
   */
  vtkSetClampMacro(MaximumNumberOfIterations, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumNumberOfIterations, int);
  ///@}

  ///@{
  /**
   * Of the last update: how far the scans lay apart before and after, root mean square, and the
   * farthest that a corner of a scan's bounding box was moved, world units; iterations. Misfits are
   * 0 if no scans overlap.
   */
  vtkGetMacro(MisfitBefore, double);
  vtkGetMacro(MisfitAfter, double);
  vtkGetMacro(LargestMotion, double);
  vtkGetMacro(NumberOfIterationsUsed, int);
  ///@}

protected:
  vtkIPIAScanRegistration();
  ~vtkIPIAScanRegistration() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

  double RequiredReduction;
  int MaximumNumberOfIterations;
  double MisfitBefore;
  double MisfitAfter;
  double LargestMotion;
  int NumberOfIterationsUsed;

private:
  vtkIPIAScanRegistration(const vtkIPIAScanRegistration&) = delete;
  void operator=(const vtkIPIAScanRegistration&) = delete;

  void ForwardEvent(vtkObject* caller, unsigned long event, void* data);
  bool Register(ipia::ScanPoses& scans);
  bool FindMotions(
    vtkIPIAImplicitFitter* fitter, const ipia::ScanPoses& scans, ipia::ScanMotions& motions);
};

#endif
