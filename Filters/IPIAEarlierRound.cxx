// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAEarlierRound.h"

#include "IPIAFairingRound.h"
#include "IPIAText.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ipia
{
namespace
{
/// A message where control points are not finite, or as far from the data as checkExtent() refuses.
std::string checkControlPoints(const Eigen::MatrixXd& points, const std::string& name)
{
  for (Eigen::Index j = 0; j < points.rows(); ++j)
  {
    if (!points.row(j).allFinite() || points.row(j).cwiseAbs().maxCoeff() > LargestExtent)
    {
      return text("Control point ", j, name,
        " on port 1 is not finite or too far from the data: ", triple(points.row(j).eval().data()),
        " from their centre. Remove the cause, or begin without port 1.");
    }
  }
  return {};
}

/// A message where a value that tells which control points move is not finite.
std::string checkMovable(const Vector& movable)
{
  for (Eigen::Index j = 0; j < movable.size(); ++j)
  {
    if (!std::isfinite(movable[j]))
    {
      return text("Value ", j, " of the control points that may move is ", movable[j],
        "; 0 keeps a control point, other finite values let it move. Correct it.");
    }
  }
  return {};
}

/// So many values of an array, or none without it.
Vector valuesOf(vtkDataArray* array, vtkIdType first, vtkIdType count)
{
  Vector values(array ? count : 0);
  for (vtkIdType j = 0; j < values.size(); ++j)
  {
    values[j] = array->GetComponent(first + j, 0);
  }
  return values;
}
}

double fieldNumber(vtkFieldData* field, const char* name, vtkIdType tuple)
{
  vtkDataArray* array = field->GetArray(name);
  return array && array->GetNumberOfComponents() == 1 && tuple >= 0 &&
      tuple < array->GetNumberOfTuples()
    ? array->GetComponent(tuple, 0)
    : std::numeric_limits<double>::quiet_NaN();
}

std::string EarlierKnots::read(vtkFieldData* field, std::size_t count,
  const std::vector<bool>& periodic, const std::function<std::string(std::size_t)>& name,
  int derivativeOrder)
{
  const double degree = fieldNumber(field, "Degree", 0);
  if (!(degree >= 1 && degree <= BSplineBasis::MaximumDegree))
  {
    return text("The Degree of the control points on port 1 is ", degree, "; 1 to 5 are possible.");
  }
  this->Degree = static_cast<int>(degree);
  const int p = this->Degree;
  vtkDataArray* knots = field->GetArray("Knots");
  const auto tuples = static_cast<double>(knots ? knots->GetNumberOfTuples() : 0);
  this->Interior.assign(count, {});
  for (std::size_t k = 0; k < count; ++k)
  {
    const auto tuple = static_cast<vtkIdType>(k);
    const double begin = fieldNumber(field, "KnotOffsets", tuple);
    const double end = fieldNumber(field, "KnotOffsets", tuple + 1);
    if (!(begin >= 0 && end >= begin && end <= tuples))
    {
      return text("The KnotOffsets on port 1 go from ", begin, " to ", end, " for ", name(k),
        ", and there are ", tuples, " Knots. Connect output 1 of an earlier round.");
    }
    std::vector<double>& interior = this->Interior[k];
    const auto last = static_cast<vtkIdType>(end) - p - 1;
    for (vtkIdType i = static_cast<vtkIdType>(begin) + p + 1; i < last; ++i)
    {
      interior.push_back(fieldNumber(field, "Knots", i));
    }
    const auto isInside = [](double knot) { return knot > 0 && knot < 1; };
    if (end - begin < 2 * p + 2 || !std::all_of(interior.begin(), interior.end(), isInside) ||
      !std::is_sorted(interior.begin(), interior.end()) || excessKnot(interior, p) >= 0 ||
      (periodic[k] && static_cast<int>(interior.size()) < p))
    {
      return text("The knots of ", name(k), " on port 1 are not those of degree ", p,
        ": between 0 and 1 they must rise, none more than Degree times. Connect output 1 of an "
        "earlier round.");
    }
  }
  if (derivativeOrder > p)
  {
    return text("DerivativeOrder is ", derivativeOrder,
      " and the control points on port 1 are of degree ", p, ". Set a lower DerivativeOrder.");
  }
  return {};
}

std::string EarlierControls::read(vtkAlgorithm* filter, vtkPolyData* controls, vtkIdType count)
{
  this->Controls = controls;
  if (controls->GetNumberOfPoints() != count)
  {
    return text("The knots on port 1 ask for ", count, " control points, ",
      controls->GetNumberOfPoints(), " are there. Connect output 1 of an earlier round.");
  }
  const std::string refusal =
    chooseArray(filter, 1, controls, 1, "fairing weights of control points", this->Weights);
  return refusal.empty()
    ? chooseArray(filter, 2, controls, 1, "control points that may move", this->Movable)
    : refusal;
}

std::string EarlierControls::give(
  vtkIdType first, const std::string& name, FairingRound& round) const
{
  const std::int64_t n = round.Spline.size();
  round.Spline.ControlPoints.resize(n, 3);
  for (std::int64_t j = 0; j < n; ++j)
  {
    double x[3];
    this->Controls->GetPoint(first + j, x);
    for (int c = 0; c < 3; ++c)
    {
      round.Spline.ControlPoints(j, c) = x[c] - round.Centre[c];
    }
  }
  round.ControlWeights = valuesOf(this->Weights, first, n);
  round.Movable = valuesOf(this->Movable, first, n);
  std::string refusal = checkControlPoints(round.Spline.ControlPoints, name);
  refusal = refusal.empty() ? checkMovable(round.Movable) : refusal;
  return refusal.empty() ? checkWeights(round.ControlWeights, nameOf(this->Weights)) : refusal;
}
}
