// SPDX-License-Identifier: BSD-3-Clause
// The input of vtkFairingPIASurfaceFilter, read and checked.
#include "IPIAFairingSurface.h"

#include "Core/Parametrization.h"
#include "IPIAEarlierRound.h"
#include "IPIAText.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkStructuredGrid.h"

#include <algorithm>
#include <cmath>

namespace
{
/// Of given parameters; what goes beyond it is a slip and would ask for any amount of memory.
constexpr std::int64_t MostControlPointsPerPoint = 4;

constexpr const char* AxisNames[] = { "u", "v" };
}

std::string vtkFairingPIASurfaceFilter::Surface::checkGrid()
{
  if (auto* grid = vtkStructuredGrid::SafeDownCast(this->Input))
  {
    int size[3];
    grid->GetDimensions(size);
    const double points = double(size[0]) * size[1] * size[2];
    if (points != static_cast<double>(grid->GetNumberOfPoints()))
    {
      return ipia::text("The grid has dimensions ", ipia::triple(size), " and ",
        grid->GetNumberOfPoints(), " points. Set the dimensions that its points have.");
    }
  }
  return ipia::checkPointArrays(this->Input);
}

std::string vtkFairingPIASurfaceFilter::Surface::readGridSize()
{
  auto* grid = vtkStructuredGrid::SafeDownCast(this->Input);
  if (!grid)
  {
    return "The input is a vtkPolyData, whose points have no order in rows and columns. Give a "
           "vtkStructuredGrid, or set Parametrization to Given and give parameters.";
  }
  int size[3];
  grid->GetDimensions(size);
  int axes = 0;
  for (const int n : size)
  {
    if (n > 1 && axes < 2)
    {
      this->round().GridSize[static_cast<std::size_t>(axes)] = n;
    }
    axes += n > 1 ? 1 : 0;
  }
  if (axes != 2)
  {
    return ipia::text("The grid has dimensions ", ipia::triple(size),
      "; a surface has exactly one dimension of 1. Extract a layer with vtkExtractGrid.");
  }
  return {};
}

std::string vtkFairingPIASurfaceFilter::Surface::readPoints()
{
  const vtkIdType m = this->Input->GetNumberOfPoints();
  Eigen::MatrixXd points(m, 3);
  for (vtkIdType k = 0; k < m; ++k)
  {
    double x[3];
    this->Input->GetPoint(k, x);
    for (int c = 0; c < 3; ++c)
    {
      points(k, c) = x[c];
    }
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
    {
      return ipia::text("Point ", k, " is not finite: ", ipia::triple(x),
        ". Remove it, or fill it from its neighbours.");
    }
  }
  this->round().setPoints(points);
  if (this->round().Data.Points.isZero(0))
  {
    return ipia::text("All ", m, " points are equal; a surface needs extent. Give other points.");
  }
  return ipia::checkExtent(points);
}

std::string vtkFairingPIASurfaceFilter::Surface::readGivenParameters()
{
  vtkDataArray* given = nullptr;
  const std::string refusal =
    ipia::chooseArray(this->Filter, 3, this->Input, 2, "parameters", given);
  if (!refusal.empty())
  {
    return refusal;
  }
  if (!given)
  {
    return "Parametrization is Given, but there is no array of parameters. Choose a point array of "
           "two components with SetInputArrayToProcess(3, 0, ...).";
  }
  ipia::FairingData& data = this->round().Data;
  data.Gridded = false;
  for (const int axis : { 0, 1 })
  {
    ipia::Vector& t = data.Parameters[static_cast<std::size_t>(axis)];
    t.resize(data.Points.rows());
    for (Eigen::Index k = 0; k < t.size(); ++k)
    {
      t[k] = given->GetComponent(k, axis);
      if (!(t[k] >= 0 && t[k] <= 1))
      {
        return ipia::text("The parameter ", AxisNames[axis], " of point ", k, " is ", t[k],
          "; parameters lie in [0, 1]. Scale them.");
      }
    }
    if (t.minCoeff() == t.maxCoeff())
    {
      return ipia::text("All parameters ", AxisNames[axis], " are ", t[0],
        "; a surface needs points at different ones.");
    }
  }
  return {};
}

std::string vtkFairingPIASurfaceFilter::Surface::readGridParameters()
{
  ipia::FairingRound& round = this->round();
  const auto type = static_cast<ipia::ParametrizationType>(this->Filter->Parametrization);
  for (const int axis : { 0, 1 })
  {
    ipia::Vector& t = round.Data.Parameters[static_cast<std::size_t>(axis)];
    t = ipia::parametrizeGrid(
      round.Data.Points, round.GridSize[0], round.GridSize[1], axis, type, false);
    const std::int64_t between = axis == 0 ? 1 : round.GridSize[0];
    const std::int64_t stride = axis == 0 ? round.GridSize[0] : 1;
    const std::int64_t lines = round.GridSize[static_cast<std::size_t>(1 - axis)];
    for (Eigen::Index k = 1; k < t.size(); ++k)
    {
      bool differs = false;
      for (std::int64_t l = 0; !differs && l < lines; ++l)
      {
        differs = round.Data.Points.row((k - 1) * between + l * stride) !=
          round.Data.Points.row(k * between + l * stride);
      }
      if (!differs)
      {
        return ipia::text("Along ", AxisNames[axis], ", the points of lines ", k - 1, " and ", k,
          " of the grid are the same. Leave one of the lines out, or set Parametrization to Given "
          "and "
          "give parameters.");
      }
    }
  }
  return {};
}

