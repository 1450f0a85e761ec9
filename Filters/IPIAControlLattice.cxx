// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAControlLattice.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>

namespace ipia
{
namespace
{
/// Index of a knot cell among the cells of the control lattice, which has one more at either end.
template <int Dim>
vtkIdType latticeCell(const Lattice<Dim>& lattice, std::int64_t cell)
{
  std::int64_t index = 0, stride = 1;
  for (int a = 0; a < Dim; ++a)
  {
    index += (cell % lattice.cells(a) + 1) * stride;
    cell /= lattice.cells(a);
    stride *= lattice.Size[a] - 1;
  }
  return index;
}
}

template <int Dim>
void toControlLattice(
  const ImplicitSpline<Dim>& spline, const Placement<Dim>& placement, vtkImageData* image)
{
  const Lattice<Dim>& lattice = spline.lattice();
  int dimensions[3] = { 1, 1, 1 };
  double origin[3] = { placement.Origin[0], placement.Origin[1], placement.Origin[2] };
  double spacing[3] = { lattice.Spacing[0], lattice.Spacing[0], lattice.Spacing[0] };
  for (int a = 0; a < Dim; ++a)
  {
    const int axis = placement.Axis[static_cast<std::size_t>(a)];
    dimensions[axis] = static_cast<int>(lattice.Size[static_cast<std::size_t>(a)]);
    spacing[axis] = lattice.Spacing[a];
    origin[axis] -= lattice.Spacing[a];
  }
  image->Initialize();
  image->SetDimensions(dimensions);
  image->SetOrigin(origin);
  image->SetSpacing(spacing);

  vtkNew<vtkDoubleArray> coefficients;
  coefficients->SetName(CoefficientArrayName);
  coefficients->SetNumberOfTuples(lattice.numberOfCoefficients());
  std::copy_n(
    spline.coefficients().data(), lattice.numberOfCoefficients(), coefficients->GetPointer(0));
  image->GetPointData()->SetScalars(coefficients);

  if (!spline.farField().Sign.empty())
  {
    vtkNew<vtkDoubleArray> far;
    far->SetName(FarFieldArrayName);
    far->SetNumberOfTuples(image->GetNumberOfCells());
    far->Fill(0);
    for (std::int64_t c = 0; c < lattice.numberOfCells(); ++c)
    {
      far->SetValue(latticeCell(lattice, c), spline.farField().value(c));
    }
    image->GetCellData()->AddArray(far);
  }
}

int dimensionOfControlLattice(vtkImageData* image)
{
  const int* n = image->GetDimensions();
  return (n[0] > 1) + (n[1] > 1) + (n[2] > 1);
}

template <int Dim>
std::string fromControlLattice(
  vtkImageData* image, std::unique_ptr<ImplicitSpline<Dim>>& spline, Placement<Dim>& placement)
{
  const int* dimensions = image->GetDimensions();
  const auto flat = std::find(dimensions, dimensions + 3, 1) - dimensions;
  placement = Placement<Dim>::withFlatAxis(static_cast<int>(flat));
  image->GetOrigin(placement.Origin.data());
  Lattice<Dim> lattice;
  for (int a = 0; a < Dim; ++a)
  {
    const auto axis = static_cast<std::size_t>(placement.Axis[static_cast<std::size_t>(a)]);
    lattice.Size[static_cast<std::size_t>(a)] = dimensions[axis];
    lattice.Spacing[a] = image->GetSpacing()[axis];
    if (dimensions[axis] < Order)
    {
      return "the control lattice has " + std::to_string(dimensions[axis]) +
        " coefficients on an axis; at least 4 are needed";
    }
    if (!(lattice.Spacing[a] > 0))
    {
      return "the spacing of the control lattice is not positive";
    }
    placement.Origin[axis] += lattice.Spacing[a] * (1 + image->GetExtent()[2 * axis]);
  }

  vtkDataArray* values = image->GetPointData()->GetArray(CoefficientArrayName);
  if (!values || values->GetNumberOfComponents() != 1 ||
    values->GetNumberOfTuples() != lattice.numberOfCoefficients())
  {
    return std::string("the control lattice has no point array ") + CoefficientArrayName +
      " with one value per point";
  }
  Vector coefficients(lattice.numberOfCoefficients());
  for (std::int64_t i = 0; i < coefficients.size(); ++i)
  {
    coefficients[i] = values->GetComponent(i, 0);
  }

  FarField far;
  vtkDataArray* farValues = image->GetCellData()->GetArray(FarFieldArrayName);
  if (farValues && farValues->GetNumberOfTuples() == image->GetNumberOfCells())
  {
    far.Sign.resize(static_cast<std::size_t>(lattice.numberOfCells()));
    for (std::int64_t c = 0; c < lattice.numberOfCells(); ++c)
    {
      const double v = farValues->GetComponent(latticeCell(lattice, c), 0);
      far.Magnitude = std::max(far.Magnitude, std::abs(v));
      far.Sign[static_cast<std::size_t>(c)] = static_cast<std::int8_t>((v > 0) - (v < 0));
    }
  }
  spline = std::make_unique<ImplicitSpline<Dim>>(lattice, std::move(coefficients), std::move(far));
  return {};
}

template void toControlLattice<2>(const ImplicitSpline<2>&, const Placement<2>&, vtkImageData*);
template void toControlLattice<3>(const ImplicitSpline<3>&, const Placement<3>&, vtkImageData*);
template std::string fromControlLattice<2>(
  vtkImageData*, std::unique_ptr<ImplicitSpline<2>>&, Placement<2>&);
template std::string fromControlLattice<3>(
  vtkImageData*, std::unique_ptr<ImplicitSpline<3>>&, Placement<3>&);
}
