// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIPIASurfaceReconstruction
 * @brief   points with normals in, surface out: fit by I-PIA and contour in one step
 *
 * vtkIPIASurfaceReconstruction fits an implicit B-spline function to oriented points with
 * vtkIPIAImplicitFitter and extracts its zero set: a surface in 3-D, polylines in 2-D (points and
 * normals in a plane perpendicular to an axis).
 *
 * @code
 *   vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
 *   reconstruction->SetInputConnection(points->GetOutputPort()); // vtkPolyData with point normals
 *   reconstruction->Update();
 * @endcode
 *
 * To the chain fitter, vtkFlyingEdges3D it adds:
 * - samples at half knot spacings, block by block around the surface: of the hierarchy in 3-D (the
 *   default) neither a dense lattice nor an image is ever held, so that memory and time grow with
 *   the surface. With a single level of offset rows, in 2-D, or with SampleDimensions set on the
 *   fitter, the fitter's image is contoured;
 * - a Newton step x <- x - f grad f / |grad f|^2 of every vertex, at most a third of a sample
 *   spacing, which removes most of the error of linear contouring;
 * - point normals from the exact gradient of f, towards f > 0;
 * - the component filter: components that hardly any data point is nearest to are left out;
 * - points in double precision where single would show, such as in map coordinates.
 *
 * Input ports and SetInputArrayToProcess are those of vtkIPIAImplicitFitter; its parameters are set
 * on GetFitter(). Refusals and warnings are the
 * fitter's, reported by this filter; the output is empty after a refusal or an abort.
 *
 * @sa vtkIPIAImplicitFitter vtkIPIAImplicitFunction vtkFlyingEdges3D vtkSurfaceReconstructionFilter
 */
#ifndef vtkIPIASurfaceReconstruction_h
#define vtkIPIASurfaceReconstruction_h

#include "vtkFiltersIPIAModule.h" // for the export macro
#include "vtkNew.h"               // for vtkNew
#include "vtkPolyDataAlgorithm.h"

#include <vector> // for std::vector

class vtkIPIAImplicitFitter;
class vtkImageData;

class VTKFILTERSIPIA_EXPORT vtkIPIASurfaceReconstruction : public vtkPolyDataAlgorithm
{
public:
  static vtkIPIASurfaceReconstruction* New();
  vtkTypeMacro(vtkIPIASurfaceReconstruction, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The fitter that is used: its parameters, and after Update() its results and its
   * GetImplicitFunction(). Its input is set by this filter, its outputs are left empty.
   */
  vtkIPIAImplicitFitter* GetFitter();

  ///@{
  /**
   * More rows (port 1, optional): points with target values of f, see vtkIPIAImplicitFitter.
   */
  void SetExtraRowsConnection(vtkAlgorithmOutput* output);
  void SetExtraRowsData(vtkPolyData* rows);
  ///@}

  ///@{
  /**
   * Leave out components that hardly any data point is nearest to: fewer than 24 (than a hundredth
   * of all, if that is less), or fewer than a fiftieth of what their share of the vertices would
   * make one expect. The largest stays. Default on.
   */
  vtkSetMacro(ComponentFilter, bool);
  vtkGetMacro(ComponentFilter, bool);
  vtkBooleanMacro(ComponentFilter, bool);
  ///@}

  ///@{
  /**
   * Cut the surface where the data end; see "Open surfaces" above. Default on.
   */
  vtkSetMacro(TrimUnsupported, bool);
  vtkGetMacro(TrimUnsupported, bool);
  vtkBooleanMacro(TrimUnsupported, bool);
  ///@}

  ///@{
  /**
   * How far the surface may be from the data before it counts as unsupported, in spacings of the
   * data there: it also bridges gaps and bays at the border up to twice as wide. >= 1, default 3.
   */
  vtkSetClampMacro(TrimDistance, double, 1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TrimDistance, double);
  ///@}

  ///@{
  /**
   * Unsupported parts inside the domain up to this size are holes and stay filled: their area (in
   * 2-D their length) over that of the supported surface. >= 0, default 0.3.
   */
  vtkSetClampMacro(HoleSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(HoleSize, double);
  ///@}

  ///@{
  /**
   * vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION or DEFAULT_PRECISION (the default): double
   * where rounding to float would exceed a thousandth of the knot spacing.
   */
  vtkSetClampMacro(OutputPointsPrecision, int, SINGLE_PRECISION, DEFAULT_PRECISION);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  /**
   * Number of components that the component filter left out in the last update.
   */
  vtkGetMacro(NumberOfComponentsLeftOut, int);

  /**
   * Number of unsupported parts that were cut off in the last update.
   */
  vtkGetMacro(NumberOfPartsTrimmed, int);

  /// Covers the fitter's parameters.
  vtkMTimeType GetMTime() override;

protected:
  vtkIPIASurfaceReconstruction();
  ~vtkIPIASurfaceReconstruction() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

  bool ComponentFilter;
  bool TrimUnsupported;
  double TrimDistance;
  double HoleSize;
  int OutputPointsPrecision;
  int NumberOfComponentsLeftOut;
  int NumberOfPartsTrimmed;

private:
  vtkIPIASurfaceReconstruction(const vtkIPIASurfaceReconstruction&) = delete;
  void operator=(const vtkIPIASurfaceReconstruction&) = delete;

  void ForwardEvent(vtkObject* caller, unsigned long event, void* data);
  double KnotSpacing() const;
  int PointType() const;
  void ContourImage(vtkPolyData* surface);
  void MoveOntoZeroSet(vtkPolyData* surface, vtkImageData* sampled);
  void LeaveOutComponents(vtkPolyData* surface, const std::vector<vtkIdType>& component);
  void Trim(vtkPolyData* surface);

  vtkNew<vtkIPIAImplicitFitter> Fitter;
};

#endif
