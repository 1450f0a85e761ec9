// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIPIAImplicitFunction.h"

#include "IPIAControlLattice.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkIPIAImplicitFunction);

/// A spline of either dimension, placed in space.
class vtkIPIAImplicitFunction::Spline
{
public:
  virtual ~Spline() = default;
  virtual double Value(const double x[3]) const = 0;
  virtual double ValueAndGradient(const double x[3], double g[3]) const = 0;

  /// nullptr with a message if the lattice is not of the right form.
  static std::shared_ptr<const Spline> FromLattice(vtkImageData* lattice, std::string& message);

private:
  template <int Dim>
  class OfDimension;
};

template <int Dim>
class vtkIPIAImplicitFunction::Spline::OfDimension : public Spline
{
public:
  double Value(const double x[3]) const override
  {
    return this->Function->value(this->Place.toLocal(x));
  }

  double ValueAndGradient(const double x[3], double g[3]) const override
  {
    ipia::Point<Dim> gradient;
    const double f = this->Function->valueAndGradient(this->Place.toLocal(x), gradient);
    this->Place.toWorldVector(gradient, g);
    return f;
  }

  std::unique_ptr<ipia::ImplicitSpline<Dim>> Function;
  ipia::Placement<Dim> Place;
};

std::shared_ptr<const vtkIPIAImplicitFunction::Spline> vtkIPIAImplicitFunction::Spline::FromLattice(
  vtkImageData* lattice, std::string& message)
{
  const auto read = [&](auto fit) -> std::shared_ptr<const Spline>
  {
    message = ipia::fromControlLattice(lattice, fit->Function, fit->Place);
    return message.empty() ? fit : nullptr;
  };
  switch (ipia::dimensionOfControlLattice(lattice))
  {
    case 3:
      return read(std::make_shared<OfDimension<3>>());
    case 2:
      return read(std::make_shared<OfDimension<2>>());
    default:
      message = "the control lattice extends along fewer than two axes";
      return nullptr;
  }
}

vtkIPIAImplicitFunction::vtkIPIAImplicitFunction() = default;
vtkIPIAImplicitFunction::~vtkIPIAImplicitFunction() = default;

void vtkIPIAImplicitFunction::SetControlLattice(vtkImageData* lattice)
{
  this->Fit.reset();
  this->Modified();
  std::string message;
  if (lattice)
  {
    this->Fit = Spline::FromLattice(lattice, message);
  }
  if (!message.empty())
  {
    vtkErrorMacro(<< "The function was not taken over: " << message << ".");
  }
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
