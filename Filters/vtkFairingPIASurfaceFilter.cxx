// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFairingPIASurfaceFilter.h"

#include "Core/Parametrization.h"
#include "IPIAFairingRound.h"
#include "IPIAText.h"

#include "vtkCellArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkStaticPointLocator2D.h"
#include "vtkStructuredGrid.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkFairingPIASurfaceFilter);

namespace
{
/// Share of the progress that the iterations take; sampling has the rest.
constexpr double ProgressOfFit = 0.9;

constexpr int SamplesPerSpan = 4;

vtkDoubleArray* addPointArray(vtkPolyData* data, const char* name, int components)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(data->GetNumberOfPoints());
  data->GetPointData()->AddArray(array);
  return array;
}

constexpr const char* AxisNames[] = { "u", "v" };
}

/// The points of the input and the surface through them.
class vtkFairingPIASurfaceFilter::Surface
{
public:
  Surface(vtkFairingPIASurfaceFilter* filter, vtkPointSet* input, vtkPolyData* controls)
    : Filter(filter)
    , Input(input)
    , Controls(controls)
    , Rounds(1)
  {
  }

  std::string read(const ipia::FairingParameters& parameters);
  std::string run(const ipia::FairingParameters& parameters);
  void writeData(vtkPolyData* output);
  void writeControls(vtkPolyData* output) const;
  void writeSamples(vtkPolyData* output, vtkPolyData* data) const;

  const std::vector<ipia::FairingRound>& rounds() const { return this->Rounds; }

private:
  ipia::FairingRound& round() { return this->Rounds.front(); }
  const ipia::FairingRound& round() const { return this->Rounds.front(); }

  std::string readGridSize();
  std::string readPoints();
  std::string readGivenParameters();
  std::string readGridParameters();
  std::string readEarlierRound();
  std::string start(int degree);
  void interpolateArrays(vtkPolyData* output, vtkPolyData* data, const std::vector<double>& u,
    const std::vector<double>& v) const;

  vtkFairingPIASurfaceFilter* Filter;
  vtkPointSet* Input;
  vtkPolyData* Controls;
  std::vector<ipia::FairingRound> Rounds; ///< one
};

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
  return {};
}

