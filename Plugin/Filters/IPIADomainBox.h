// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The domain of a fit as a tick box and a box.
 */
#ifndef IPIADomainBox_h
#define IPIADomainBox_h

#include "vtkFiltersIPIAParaViewModule.h" // for the export macro
#include "vtkIndent.h"

#include <iosfwd>

class vtkIPIAImplicitFitter;

namespace ipia
{
/// Sets ModelBounds of a fitter: to those of the box, or to none, which mean those of the points.
class VTKFILTERSIPIAPARAVIEW_EXPORT DomainBox
{
public:
  explicit DomainBox(vtkIPIAImplicitFitter* fitter);

  void SetUsePointBounds(bool use);
  void SetOrigin(double x, double y, double z);
  void SetLength(double x, double y, double z);
  bool GetUsePointBounds() const { return this->UsePointBounds; }
  double* GetOrigin() { return this->Origin; }
  double* GetLength() { return this->Length; }

  void Print(std::ostream& os, vtkIndent indent) const;

private:
  void Apply();

  vtkIPIAImplicitFitter* Fitter;
  bool UsePointBounds = true;
  double Origin[3] = { 0, 0, 0 };
  double Length[3] = { 1, 1, 1 };
};
}

#endif
