// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIPIAImplicitFunction.h"

#include "IPIAPlacedSpline.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkIPIAImplicitFunction);

namespace
{
/// nullptr with a message if the lattice is not of the right form.
template <int Dim>
std::shared_ptr<const ipia::PlacedSpline> readLattice(vtkImageData* lattice, std::string& message)
{
  std::unique_ptr<ipia::ImplicitSpline<Dim>> spline;
  ipia::Placement<Dim> place;
  message = ipia::fromControlLattice(lattice, spline, place);
  return message.empty()
    ? ipia::placedSpline<Dim>(
        std::shared_ptr<const ipia::ImplicitSpline<Dim>>(std::move(spline)), place)
    : nullptr;
}
}

vtkIPIAImplicitFunction::vtkIPIAImplicitFunction() = default;
vtkIPIAImplicitFunction::~vtkIPIAImplicitFunction() = default;

void vtkIPIAImplicitFunction::SetControlLattice(vtkImageData* lattice)
{
  std::shared_ptr<const ipia::PlacedSpline> spline;
  std::string message;
  if (lattice)
  {
    switch (ipia::dimensionOfControlLattice(lattice))
    {
      case 3:
        spline = readLattice<3>(lattice, message);
        break;
      case 2:
        spline = readLattice<2>(lattice, message);
        break;
      default:
        message = "the control lattice extends along fewer than two axes";
    }
  }
  this->SetSpline(std::move(spline));
  if (!message.empty())
  {
    vtkErrorMacro(<< "The function was not taken over: " << message << ".");
  }
}

void vtkIPIAImplicitFunction::SetSpline(std::shared_ptr<const ipia::PlacedSpline> spline)
{
  this->Fit = std::move(spline);
  this->Modified();
}

bool vtkIPIAImplicitFunction::HasControlLattice() const
{
  return this->Fit != nullptr;
}

double vtkIPIAImplicitFunction::EvaluateFunction(double x[3])
{
  return this->Fit ? this->Fit->Value(x) : 0.0;
}

void vtkIPIAImplicitFunction::EvaluateGradient(double x[3], double g[3])
{
  this->EvaluateFunctionAndGradient(x, g);
}

double vtkIPIAImplicitFunction::EvaluateFunctionAndGradient(const double x[3], double g[3])
{
  g[0] = g[1] = g[2] = 0;
  return this->Fit ? this->Fit->ValueAndGradient(x, g) : 0.0;
}

void vtkIPIAImplicitFunction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ControlLattice: " << (this->Fit ? "set" : "none") << "\n";
}
