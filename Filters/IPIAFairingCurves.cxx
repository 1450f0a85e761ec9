// SPDX-License-Identifier: BSD-3-Clause
// The input of vtkFairingPIACurveFilter, read and checked.
#include "IPIAFairingCurves.h"

#include "Core/Parametrization.h"
#include "IPIAEarlierRound.h"
#include "IPIAText.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>

std::string vtkFairingPIACurveFilter::Curves::readLines()
{
  const vtkIdType points = this->Input->GetNumberOfPoints();
  auto cell = vtkSmartPointer<vtkCellArrayIterator>::Take(this->Input->GetLines()->NewIterator());
  for (cell->GoToFirstCell(); !cell->IsDoneWithTraversal(); cell->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    cell->GetCurrentCell(size, ids);
    Line line;
    line.Ids.assign(ids, ids + size);
    for (const vtkIdType id : line.Ids)
    {
      if (id < 0 || id >= points)
      {
        return ipia::text("Line ", this->Lines.size(), " has a point ", id, "; the input has ",
          points, " points, from 0 on. Correct the line.");
      }
    }
    bool returns = false;
    if (size > 2)
    {
      double first[3], last[3];
      this->Input->GetPoint(ids[0], first);
      this->Input->GetPoint(ids[size - 1], last);
      returns = std::equal(first, first + 3, last);
    }
    line.Closed = this->Filter->Closure == ClosedCurves ||
      (this->Filter->Closure == AutomaticClosure && returns);
    if (line.Closed && returns)
    {
      line.Ids.pop_back();
    }
    this->Lines.push_back(std::move(line));
  }
  if (this->Lines.empty())
  {
    return "The input has no lines. Every curve is one polyline (vtkPolyData with lines); "
           "vtkStripper "
           "joins segments.";
  }
  return ipia::checkPointArrays(this->Input);
}

std::string vtkFairingPIACurveFilter::Curves::readPoints(std::size_t k)
{
  const Line& line = this->Lines[k];
  Eigen::MatrixXd points(static_cast<Eigen::Index>(line.Ids.size()), 3);
  for (std::size_t i = 0; i < line.Ids.size(); ++i)
  {
    double x[3];
    this->Input->GetPoint(line.Ids[i], x);
    for (int c = 0; c < 3; ++c)
    {
      points(static_cast<Eigen::Index>(i), c) = x[c];
    }
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
    {
      return ipia::text("Point ", line.Ids[i], " of line ", k, " is not finite: ", ipia::triple(x),
        ". Remove it from the line.");
    }
  }
  this->Rounds[k].setPoints(points);
  this->Rounds[k].GridSize = { points.rows(), 1 };
  return ipia::checkExtent(points);
}

std::string vtkFairingPIACurveFilter::Curves::readParameters(std::size_t k, vtkDataArray* given)
{
  const Line& line = this->Lines[k];
  ipia::FairingRound& round = this->Rounds[k];
  const Eigen::MatrixXd& points = round.Data.Points;
  round.Data.Parameters[1] = ipia::Vector::Zero(1);
  ipia::Vector& t = round.Data.Parameters[0];
  if (!given)
  {
    for (std::size_t i = 1; i < line.Ids.size() + (line.Closed ? 1 : 0); ++i)
    {
      const auto a = static_cast<Eigen::Index>(i - 1);
      const auto b = static_cast<Eigen::Index>(i % line.Ids.size());
      if (points.row(a) == points.row(b))
      {
        return ipia::text("Points ", line.Ids[i - 1], " and ", line.Ids[i % line.Ids.size()],
          " follow each other on line ", k,
          " at the same place. Leave one of them out (vtkCleanPolyData), or set Parametrization to "
          "Given and give parameters.");
      }
    }
    t = ipia::parametrize(
      points, static_cast<ipia::ParametrizationType>(this->Filter->Parametrization), line.Closed);
    return {};
  }
  t.resize(points.rows());
  for (Eigen::Index i = 0; i < t.size(); ++i)
  {
    const vtkIdType id = line.Ids[static_cast<std::size_t>(i)];
    t[i] = given->GetComponent(id, 0);
    if (!(t[i] >= 0 && t[i] <= 1))
    {
      return ipia::text(
        "The parameter of point ", id, " is ", t[i], "; parameters lie in [0, 1]. Scale them.");
    }
    if (i > 0 && t[i] < t[i - 1])
    {
      return ipia::text("The parameters of line ", k, " fall: ", t[i - 1], " at point ",
        line.Ids[static_cast<std::size_t>(i - 1)], ", then ", t[i], " at point ", id,
        ". Sort the points of the line by their parameters.");
    }
  }
  if (!(t[t.size() - 1] > t[0]))
  {
    return ipia::text(
      "All parameters of line ", k, " are ", t[0], "; they must rise along the line.");
  }
  return {};
}

