// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAControlLattice.h"

#include "Core/RationalSolver.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSignedCharArray.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>

namespace ipia
{
namespace
{
/// One value per coefficient as a point array.
vtkSmartPointer<vtkDoubleArray> newPointArray(const char* name, const Vector& values)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfTuples(values.size());
  std::copy_n(values.data(), values.size(), array->GetPointer(0));
  return array;
}

/// Reads one value per coefficient. Returns what is wrong, or an empty string.
std::string readPointArray(vtkPointData* data, const char* name, std::int64_t size, Vector& values)
{
  vtkDataArray* array = data->GetArray(name);
  if (!array || array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != size)
  {
    return std::string("the control lattice has no point array ") + name +
      " with one value per point";
  }
  values.resize(size);
  for (std::int64_t i = 0; i < size; ++i)
  {
    values[i] = array->GetComponent(i, 0);
    if (!std::isfinite(values[i]))
    {
      return std::string("value ") + std::to_string(i) + " of the point array " + name +
        " of the control lattice is not finite";
    }
  }
  return {};
}

/// Reads the weights of a rational spline, if it is one. Returns what is wrong, or an empty string.
template <int Dim>
std::string readWeights(vtkPointData* data, const Lattice<Dim>& lattice, Vector& weights)
{
  if (!data->HasArray(WeightArrayName))
  {
    return {};
  }
  std::string wrong =
    readPointArray(data, WeightArrayName, lattice.numberOfCoefficients(), weights);
  if (wrong.empty() &&
    !std::all_of(weights.begin(), weights.end(), [](double w) { return w >= 0; }))
  {
    wrong = std::string("the point array ") + WeightArrayName +
      " of the control lattice has negative values";
  }
  // A factor of all weights changes nothing.
  if (wrong.empty() && !hasPositiveDenominators<Dim>(lattice, weights / weights.maxCoeff()))
  {
    wrong = std::string("the point array ") + WeightArrayName +
      " of the control lattice is 0 all around a knot, where f would be 0 / 0";
  }
  return wrong;
}

void addFarField(const FarField& far, vtkFieldData* field)
{
  vtkNew<vtkSignedCharArray> signs;
  signs->SetName(FarFieldArrayName);
  signs->SetNumberOfTuples(static_cast<vtkIdType>(far.Sign.size()));
  std::copy(far.Sign.begin(), far.Sign.end(), signs->GetPointer(0));
  field->AddArray(signs);
  vtkNew<vtkDoubleArray> magnitude;
  magnitude->SetName(FarFieldMagnitudeArrayName);
  magnitude->InsertNextValue(far.Magnitude);
  field->AddArray(magnitude);
}

/// Reads the far field of that many boxes, if there is one. Returns what is wrong, or an empty
/// string.
std::string readFarField(vtkFieldData* field, std::int64_t boxes, FarField& far)
{
  vtkDataArray* signs = field->GetArray(FarFieldArrayName);
  if (!signs)
  {
    return {};
  }
  if (signs->GetNumberOfComponents() != 1 || signs->GetNumberOfTuples() != boxes)
  {
    return std::string("the field array ") + FarFieldArrayName + " of the control lattice has " +
      std::to_string(signs->GetNumberOfTuples()) + " values of " +
      std::to_string(signs->GetNumberOfComponents()) + " component(s); " + std::to_string(boxes) +
      " of one are needed";
  }
  vtkDataArray* magnitude = field->GetArray(FarFieldMagnitudeArrayName);
  if (!magnitude || magnitude->GetNumberOfValues() != 1 ||
    !(magnitude->GetComponent(0, 0) > 0 && std::isfinite(magnitude->GetComponent(0, 0))))
  {
    return std::string("the control lattice has a field array ") + FarFieldArrayName +
      ", but no field array " + FarFieldMagnitudeArrayName + " with one positive value";
  }
  far.Magnitude = magnitude->GetComponent(0, 0);
  far.Sign.resize(static_cast<std::size_t>(boxes));
  for (std::int64_t b = 0; b < boxes; ++b)
  {
    const double sign = signs->GetComponent(b, 0);
    if (sign != -1 && sign != 0 && sign != 1)
    {
      return std::string("the field array ") + FarFieldArrayName +
        " of the control lattice has values other than -1, 0 and 1";
    }
    far.Sign[static_cast<std::size_t>(b)] = static_cast<std::int8_t>(sign);
  }
  return {};
}
}

void placeImage(const Frame& frame, const double origin[3], vtkImageData* image)
{
  const std::array<double, 3> world = frame.toWorld(origin);
  image->SetOrigin(world.data());
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> direction = frame.direction();
  image->SetDirectionMatrix(direction.data());
}

void turnVectors(const Frame& frame, vtkDataArray* vectors)
{
  for (vtkIdType i = 0; frame.isTurned() && i < vectors->GetNumberOfTuples(); ++i)
  {
    vectors->SetTuple(i, frame.vectorToWorld(vectors->GetTuple3(i)).data());
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
  placeImage(placement.Turn, origin, image);
  image->SetSpacing(spacing);

  image->GetPointData()->SetScalars(newPointArray(CoefficientArrayName, spline.coefficients()));
  if (spline.isRational())
  {
    image->GetPointData()->AddArray(newPointArray(WeightArrayName, spline.weights()));
  }

  if (!spline.farField().Sign.empty())
  {
    addFarField(spline.farField(), image->GetFieldData());
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
  const Eigen::Matrix3d direction = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
    image->GetDirectionMatrix()->GetData());
  if (!direction.isUnitary(1e-9))
  {
    return "the direction matrix of the control lattice is not orthonormal";
  }
  placement.Turn = { Eigen::Map<const Eigen::Vector3d>(image->GetOrigin()), direction };
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
    if (!(lattice.Spacing[a] > 0 && std::isfinite(lattice.Spacing[a])))
    {
      return "the spacing of the control lattice is not positive and finite";
    }
    if (!std::isfinite(placement.Origin[axis]))
    {
      return "the origin of the control lattice is not finite";
    }
    placement.Origin[axis] += lattice.Spacing[a] * (1 + image->GetExtent()[2 * axis]);
  }

  Vector coefficients, weights;
  FarField far;
  std::string wrong = readPointArray(
    image->GetPointData(), CoefficientArrayName, lattice.numberOfCoefficients(), coefficients);
  if (wrong.empty())
  {
    wrong = readWeights(image->GetPointData(), lattice, weights);
  }
  if (wrong.empty())
  {
    wrong = readFarField(image->GetFieldData(), lattice.numberOfBoxes(), far);
  }
  if (!wrong.empty())
  {
    return wrong;
  }
  spline = weights.size() > 0
    ? std::make_unique<ImplicitSpline<Dim>>(
        lattice, std::move(coefficients), std::move(weights), std::move(far))
    : std::make_unique<ImplicitSpline<Dim>>(lattice, std::move(coefficients), std::move(far));
  return {};
}

template void toControlLattice<2>(const ImplicitSpline<2>&, const Placement<2>&, vtkImageData*);
template void toControlLattice<3>(const ImplicitSpline<3>&, const Placement<3>&, vtkImageData*);
template std::string fromControlLattice<2>(
  vtkImageData*, std::unique_ptr<ImplicitSpline<2>>&, Placement<2>&);
template std::string fromControlLattice<3>(
  vtkImageData*, std::unique_ptr<ImplicitSpline<3>>&, Placement<3>&);
}