std::string vtkFairingPIASurfaceFilter::Surface::readGivenParameters()
{
  vtkDataArray* given = this->Filter->GetInputArrayToProcess(3, this->Input);
  if (!given || given->GetNumberOfComponents() != 2)
  {
    return ipia::text("Parametrization is Given, but ",
      given ? "the array of parameters has " + std::to_string(given->GetNumberOfComponents()) +
          " component(s)."
            : std::string("there is no array of parameters."),
      " Choose a point array of two components with SetInputArrayToProcess(3, 0, ...).");
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
    round.Spline.Axes[axis] = gridded
      ? ipia::averagedKnots(round.Data.Parameters[axis], degree, n, false)
      : ipia::uniformKnots(degree, n, false);
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
  const auto field = [&](const char* name)
  { return this->Controls->GetFieldData()->GetArray(name); };
  vtkDataArray *degree = field("Degree"), *knots = field("Knots"), *offsets = field("KnotOffsets");
  if (!degree || !knots || !offsets || degree->GetNumberOfTuples() != 1 ||
    offsets->GetNumberOfTuples() != 3)
  {
    return "The control points on port 1 lack the field data Degree, Knots and KnotOffsets of a "
           "surface. Connect output 1 of an earlier round.";
  }
  const int p = static_cast<int>(degree->GetComponent(0, 0));
  if (p < 1 || p > ipia::BSplineBasis::MaximumDegree || this->Filter->DerivativeOrder > p)
  {
    return ipia::text("The Degree of the control points on port 1 is ", p,
      "; 1 to 5 are possible, and "
      "DerivativeOrder (",
      this->Filter->DerivativeOrder, ") must not be higher.");
  }
  ipia::FairingRound& round = this->round();
  for (const int axis : { 0, 1 })
  {
    const auto begin = static_cast<vtkIdType>(offsets->GetComponent(axis, 0));
    const auto end = static_cast<vtkIdType>(offsets->GetComponent(axis + 1, 0));
    std::vector<double> interior;
    for (vtkIdType i = begin + p + 1; i < std::min(end, knots->GetNumberOfTuples()) - p - 1; ++i)
    {
      interior.push_back(knots->GetComponent(i, 0));
    }
    if (begin < 0 || end > knots->GetNumberOfTuples() || end - begin < 2 * p + 2 ||
      !std::is_sorted(interior.begin(), interior.end()) || ipia::excessKnot(interior, p) >= 0)
    {
      return ipia::text("The knots along ", AxisNames[axis], " on port 1 are not those of degree ",
        p,
        ": between 0 and 1 they must rise, none more than Degree times. Connect output 1 of an "
        "earlier round.");
    }
    round.Spline.Axes[static_cast<std::size_t>(axis)] = ipia::BSplineBasis::clamped(p, interior);
  }
  const std::int64_t n = round.Spline.size();
  if (this->Controls->GetNumberOfPoints() != n)
  {
    return ipia::text("The knots on port 1 ask for ", n, " control points, ",
      this->Controls->GetNumberOfPoints(), " are there. Connect output 1 of an earlier round.");
  }
  vtkDataArray* weights = this->Filter->GetInputArrayToProcess(1, this->Controls);
  vtkDataArray* movable = this->Filter->GetInputArrayToProcess(2, this->Controls);
  round.Spline.ControlPoints.resize(n, 3);
  for (std::int64_t j = 0; j < n; ++j)
  {
    double x[3];
    this->Controls->GetPoint(j, x);
    for (int c = 0; c < 3; ++c)
    {
      round.Spline.ControlPoints(j, c) = x[c] - round.Centre[c];
    }
  }
  if (!round.Spline.ControlPoints.allFinite())
  {
    return "A control point on port 1 is not finite. Remove the cause, or begin without port 1.";
  }
  round.ControlWeights = weights ? ipia::toVector(weights) : ipia::Vector();
  round.Movable = movable ? ipia::toVector(movable) : ipia::Vector();
  return ipia::checkWeights(round.ControlWeights, "FairingWeight");
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
  std::string refusal = given ? std::string() : this->readGridSize();
  refusal = refusal.empty() ? this->readPoints() : refusal;
  if (refusal.empty())
  {
    refusal = given ? this->readGivenParameters() : this->readGridParameters();
  }
  vtkDataArray* weights = this->Filter->GetInputArrayToProcess(0, this->Input);
  if (refusal.empty() && weights)
  {
    if (weights->GetNumberOfComponents() != 1)
    {
      return ipia::text("The fairing weights have ", weights->GetNumberOfComponents(),
        " components. Choose a point array of one component with SetInputArrayToProcess(0, 0, "
        "...).");
    }
    this->round().DataWeights = ipia::toVector(weights);
    refusal =
      ipia::checkWeights(this->round().DataWeights, weights->GetName() ? weights->GetName() : "");
  }
  if (!refusal.empty())
  {
    return refusal;
  }
  for (const std::size_t axis : { 0u, 1u })
  {
    this->round().InsertedKnots[axis] = this->Filter->InsertedKnots[axis];
  }
  return this->Controls && this->Controls->GetNumberOfPoints() > 0 ? this->readEarlierRound()
                                                                   : this->start(parameters.Degree);
}

std::string vtkFairingPIASurfaceFilter::Surface::run(const ipia::FairingParameters& parameters)
{
  return this->round().run(
    parameters, [&](double share) { return !this->Filter->Report(ProgressOfFit * share); });
}

void vtkFairingPIASurfaceFilter::Surface::writeData(vtkPolyData* output)
{
  const ipia::FairingRound& round = this->round();
  output->SetPoints(this->Input->GetPoints());
  output->GetPointData()->ShallowCopy(this->Input->GetPointData());
  double* parameters = addPointArray(output, "Parameter", 2)->GetPointer(0);
  double* errors = addPointArray(output, "FitError", 1)->GetPointer(0);
  const auto& t = round.Data.Parameters;
  for (Eigen::Index k = 0; k < round.Residuals.rows(); ++k)
  {
    parameters[2 * k] = t[0][round.Data.Gridded ? k % round.GridSize[0] : k];
    parameters[2 * k + 1] = t[1][round.Data.Gridded ? k / round.GridSize[0] : k];
    errors[k] = round.Residuals.row(k).norm();
  }
}

void vtkFairingPIASurfaceFilter::Surface::writeControls(vtkPolyData* output) const
{
  const ipia::FairingRound& round = this->round();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (std::int64_t j = 0; j < round.Spline.size(); ++j)
  {
    const Eigen::RowVector3d x = round.Spline.ControlPoints.row(j) + round.Centre;
    points->InsertNextPoint(x.data());
  }
  const std::int64_t n[2] = { round.Spline.Axes[0].size(), round.Spline.Axes[1].size() };
  vtkNew<vtkCellArray> net;
  for (const int axis : { 0, 1 })
  {
    for (std::int64_t l = 0; l < n[1 - axis]; ++l)
    {
      net->InsertNextCell(static_cast<int>(n[axis]));
      for (std::int64_t j = 0; j < n[axis]; ++j)
      {
        net->InsertCellPoint(axis == 0 ? j + n[0] * l : l + n[0] * j);
      }
    }
  }
  output->SetPoints(points);
  output->SetLines(net);
  std::copy(round.Weights.begin(), round.Weights.end(),
    addPointArray(output, "FairingWeight", 1)->GetPointer(0));
  vtkNew<vtkIntArray> degree;
  degree->SetName("Degree");
  degree->InsertNextValue(round.Spline.Axes[0].degree());
  vtkFieldData* field = output->GetFieldData();
  field->AddArray(degree);
  std::vector<double> knots = round.Spline.Axes[0].knots();
  const auto first = static_cast<std::int64_t>(knots.size());
  knots.insert(
    knots.end(), round.Spline.Axes[1].knots().begin(), round.Spline.Axes[1].knots().end());
  ipia::addFieldArray(field, "NumberOfControlPoints", std::vector<std::int64_t>{ n[0], n[1] });
  ipia::addFieldArray(field, "Knots", knots);
  ipia::addFieldArray(field, "KnotOffsets",
    std::vector<std::int64_t>{ 0, first, static_cast<std::int64_t>(knots.size()) });
}

void vtkFairingPIASurfaceFilter::Surface::interpolateArrays(vtkPolyData* output, vtkPolyData* data,
  const std::vector<double>& u, const std::vector<double>& v) const
{
  const ipia::FairingRound& round = this->round();
  vtkNew<vtkPointData> from;
  from->ShallowCopy(data->GetPointData());
  from->RemoveArray("Parameter");
  // The normals and texture coordinates of the data are not those of the surface.
  from->SetActiveNormals(nullptr);
  vtkPointData* to = output->GetPointData();
  const auto columns = static_cast<vtkIdType>(u.size()), rows = static_cast<vtkIdType>(v.size());
  if (!round.Data.Gridded)
  {
    vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
    places->SetNumberOfPoints(data->GetNumberOfPoints());
    for (vtkIdType k = 0; k < data->GetNumberOfPoints(); ++k)
    {
      places->SetPoint(k, round.Data.Parameters[0][k], round.Data.Parameters[1][k], 0);
    }
    vtkNew<vtkPolyData> plane;
    plane->SetPoints(places);
    vtkNew<vtkStaticPointLocator2D> locator;
    locator->SetDataSet(plane);
    locator->BuildLocator();
    to->CopyAllocate(from, columns * rows);
    for (vtkIdType k = 0; k < columns * rows; ++k)
    {
      const double x[3] = { u[static_cast<std::size_t>(k % columns)],
        v[static_cast<std::size_t>(k / columns)], 0 };
      to->CopyData(from, locator->FindClosestPoint(x), k);
    }
    return;
  }
  to->InterpolateAllocate(from, columns * rows);
  const auto locate = [](const ipia::Vector& t, double x, double& share)
  {
    const Eigen::Index above = std::clamp<Eigen::Index>(
      std::upper_bound(t.begin(), t.end(), x) - t.begin(), 1, t.size() - 1);
    const double step = t[above] - t[above - 1];
    share = step > 0 ? (x - t[above - 1]) / step : 0.0;
    return above - 1;
  };
  vtkNew<vtkIdList> corners;
  corners->SetNumberOfIds(4);
  for (vtkIdType k = 0; k < columns * rows; ++k)
  {
    double s = 0, t = 0;
    const Eigen::Index i =
      locate(round.Data.Parameters[0], u[static_cast<std::size_t>(k % columns)], s);
    const Eigen::Index j =
      locate(round.Data.Parameters[1], v[static_cast<std::size_t>(k / columns)], t);
    const vtkIdType corner = i + round.GridSize[0] * j;
    corners->SetId(0, corner);
    corners->SetId(1, corner + 1);
    corners->SetId(2, corner + round.GridSize[0]);
    corners->SetId(3, corner + round.GridSize[0] + 1);
    double shares[4] = { (1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t };
    to->InterpolatePoint(from, k, corners, shares);
  }
}

void vtkFairingPIASurfaceFilter::Surface::writeSamples(vtkPolyData* output, vtkPolyData* data) const
{
  const ipia::FairingRound& round = this->round();
  std::vector<double> parameters[2];
  for (const std::size_t axis : { 0u, 1u })
  {
    const int asked = this->Filter->SampleDimensions[axis];
    const auto count = asked > 0 ? std::max<std::size_t>(static_cast<std::size_t>(asked), 2)
                                 : SamplesPerSpan * round.Spline.Axes[axis].spans().size() + 1;
    for (std::size_t k = 0; k < count; ++k)
    {
      parameters[axis].push_back(static_cast<double>(k) / static_cast<double>(count - 1));
    }
  }
  const auto columns = static_cast<vtkIdType>(parameters[0].size());
  const auto rows = static_cast<vtkIdType>(parameters[1].size());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(columns * rows);
  output->SetPoints(points);
  this->interpolateArrays(output, data, parameters[0], parameters[1]);

  vtkNew<vtkCellArray> cells;
  for (vtkIdType j = 0; j + 1 < rows; ++j)
  {
    for (vtkIdType i = 0; i + 1 < columns; ++i)
    {
      const vtkIdType corner = i + columns * j;
      cells->InsertNextCell({ corner, corner + 1, corner + columns + 1, corner + columns });
    }
  }
  output->SetPolys(cells);
  double* parameter = addPointArray(output, "Parameter", 2)->GetPointer(0);
  double* mean = addPointArray(output, "MeanCurvature", 1)->GetPointer(0);
  double* gauss = addPointArray(output, "GaussCurvature", 1)->GetPointer(0);
  double* normal = addPointArray(output, "Normals", 3)->GetPointer(0);
  output->GetPointData()->SetActiveNormals("Normals");
  vtkSMPTools::For(0, columns * rows,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType k = begin; k < end; ++k)
      {
        const double u = parameters[0][static_cast<std::size_t>(k % columns)];
        const double v = parameters[1][static_cast<std::size_t>(k / columns)];
        const ipia::SurfacePoint point = ipia::surfacePoint(round.Spline, u, v);
        const Eigen::Vector3d x = point.Position + round.Centre.transpose();
        points->SetPoint(k, x.data());
        parameter[2 * k] = u;
        parameter[2 * k + 1] = v;
        mean[k] = point.MeanCurvature;
        gauss[k] = point.GaussCurvature;
        std::copy_n(point.Normal.data(), 3, normal + 3 * k);
      }
    });
}