std::string vtkFairingPIASurfaceFilter::Surface::start(int degree)
{
  ipia::FairingRound& round = this->round();
  const bool gridded = round.Data.Gridded;
  const double root = std::sqrt(static_cast<double>(round.Data.Points.rows()));
  std::int64_t sizes[2];
  for (const std::size_t axis : { 0u, 1u })
  {
    const std::int64_t least = degree + 1;
    const std::int64_t most = round.GridSize[axis];
    const int asked = this->Filter->NumberOfControlPoints[axis];
    const std::int64_t automatic =
      gridded ? (most + 2) / 3 : static_cast<std::int64_t>(std::ceil(root / 3));
    if (gridded && most < least)
    {
      return ipia::text("The grid has ", most, " points along ", AxisNames[axis], "; degree ",
        degree, " needs ", least, " at least. Give more points or set a lower Degree.");
    }
    const std::int64_t n = asked != 0 ? asked : std::max(least, automatic);
    if (n < least || (gridded && n > most))
    {
      return ipia::text("NumberOfControlPoints along ", AxisNames[axis], " is ", n, "; of degree ",
        degree,
        gridded ? ipia::text(" on a grid of ", most, " points it can be ", least, " to ", most, ".")
                : ipia::text(" it must be ", least, " at least."));
    }
    sizes[axis] = n;
  }
  if (!gridded && sizes[0] * sizes[1] > MostControlPointsPerPoint * round.Data.Points.rows())
  {
    return ipia::text("NumberOfControlPoints is (", sizes[0], ", ", sizes[1], "), more than ",
      MostControlPointsPerPoint, " times the ", round.Data.Points.rows(), " points. Set fewer.");
  }
  for (const std::size_t axis : { 0u, 1u })
  {
    round.Spline.Axes[axis] = gridded
      ? ipia::averagedKnots(round.Data.Parameters[axis], degree, sizes[axis], false)
      : ipia::uniformKnots(degree, sizes[axis], false);
  }
  if (gridded)
  {
    round.startFromGrid();
  }
  else
  {
    round.startFromScatteredData();
  }
  return {};
}

std::string vtkFairingPIASurfaceFilter::Surface::readEarlierRound()
{
  vtkFieldData* field = this->Controls->GetFieldData();
  vtkDataArray* offsets = field->GetArray("KnotOffsets");
  if (!field->GetArray("Degree") || !field->GetArray("Knots") || !offsets ||
    offsets->GetNumberOfTuples() != 3)
  {
    return "The control points on port 1 lack the field data Degree, Knots and KnotOffsets of a "
           "surface. Connect output 1 of an earlier round.";
  }
  ipia::EarlierKnots knots;
  std::string refusal = knots.read(
    field, 2, { false, false },
    [](std::size_t axis) { return std::string("axis ") + AxisNames[axis]; },
    this->Filter->DerivativeOrder);
  if (!refusal.empty())
  {
    return refusal;
  }
  ipia::FairingRound& round = this->round();
  for (const std::size_t axis : { 0u, 1u })
  {
    round.Spline.Axes[axis] = ipia::BSplineBasis::clamped(knots.Degree, knots.Interior[axis]);
  }
  ipia::EarlierControls controls;
  refusal = controls.read(this->Filter, this->Controls, round.Spline.size());
  return refusal.empty() ? controls.give(0, "", round) : refusal;
}

std::string vtkFairingPIASurfaceFilter::Surface::read(const ipia::FairingParameters& parameters)
{
  const vtkIdType m = this->Input ? this->Input->GetNumberOfPoints() : 0;
  const vtkIdType least = vtkIdType(parameters.Degree + 1) * (parameters.Degree + 1);
  if (m < least)
  {
    return ipia::text("The input has ", m, " points; a surface of degree ", parameters.Degree,
      " needs ", least, " at least. Give more points or set a lower Degree.");
  }
  const bool given = this->Filter->Parametrization == Given;
  std::string refusal = this->checkGrid();
  refusal = refusal.empty() && !given ? this->readGridSize() : refusal;
  refusal = refusal.empty() ? this->readPoints() : refusal;
  if (refusal.empty())
  {
    refusal = given ? this->readGivenParameters() : this->readGridParameters();
  }
  vtkDataArray* weights = nullptr;
  refusal = refusal.empty()
    ? ipia::chooseArray(this->Filter, 0, this->Input, 1, "fairing weights", weights)
    : refusal;
  if (refusal.empty() && weights)
  {
    this->round().DataWeights = ipia::toVector(weights);
    refusal = ipia::checkWeights(this->round().DataWeights, ipia::nameOf(weights));
  }
  if (!refusal.empty())
  {
    return refusal;
  }
  for (const std::size_t axis : { 0u, 1u })
  {
    this->round().InsertedKnots[axis] = this->Filter->InsertedKnots[axis];
  }
  return this->Controls ? this->readEarlierRound() : this->start(parameters.Degree);
}