std::string vtkFairingPIACurveFilter::Curves::readEarlierRound()
{
  vtkFieldData* field = this->Controls->GetFieldData();
  vtkDataArray *offsets = field->GetArray("KnotOffsets"), *closed = field->GetArray("Closed");
  const auto curves = static_cast<vtkIdType>(this->Rounds.size());
  if (!field->GetArray("Degree") || !field->GetArray("Knots") || !offsets || !closed)
  {
    return "The control points on port 1 lack the field data Degree, Closed, Knots and "
           "KnotOffsets. "
           "Connect output 1 of an earlier round.";
  }
  if (offsets->GetNumberOfTuples() != curves + 1 || closed->GetNumberOfTuples() != curves)
  {
    return ipia::text("The control points on port 1 are those of ", closed->GetNumberOfTuples(),
      " curves, the input has ", curves, " lines. Connect output 1 of a round on the same lines.");
  }
  std::vector<bool> periodic;
  for (vtkIdType k = 0; k < curves; ++k)
  {
    periodic.push_back(ipia::fieldNumber(field, "Closed", k) == 1);
    if (periodic.back() != this->Lines[static_cast<std::size_t>(k)].Closed)
    {
      return ipia::text("Curve ", k, " on port 1 is ", periodic.back() ? "closed" : "open",
        ", line ", k, " is not. Set Closure as in the earlier round.");
    }
  }
  ipia::EarlierKnots knots;
  std::string refusal = knots.read(
    field, this->Rounds.size(), periodic,
    [](std::size_t k) { return "curve " + std::to_string(k); }, this->Filter->DerivativeOrder);
  if (!refusal.empty())
  {
    return refusal;
  }
  vtkIdType total = 0;
  for (std::size_t k = 0; k < this->Rounds.size(); ++k)
  {
    ipia::BSplineBasis& basis = this->Rounds[k].Spline.Axes[0];
    basis = periodic[k] ? ipia::BSplineBasis::periodic(knots.Degree, knots.Interior[k])
                        : ipia::BSplineBasis::clamped(knots.Degree, knots.Interior[k]);
    total += basis.size();
  }
  ipia::EarlierControls controls;
  refusal = controls.read(this->Filter, this->Controls, total);
  vtkIdType first = 0;
  for (std::size_t k = 0; refusal.empty() && k < this->Rounds.size(); ++k)
  {
    refusal = controls.give(first, " of curve " + std::to_string(k), this->Rounds[k]);
    first += this->Rounds[k].Spline.size();
  }
  return refusal;
}

std::string vtkFairingPIACurveFilter::Curves::start(
  std::size_t k, const ipia::FairingParameters& parameters)
{
  const Line& line = this->Lines[k];
  ipia::FairingRound& round = this->Rounds[k];
  const auto m = static_cast<std::int64_t>(line.Ids.size());
  const std::int64_t least = parameters.Degree + 1;
  const std::int64_t n = this->Filter->NumberOfControlPoints > 0
    ? this->Filter->NumberOfControlPoints
    : std::max(least, (m + 2) / 3);
  if (n < least || n > m)
  {
    return ipia::text("NumberOfControlPoints is ", n, "; line ", k, " with ", m,
      " points and degree ", parameters.Degree, " can have ", least, " to ", m, ".");
  }
  round.Spline.Axes[0] =
    ipia::averagedKnots(round.Data.Parameters[0], parameters.Degree, n, line.Closed);
  const double excess = ipia::excessKnot(round.Spline.Axes[0].interiorKnots(), parameters.Degree);
  if (excess >= 0)
  {
    return ipia::text("Line ", k, " has so many points of parameter ", excess,
      " that more than Degree knots coincide there. Leave some out, or set fewer control points.");
  }
  round.startFromGrid();
  return {};
}

std::string vtkFairingPIACurveFilter::Curves::read(const ipia::FairingParameters& parameters)
{
  if (!this->Input || this->Input->GetNumberOfPoints() == 0)
  {
    return "The input has 0 points. Give a vtkPolyData with points and lines.";
  }
  std::string refusal = this->readLines();
  if (!refusal.empty())
  {
    return refusal;
  }
  vtkDataArray* given = nullptr;
  if (this->Filter->Parametrization == Given)
  {
    refusal = ipia::chooseArray(this->Filter, 3, this->Input, 1, "parameters", given);
    if (refusal.empty() && !given)
    {
      refusal =
        "Parametrization is Given, but there is no array of parameters. Choose a point array of "
        "one component with SetInputArrayToProcess(3, 0, ...).";
    }
  }
  vtkDataArray* weights = nullptr;
  refusal = refusal.empty()
    ? ipia::chooseArray(this->Filter, 0, this->Input, 1, "fairing weights", weights)
    : refusal;
  if (refusal.empty() && weights)
  {
    refusal = ipia::checkWeights(ipia::toVector(weights), ipia::nameOf(weights));
  }
  if (!refusal.empty())
  {
    return refusal;
  }
  this->Rounds.resize(this->Lines.size());
  for (std::size_t k = 0; k < this->Lines.size(); ++k)
  {
    const Line& line = this->Lines[k];
    const auto least = static_cast<std::size_t>(parameters.Degree + 1);
    if (line.Ids.size() < least)
    {
      return ipia::text("Line ", k, " has ", line.Ids.size(),
        " different points; a curve of degree ", parameters.Degree, " needs ", least,
        " at least. Give more points or set a lower Degree.");
    }
    refusal = this->readPoints(k);
    refusal = refusal.empty() ? this->readParameters(k, given) : refusal;
    if (!refusal.empty())
    {
      return refusal;
    }
    if (weights)
    {
      this->Rounds[k].DataWeights.resize(static_cast<Eigen::Index>(line.Ids.size()));
      for (std::size_t i = 0; i < line.Ids.size(); ++i)
      {
        this->Rounds[k].DataWeights[static_cast<Eigen::Index>(i)] =
          weights->GetComponent(line.Ids[i], 0);
      }
    }
    this->Rounds[k].InsertedKnots[0] = this->Filter->InsertedKnots;
  }
  if (this->Controls)
  {
    return this->readEarlierRound();
  }
  for (std::size_t k = 0; k < this->Lines.size(); ++k)
  {
    refusal = this->start(k, parameters);
    if (!refusal.empty())
    {
      return refusal;
    }
  }
  return {};
}
