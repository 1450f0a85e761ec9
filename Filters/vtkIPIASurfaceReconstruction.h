// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIPIASurfaceReconstruction
 * @brief   points with normals in, surface out: fit by I-PIA and contour in one step
 *
 * vtkIPIASurfaceReconstruction fits an implicit B-spline function to oriented points with
 * vtkIPIAImplicitFitter and extracts its zero set: a surface in 3-D, polylines in 2-D (points and
 * normals in a plane).
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
 * - the point arrays of the input (colours, scalars, vectors) at its vertices, as smooth functions
 *   v(x) fitted as vtkIPIAImplicitFitter tells, with the active attributes that they were;
 * - registration: the blocks of a composite input are scans, and are moved together where they lie
 *   apart, see RegisterScans;
 * - the component filter: components that hardly any data point is nearest to are left out;
 * - trimming: where data end the surface ends, see "Open surfaces";
 * - points in double precision where single would show, such as in map coordinates.
 *
 * ### Open surfaces
 * f = 0 goes on where data end: up to the sides of the domain, or round behind the data. With
 * TrimUnsupported (the default) it is cut off there. A vertex is unsupported if it is farther from
 * the data than TrimDistance times their local spacing, which around each point is that of the
 * third of six sectors of neighbours: uneven density does not count, nor the gaps between scan
 * lines up to about twenty times as dense along as across. Connected unsupported parts are cut off
 * if they reach a side of the domain (of an automatic one also where it is nearer than
 * TrimDistance), or if they are larger than HoleSize; the others are holes in the data and stay
 * filled. If any is cut off, so are those that are hidden from where the data were seen, such as
 * walls between the roofs and the ground of a scan from the air. A part is hidden if the data
 * nearest to its border mostly face one way (the mean of their normals is longer than 0.7) and it
 * does not: its area that faces this way is less than half of its area. The cut runs back towards
 * the data to half a spacing from the outermost ones, as if a ball were rolled along them, through
 * triangles rather than along their edges. New vertices lie on f = 0 and have exact normals; other
 * point arrays are interpolated. Curves are cut alike, but for hidden parts.
 *
 * A hole whose filling reaches a side of the domain, such as one at the very top of a model, is cut
 * out; more Padding lets it close. An opening inside the domain smaller than HoleSize is taken for
 * a hole. Closed, evenly sampled surfaces are left as they are.
 *
 * Input ports and SetInputArrayToProcess are those of vtkIPIAImplicitFitter; its parameters are set
 * on GetFitter(). Refusals and warnings are the fitter's, reported by this filter; the output is
 * empty after a refusal or an abort.
 *
 * @sa vtkIPIAImplicitFitter vtkIPIAImplicitFunction vtkIPIAScanRegistration vtkFlyingEdges3D
 * vtkSurfaceReconstructionFilter
 */
#ifndef vtkIPIASurfaceReconstruction_h
#define vtkIPIASurfaceReconstruction_h

#include "vtkFiltersIPIAModule.h" // for the export macro
#include "vtkNew.h"               // for vtkNew
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h" // for vtkSmartPointer

#include <vector> // for std::vector

class vtkDataArraySelection;
class vtkIPIAImplicitFitter;
class vtkIPIAScanRegistration;
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

  /**
   * The fitter's choice of the point arrays that the surface has, see vtkIPIAImplicitFitter.
   */
  vtkDataArraySelection* GetPointDataArraySelection();

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
   * How far the surface may be from the data before it counts as unsupported, in local spacings of
   * the data; gaps and bays of the border up to twice as wide are bridged. On the sides of an
   * automatic domain it is 1. >= 1, default 3.
   */
  vtkSetClampMacro(TrimDistance, double, 1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TrimDistance, double);
  ///@}

  ///@{
  /**
   * Unsupported parts inside the domain up to this size are holes and stay filled: their area (in
   * 2-D their length) over that of the supported surface. >= 0, default 0.15.
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

  ///@{
  /**
   * Register the scans of a composite input with vtkIPIAScanRegistration before the fit: blocks
   * that lie apart where they overlap are moved together, with a warning that tells how far, if
   * small rigid motions take away half of what separates them or more. Otherwise, and with the
   * fitter's Incremental, whose earlier points must stay, they are used as they are. Default on.
   */
  vtkSetMacro(RegisterScans, bool);
  vtkGetMacro(RegisterScans, bool);
  vtkBooleanMacro(RegisterScans, bool);
  ///@}

  /**
   * What registers the scans: its parameters, and after Update() its results.
   */
  vtkIPIAScanRegistration* GetRegistration();

  /**
   * Number of components that the component filter left out in the last update.
   */
  vtkGetMacro(NumberOfComponentsLeftOut, int);

  /**
   * Number of unsupported parts that were cut off in the last update.
   */
  vtkGetMacro(NumberOfPartsTrimmed, int);

  /// Covers the parameters of fitter and registration.
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
  bool RegisterScans;
  int NumberOfComponentsLeftOut;
  int NumberOfPartsTrimmed;

private:
  vtkIPIASurfaceReconstruction(const vtkIPIASurfaceReconstruction&) = delete;
  void operator=(const vtkIPIASurfaceReconstruction&) = delete;

  void ForwardEvent(vtkObject* caller, unsigned long event, void* data);
  bool IsToRegister(vtkDataObject* points) const;
  std::vector<vtkMTimeType> IdentityOf(vtkInformationVector** input);
  vtkSmartPointer<vtkDataObject> Registered(vtkDataObject* scans);
  int PointType() const;
  void ContourImage(vtkPolyData* surface);
  void MoveOntoZeroSet(vtkPolyData* surface, vtkImageData* sampled);
  void LeaveOutComponents(vtkPolyData* surface, const std::vector<vtkIdType>& component);
  void Trim(vtkPolyData* surface);

  vtkNew<vtkIPIAImplicitFitter> Fitter;
  vtkNew<vtkIPIAScanRegistration> Registration;
  std::vector<vtkMTimeType> InputIdentity; // of what the fitter has copies of
  double ProgressBeforeFit = 0;
};

#endif
