// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFairingPIASurfaceFilter
 * @brief   fair B-spline surfaces through points with parameters by fairing-PIA
 *
 * vtkFairingPIASurfaceFilter approximates points in rows and columns, or scattered points with a
 * pair of parameters each, by a tensor-product B-spline surface that is as fair as its weights ask
 * for.
 *
 * @code
 *   vtkNew<vtkFairingPIASurfaceFilter> fair;
 *   fair->SetInputConnection(grid->GetOutputPort()); // a vtkStructuredGrid of m x n x 1 points
 *   fair->SetNumberOfControlPoints(30, 20);
 *   fair->SetFairingWeight(1e-5);
 *   vtkNew<vtkPolyDataMapper> mapper;
 *   mapper->SetInputConnection(fair->GetOutputPort());
 *   mapper->SelectColorArray("MeanCurvature");
 * @endcode
 *
 * The equation, the weights, rounds and errors: vtkFairingPIAFilter.
 *
 * ### Input
 * Port 0: vtkStructuredGrid, one of whose dimensions is 1; u runs along the first of the others, v
 * along the second, and their parameters are the means over all rows and columns. Or vtkPolyData or
 * the same grid with Parametrization Given: points with parameters (u, v) in [0, 1]^2, a point
 * array of two components, SetInputArrayToProcess(3, 0, ...), default the active texture
 * coordinates. Point array 0, optional: fairing weights in [0, 1]. Port 1: control points of an
 * earlier round.
 *
 * Knots average the parameters of a grid, as in the paper; those of given parameters are uniform.
 *
 * ### Output
 * Port 0: the surface as quadrilaterals between SampleDimensions points, in double, with point
 * normals P_u x P_v (`Normals`) and the point arrays
 * - `MeanCurvature`, (k1 + k2) / 2, 1 / world units, positive where the surface bends away from its
 *   normal, as a sphere with outward normals (as vtkCurvatures), and `GaussCurvature`, k1 k2; both
 *   from exact derivatives, 0 where the surface is singular such as at poles;
 * - `Parameter`, (u, v);
 * - `FitError`, the distance |Q - S(u, v)| of the data points, world units, and the point arrays of
 *   the input: of a grid bilinear between its parameters, of given parameters those of the data
 *   point with the nearest ones.
 *
 * Port 1: the control net as lines, with `FairingWeight`, and as field data what a later round
 * needs: `Degree`, `NumberOfControlPoints` (2), `Knots` of both axes one after the other and
 * `KnotOffsets` where each begins. Port 2: the data points with all their arrays, `Parameter` and
 * `FitError`.
 *
 * @sa vtkFairingPIACurveFilter vtkIPIASurfaceReconstruction vtkCurvatures
 */
#ifndef vtkFairingPIASurfaceFilter_h
#define vtkFairingPIASurfaceFilter_h

#include "vtkFairingPIAFilter.h"
#include "vtkFiltersIPIAModule.h" // for the export macro

#include <vector> // for std::vector

class VTKFILTERSIPIA_EXPORT vtkFairingPIASurfaceFilter : public vtkFairingPIAFilter
{
public:
  static vtkFairingPIASurfaceFilter* New();
  vtkTypeMacro(vtkFairingPIASurfaceFilter, vtkFairingPIAFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Control points along u and v, each Degree + 1 or more, and no more than the grid has points
   * (given parameters: together no more than four times the points); 0
   * (the default): a third of the points of the grid, of m given parameters a third of sqrt(m). An
   * earlier round on port 1 has its own.
   */
  vtkSetVector2Macro(NumberOfControlPoints, int);
  vtkGetVector2Macro(NumberOfControlPoints, int);
  ///@}

  ///@{
  /**
   * Points of output 0 along u and v, each at least 2, at equal steps of the parameters; 0 (the
   * default): 4 per knot span.
   */
  vtkSetVector2Macro(SampleDimensions, int);
  vtkGetVector2Macro(SampleDimensions, int);
  ///@}

  ///@{
  /**
   * Knots in (0, 1) to insert before the round along an axis, 0 (u) or 1 (v). The surface to begin
   * with stays as it is; no knot may be there more than Degree times.
   */
  void InsertKnot(int axis, double knot);
  void ClearInsertedKnots();
  ///@}

protected:
  vtkFairingPIASurfaceFilter();
  ~vtkFairingPIASurfaceFilter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  std::string Fair(vtkInformationVector** input, vtkInformationVector* output,
    const ipia::FairingParameters& parameters) override;

  int NumberOfControlPoints[2];
  int SampleDimensions[2];
  std::vector<double> InsertedKnots[2];

private:
  vtkFairingPIASurfaceFilter(const vtkFairingPIASurfaceFilter&) = delete;
  void operator=(const vtkFairingPIASurfaceFilter&) = delete;

  class Surface;
};

#endif