vtkFairingPIASurfaceFilter::vtkFairingPIASurfaceFilter()
  : NumberOfControlPoints{ 0, 0 }
  , SampleDimensions{ 0, 0 }
{
  this->SetInputArrayToProcess(
    3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::TCOORDS);
}

vtkFairingPIASurfaceFilter::~vtkFairingPIASurfaceFilter() = default;

int vtkFairingPIASurfaceFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  this->Superclass::FillInputPortInformation(port, info);
  if (port == 0)
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkStructuredGrid");
  }
  return 1;
}

void vtkFairingPIASurfaceFilter::InsertKnot(int axis, double knot)
{
  if (axis != 0 && axis != 1)
  {
    vtkErrorMacro("There is no axis " << axis << "; 0 is u and 1 is v.");
    return;
  }
  this->InsertedKnots[axis].push_back(knot);
  this->Modified();
}

void vtkFairingPIASurfaceFilter::ClearInsertedKnots()
{
  for (std::vector<double>& knots : this->InsertedKnots)
  {
    if (!knots.empty())
    {
      knots.clear();
      this->Modified();
    }
  }
}

std::string vtkFairingPIASurfaceFilter::Fair(vtkInformationVector** input,
  vtkInformationVector* output, const ipia::FairingParameters& parameters)
{
  Surface surface(this, vtkPointSet::GetData(input[0]), vtkPolyData::GetData(input[1]));
  std::string refusal = surface.read(parameters);
  refusal = refusal.empty() ? surface.run(parameters) : refusal;
  if (!refusal.empty() || this->Aborted)
  {
    return refusal;
  }
  vtkPolyData* data = vtkPolyData::GetData(output, 2);
  surface.writeData(data);
  surface.writeControls(vtkPolyData::GetData(output, 1));
  surface.writeSamples(vtkPolyData::GetData(output, 0), data);
  ipia::addHistories(vtkPolyData::GetData(output, 0)->GetFieldData(), surface.rounds());
  this->SetResults(surface.rounds());
  return {};
}

void vtkFairingPIASurfaceFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfControlPoints: " << this->NumberOfControlPoints[0] << " "
     << this->NumberOfControlPoints[1] << "\n";
  os << indent << "SampleDimensions: " << this->SampleDimensions[0] << " "
     << this->SampleDimensions[1] << "\n";
  os << indent << "InsertedKnots: " << this->InsertedKnots[0].size() << " "
     << this->InsertedKnots[1].size() << "\n";
}
