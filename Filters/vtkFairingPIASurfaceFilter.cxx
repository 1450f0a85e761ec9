// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFairingPIASurfaceFilter.h"

#include "IPIAFairingSurface.h"

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

/// Of the points, cells and arrays of output 0; cells grow by doubling.
constexpr double BytesPerSample = 250;
}

std::string vtkFairingPIASurfaceFilter::Surface::run(const ipia::FairingParameters& parameters)
{
  return this->round().run(
    parameters, [&](double share) { return !this->Filter->Report(ProgressOfFit * share); });
}

std::size_t vtkFairingPIASurfaceFilter::Surface::sampleCount(std::size_t axis) const
{
  const int asked = this->Filter->SampleDimensions[axis];
  return asked > 0 ? std::max<std::size_t>(static_cast<std::size_t>(asked), 2)
                   : SamplesPerSpan * this->round().Spline.Axes[axis].spans().size() + 1;
}

std::string vtkFairingPIASurfaceFilter::Surface::checkMemory(
  const ipia::FairingParameters& parameters) const
{
  const double samples =
    static_cast<double>(this->sampleCount(0)) * static_cast<double>(this->sampleCount(1));
  return ipia::checkMemory(this->Rounds, parameters, samples, BytesPerSample, this->Input);
}

void vtkFairingPIASurfaceFilter::Surface::writeData(vtkPolyData* output)
{
  const ipia::FairingRound& round = this->round();
  output->SetPoints(this->Input->GetPoints());
  output->GetPointData()->ShallowCopy(this->Input->GetPointData());
  double* parameters = ipia::addPointArray(output, "Parameter", 2)->GetPointer(0);
  double* errors = ipia::addPointArray(output, "FitError", 1)->GetPointer(0);
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
    ipia::addPointArray(output, "FairingWeight", 1)->GetPointer(0));
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
    const std::size_t count = this->sampleCount(axis);
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
  double* parameter = ipia::addPointArray(output, "Parameter", 2)->GetPointer(0);
  double* mean = ipia::addPointArray(output, "MeanCurvature", 1)->GetPointer(0);
  double* gauss = ipia::addPointArray(output, "GaussCurvature", 1)->GetPointer(0);
  double* normal = ipia::addPointArray(output, "Normals", 3)->GetPointer(0);
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
  refusal = refusal.empty() ? surface.checkMemory(parameters) : refusal;
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
