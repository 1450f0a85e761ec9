// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIPIAImplicitFunction
 * @brief   the fitted implicit B-spline function, exact at any point
 *
 * vtkIPIAImplicitFunction evaluates the function f that vtkIPIAImplicitFitter fits, without
 * sampling:
 *
 *     f(x) = sum_i C_i B_i(x), or sum_i C_i w_i B_i(x) / sum_i w_i B_i(x) of a rational spline,
 *
 * with the tensor-product cubic B-splines B_i of the control lattice (eq. 3 and 5 of the paper
 * named below), and its exact gradient. f < 0 inside and f > 0 outside, as for every
 * vtkImplicitFunction, so it can be given to vtkClipPolyData, vtkCutter, vtkSampleFunction and
 * vtkExtractGeometry as it is.
 *
 * It is obtained from a fitter (vtkIPIAImplicitFitter::GetImplicitFunction()) or built from a
 * control lattice, output 2 of the fitter, so that a fit can be written as .vti and read back.
 *
 * - Where a fit on a single level has no data, f is a constant of the sign of that region (the far
 *   field, see vtkIPIAImplicitFitter); its gradient there is 0.
 * - Outside the domain f is continued from the nearest point x' of the domain with the sign kept:
 *   f(x') + |x - x'| where f(x') >= 0, and f(x') - |x - x'| elsewhere.
 * - A function of a planar fit (2-D) ignores the coordinate across its plane.
 * - Without a control lattice f is 0 everywhere.
 *
 * Evaluation is thread safe; changing the lattice is not.
 *
 * Y. F. Hamza, H. Lin, Z. Li: Implicit progressive-iterative approximation for curve and surface
 * reconstruction. Computer Aided Geometric Design 77, 2020.
 *
 * @sa vtkIPIAImplicitFitter vtkImplicitFunction vtkImplicitVolume
 */
#ifndef vtkIPIAImplicitFunction_h
#define vtkIPIAImplicitFunction_h

#include "vtkFiltersIPIAModule.h" // for the export macro
#include "vtkImplicitFunction.h"

#include <memory> // for std::shared_ptr

class vtkImageData;
namespace ipia
{
class PlacedSpline;
}

class VTKFILTERSIPIA_EXPORT vtkIPIAImplicitFunction : public vtkImplicitFunction
{
public:
  static vtkIPIAImplicitFunction* New();
  vtkTypeMacro(vtkIPIAImplicitFunction, vtkImplicitFunction);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Take the function from a control lattice: point array `Coefficient` (one component, N_x N_y N_z
   * values, N >= 4 on each axis but for one axis of 1 in 2-D), and of a rational spline also point
   * array `Weight` (of the same size, finite, >= 0, not 0 at all coefficients around a knot). The
   * domain is the lattice less one
   * spacing at either end. Where the fit has a far field, the field data hold
   * - `FarField`, one component, for each box its sign, -1, 0 or 1; 0 where the spline counts. Box
   * i of an axis has the width h / 2 and the centre lo + i h / 2, i = 0 ... 2 (N - 3); x varies
   *   fastest, the flat axis of 2-D is left out.
   * - `FarFieldMagnitude`, one positive value: |f| in boxes of sign -1 or 1.
   *
   * A lattice that is not of this form is an error and leaves the function without one. nullptr
   * removes the lattice. The values are copied.
   */
  void SetControlLattice(vtkImageData* lattice);

  /// Whether there is a control lattice.
  bool HasControlLattice() const;

  using vtkImplicitFunction::EvaluateFunction;
  using vtkImplicitFunction::EvaluateGradient;

  /// f(x), x in world coordinates (before the transform of vtkImplicitFunction is applied).
  double EvaluateFunction(double x[3]) override;

  /// The exact gradient of f, per world unit.
  void EvaluateGradient(double x[3], double g[3]) override;

  /// Both at once, at about the cost of one. Returns f(x).
  double EvaluateFunctionAndGradient(const double x[3], double g[3]);

protected:
  vtkIPIAImplicitFunction();
  ~vtkIPIAImplicitFunction() override;

private:
  vtkIPIAImplicitFunction(const vtkIPIAImplicitFunction&) = delete;
  void operator=(const vtkIPIAImplicitFunction&) = delete;

  // The fitter shares its function instead of copying a lattice.
  friend class vtkIPIAImplicitFitter;
  void SetSpline(std::shared_ptr<const ipia::PlacedSpline> spline);

  std::shared_ptr<const ipia::PlacedSpline> Fit;
};

#endif
