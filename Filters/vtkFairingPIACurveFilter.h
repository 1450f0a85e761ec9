// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFairingPIACurveFilter
 * @brief   fair B-spline curves through polylines by fairing-PIA
 *
 * vtkFairingPIACurveFilter approximates the points of every line of its input by a B-spline curve
 * that is as fair as its weights ask for, in the plane or in space, open or closed.
 *
 * @code
 *   vtkNew<vtkFairingPIACurveFilter> fair;
 *   fair->SetInputConnection(lines->GetOutputPort()); // vtkPolyData with lines
 *   fair->SetFairingWeight(1e-5);
 *   vtkNew<vtkPolyDataMapper> mapper;
 *   mapper->SetInputConnection(fair->GetOutputPort());
 * @endcode
 *
 * One segment after the other, as the method is meant to be used:
 *
 * @code
 *   fair->Update();                                       // a first round with equal weights
 *   vtkNew<vtkPolyData> controls;
 *   controls->DeepCopy(fair->GetOutputDataObject(1));
 *   vtkDataArray* weights = controls->GetPointData()->GetArray("FairingWeight");
 *   for (int j = 20; j < 30; ++j) { weights->SetComponent(j, 0, 1e-3); }
 *   fair->SetControlPointsData(controls);                 // the next one goes on from there
 *   fair->Update();
 * @endcode
 *
 * The equation, the weights, rounds and errors: vtkFairingPIAFilter.
 *
 * ### Input
 * Port 0: vtkPolyData, each cell of its lines the points of one curve in order. A curve is closed
 * if its line ends where it begins (Closure). Point arrays: 0, fairing weights in [0, 1]; 3, with
 * Parametrization Given, parameters in [0, 1] that do not fall along a line (closed: the curve
 * comes back to 0 at 1). Port 1: control points of an earlier round.
 *
 * ### Output
 * Port 0: the curves as polylines of SampleDimensions points each, in double, with the point arrays
 * - `Parameter`, in [0, 1];
 * - `Curvature`, |P' x P''| / |P'|^3, 1 / world units, and `Torsion`, det(P', P'', P''') / |P' x
 *   P''|^2, positive for right-handed helices, 0 on straight pieces;
 * - `CurvatureNormal`, the curvature times the principal normal: combs are drawn by
 *   vtkHedgeHog or vtkWarpVector with its negative;
 * - `FitError`, the distance |Q - P(t)| of the data points, world units, and the point arrays of
 * the input, both linear between the parameters of the data points.
 *
 * Port 1: the control points as polylines, with `FairingWeight`, and as field data all that a later
 * round needs: `Degree`, `Closed` (1 per curve), `Knots` of all curves one after the other and
 * `KnotOffsets` where each begins. Knots of an open curve: the first and the last are degree + 1
 * times 0 and 1; of a closed one they go on beyond [0, 1] by degree knots on both sides, with
 * period
 * 1. Port 2: the data points of each curve, with all their arrays, `Parameter` and `FitError`.
 *
 * @sa vtkFairingPIASurfaceFilter vtkParametricSpline vtkStripper
 */
#ifndef vtkFairingPIACurveFilter_h
#define vtkFairingPIACurveFilter_h

#include "vtkFairingPIAFilter.h"
#include "vtkFiltersIPIAModule.h" // for the export macro

#include <vector> // for std::vector

class VTKFILTERSIPIA_EXPORT vtkFairingPIACurveFilter : public vtkFairingPIAFilter
{
public:
  static vtkFairingPIACurveFilter* New();
  vtkTypeMacro(vtkFairingPIACurveFilter, vtkFairingPIAFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Control points of each curve, Degree + 1 to the number of its points; 0 (the default): a third
   * of them. An earlier round on port 1 has its own.
   */
  vtkSetClampMacro(NumberOfControlPoints, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfControlPoints, int);
  ///@}

  ///@{
  /**
   * Points of output 0 per curve, at least 2, at equal steps of the parameter; 0 (the default): 10
   * per knot span.
   */
  vtkSetClampMacro(SampleDimensions, int, 0, VTK_INT_MAX);
  vtkGetMacro(SampleDimensions, int);
  ///@}

  /// Which curves are closed.
  enum Closures
  {
    AutomaticClosure =
      0, ///< those whose line ends in the point or at the place where it began (default)
    OpenCurves = 1,
    ClosedCurves = 2 ///< all; the first point may be repeated at the end, or not
  };

  ///@{
  /**
   * Default AutomaticClosure. Closed curves are as smooth where they begin as elsewhere.
   */
  vtkSetClampMacro(Closure, int, AutomaticClosure, ClosedCurves);
  vtkGetMacro(Closure, int);
  void SetClosureToAutomaticClosure() { this->SetClosure(AutomaticClosure); }
  void SetClosureToOpenCurves() { this->SetClosure(OpenCurves); }
  void SetClosureToClosedCurves() { this->SetClosure(ClosedCurves); }
  ///@}

  ///@{
  /**
   * Knots in (0, 1) to insert before the round, into every curve. The curve to begin with stays as
   * it is; no knot may be there more than Degree times.
   */
  void InsertKnot(double knot);
  void ClearInsertedKnots();
  int GetNumberOfInsertedKnots();
  double GetInsertedKnot(int i);
  ///@}

protected:
  vtkFairingPIACurveFilter();
  ~vtkFairingPIACurveFilter() override;

  std::string Fair(vtkInformationVector** input, vtkInformationVector* output,
    const ipia::FairingParameters& parameters) override;

  int NumberOfControlPoints;
  int SampleDimensions;
  int Closure;
  std::vector<double> InsertedKnots;

private:
  vtkFairingPIACurveFilter(const vtkFairingPIACurveFilter&) = delete;
  void operator=(const vtkFairingPIACurveFilter&) = delete;

  class Curves;
};

#endif
