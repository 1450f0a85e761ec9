// SPDX-License-Identifier: BSD-3-Clause
#include "IPIADomainBox.h"

#include "vtkIPIAImplicitFitter.h"

#include "vtkMath.h"

#include <algorithm>
#include <ostream>

namespace ipia
{
DomainBox::DomainBox(vtkIPIAImplicitFitter* fitter)
  : Fitter(fitter)
{
}

void DomainBox::SetUsePointBounds(bool use)
{
  this->UsePointBounds = use;
  this->Apply();
}

void DomainBox::SetOrigin(double x, double y, double z)
{
  const double origin[3] = { x, y, z };
  std::copy_n(origin, 3, this->Origin);
  this->Apply();
}

void DomainBox::SetLength(double x, double y, double z)
{
  const double length[3] = { x, y, z };
  std::copy_n(length, 3, this->Length);
  this->Apply();
}

void DomainBox::Apply()
{
  double bounds[6];
  vtkMath::UninitializeBounds(bounds);
  for (int axis = 0; axis < 3 && !this->UsePointBounds; ++axis)
  {
    bounds[2 * axis] = this->Origin[axis];
    // A negative length is as one of 0, an empty domain, which is refused: bounds the wrong way
    // round would be taken for none.
    bounds[2 * axis + 1] = this->Origin[axis] + std::max(this->Length[axis], 0.0);
  }
  this->Fitter->SetModelBounds(bounds);
}

void DomainBox::Print(std::ostream& os, vtkIndent indent) const
{
  const auto print = [&](const char* name, const double* x)
  { os << indent << name << ": (" << x[0] << ", " << x[1] << ", " << x[2] << ")\n"; };
  os << indent << "UsePointBounds: " << this->UsePointBounds << "\n";
  print("ModelBoundsOrigin", this->Origin);
  print("ModelBoundsLength", this->Length);
}
}
