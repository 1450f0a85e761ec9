// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFairingPIACurveFilter.h"

#include "IPIAFairingCurves.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkFairingPIACurveFilter);

namespace
{
/// Share of the progress that the iterations take; sampling has the rest.
constexpr double ProgressOfFit = 0.9;

constexpr int SamplesPerSpan = 10;

/// Of the points, cells and arrays of output 0.
constexpr double BytesPerSample = 120;
}

std::string vtkFairingPIACurveFilter::Curves::run(const ipia::FairingParameters& parameters)
{
  const auto lines = static_cast<double>(this->Lines.size());
  for (std::size_t k = 0; k < this->Rounds.size(); ++k)
  {
    const auto done = static_cast<double>(k);
    const std::string refusal = this->Rounds[k].run(parameters,
      [&](double share) { return !this->Filter->Report(ProgressOfFit * (done + share) / lines); });
    if (!refusal.empty() || this->Filter->Aborted)
    {
      return refusal;
    }
  }
  return {};
}

vtkIdType vtkFairingPIACurveFilter::Curves::sampleCount(const ipia::FairingRound& round) const
{
  const int asked = this->Filter->SampleDimensions;
  return asked > 0
    ? std::max(asked, 2)
    : SamplesPerSpan * static_cast<vtkIdType>(round.Spline.Axes[0].spans().size()) + 1;
}

std::string vtkFairingPIACurveFilter::Curves::checkMemory(
  const ipia::FairingParameters& parameters) const
{
  double samples = 0;
  for (const ipia::FairingRound& round : this->Rounds)
  {
    samples += static_cast<double>(this->sampleCount(round));
  }
  return ipia::checkMemory(this->Rounds, parameters, samples, BytesPerSample, this->Input);
}

void vtkFairingPIACurveFilter::Curves::writeData(vtkPolyData* output) const
{
  vtkIdType total = 0;
  for (const Line& line : this->Lines)
  {
    total += static_cast<vtkIdType>(line.Ids.size());
  }
  vtkNew<vtkPoints> points;
  points->SetDataType(this->Input->GetPoints()->GetDataType());
  points->SetNumberOfPoints(total);
  output->SetPoints(points);
  vtkPointData* from = this->Input->GetPointData();
  output->GetPointData()->CopyAllOn();
  output->GetPointData()->CopyAllocate(from, total);
  vtkNew<vtkCellArray> cells;
  std::vector<double> parameters, errors;
  vtkIdType next = 0;
  for (std::size_t k = 0; k < this->Lines.size(); ++k)
  {
    const Line& line = this->Lines[k];
    const vtkIdType first = next;
    cells->InsertNextCell(static_cast<int>(line.Ids.size() + (line.Closed ? 1 : 0)));
    for (std::size_t i = 0; i < line.Ids.size(); ++i)
    {
      points->SetPoint(next, this->Input->GetPoint(line.Ids[i]));
      output->GetPointData()->CopyData(from, line.Ids[i], next);
      parameters.push_back(this->Rounds[k].Data.Parameters[0][static_cast<Eigen::Index>(i)]);
      errors.push_back(this->Rounds[k].Residuals.row(static_cast<Eigen::Index>(i)).norm());
      cells->InsertCellPoint(next++);
    }
    if (line.Closed)
    {
      cells->InsertCellPoint(first);
    }
  }
  output->SetLines(cells);
  std::copy(parameters.begin(), parameters.end(),
    ipia::addPointArray(output, "Parameter", 1)->GetPointer(0));
  std::copy(
    errors.begin(), errors.end(), ipia::addPointArray(output, "FitError", 1)->GetPointer(0));
}

void vtkFairingPIACurveFilter::Curves::writeControls(vtkPolyData* output) const
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  std::vector<double> weights, knots;
  std::vector<std::int64_t> offsets = { 0 };
  vtkNew<vtkIntArray> closed, degree;
  closed->SetName("Closed");
  degree->SetName("Degree");
  degree->InsertNextValue(this->Rounds.front().Spline.Axes[0].degree());
  for (const ipia::FairingRound& round : this->Rounds)
  {
    const ipia::BSplineBasis& basis = round.Spline.Axes[0];
    const vtkIdType first = points->GetNumberOfPoints();
    cells->InsertNextCell(static_cast<int>(basis.size() + (basis.isPeriodic() ? 1 : 0)));
    for (std::int64_t j = 0; j < basis.size(); ++j)
    {
      const Eigen::RowVector3d x = round.Spline.ControlPoints.row(j) + round.Centre;
      cells->InsertCellPoint(points->InsertNextPoint(x.data()));
      weights.push_back(round.Weights[j]);
    }
    if (basis.isPeriodic())
    {
      cells->InsertCellPoint(first);
    }
    knots.insert(knots.end(), basis.knots().begin(), basis.knots().end());
    offsets.push_back(static_cast<std::int64_t>(knots.size()));
    closed->InsertNextValue(basis.isPeriodic());
  }
  output->SetPoints(points);
  output->SetLines(cells);
  std::copy(
    weights.begin(), weights.end(), ipia::addPointArray(output, "FairingWeight", 1)->GetPointer(0));
  output->GetFieldData()->AddArray(degree);
  output->GetFieldData()->AddArray(closed);
  ipia::addFieldArray(output->GetFieldData(), "Knots", knots);
  ipia::addFieldArray(output->GetFieldData(), "KnotOffsets", offsets);
}

void vtkFairingPIACurveFilter::Curves::writeSamples(vtkPolyData* output, vtkPolyData* data) const
{
  std::vector<vtkIdType> begin = { 0 };
  vtkNew<vtkCellArray> cells;
  for (const ipia::FairingRound& round : this->Rounds)
  {
    const vtkIdType count = this->sampleCount(round);
    cells->InsertNextCell(static_cast<int>(count));
    for (vtkIdType i = 0; i < count; ++i)
    {
      cells->InsertCellPoint(begin.back() + i);
    }
    begin.push_back(begin.back() + count);
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(begin.back());
  output->SetPoints(points);
  output->SetLines(cells);
  vtkPointData* to = output->GetPointData();
  vtkNew<vtkPointData> from; // what is interpolated
  from->ShallowCopy(data->GetPointData());
  from->RemoveArray("Parameter");
  to->InterpolateAllocate(from, begin.back());

  vtkIdType firstOfData = 0;
  for (std::size_t k = 0; k < this->Rounds.size(); ++k)
  {
    const ipia::Vector& t = this->Rounds[k].Data.Parameters[0];
    const vtkIdType m = t.size();
    for (vtkIdType i = begin[k]; i < begin[k + 1]; ++i)
    {
      const double u =
        static_cast<double>(i - begin[k]) / static_cast<double>(begin[k + 1] - begin[k] - 1);
      vtkIdType above = std::upper_bound(t.begin(), t.end(), u) - t.begin();
      vtkIdType below = above - 1;
      double low = below >= 0 ? t[below] : 0, high = above < m ? t[above] : 1;
      if (this->Lines[k].Closed)
      {
        low = below >= 0 ? low : t[m - 1] - 1;
        high = above < m ? high : t[0] + 1;
        below = below >= 0 ? below : m - 1;
        above = above < m ? above : 0;
      }
      else
      {
        below = std::max<vtkIdType>(below, 0);
        above = std::min(above, m - 1);
      }
      const double share = high > low ? (u - low) / (high - low) : 0.0;
      to->InterpolateEdge(from, i, firstOfData + below, firstOfData + above, share);
    }
    firstOfData += m;
  }
  double* parameter = ipia::addPointArray(output, "Parameter", 1)->GetPointer(0);
  double* curvature = ipia::addPointArray(output, "Curvature", 1)->GetPointer(0);
  double* torsion = ipia::addPointArray(output, "Torsion", 1)->GetPointer(0);
  double* normal = ipia::addPointArray(output, "CurvatureNormal", 3)->GetPointer(0);
  for (std::size_t k = 0; k < this->Rounds.size(); ++k)
  {
    const ipia::FairingRound& round = this->Rounds[k];
    vtkSMPTools::For(begin[k], begin[k + 1],
      [&](vtkIdType from0, vtkIdType to0)
      {
        for (vtkIdType i = from0; i < to0; ++i)
        {
          const double u =
            static_cast<double>(i - begin[k]) / static_cast<double>(begin[k + 1] - begin[k] - 1);
          const ipia::CurvePoint point = ipia::curvePoint(round.Spline, u);
          const Eigen::Vector3d x = point.Position + round.Centre.transpose();
          points->SetPoint(i, x.data());
          parameter[i] = u;
          curvature[i] = point.Curvature;
          torsion[i] = point.Torsion;
          std::copy_n(point.CurvatureNormal.data(), 3, normal + 3 * i);
        }
      });
  }
}

vtkFairingPIACurveFilter::vtkFairingPIACurveFilter()
  : NumberOfControlPoints(0)
  , SampleDimensions(0)
  , Closure(AutomaticClosure)
{
}

vtkFairingPIACurveFilter::~vtkFairingPIACurveFilter() = default;

void vtkFairingPIACurveFilter::InsertKnot(double knot)
{
  this->InsertedKnots.push_back(knot);
  this->Modified();
}

void vtkFairingPIACurveFilter::ClearInsertedKnots()
{
  if (!this->InsertedKnots.empty())
  {
    this->InsertedKnots.clear();
    this->Modified();
  }
}

int vtkFairingPIACurveFilter::GetNumberOfInsertedKnots()
{
  return static_cast<int>(this->InsertedKnots.size());
}

double vtkFairingPIACurveFilter::GetInsertedKnot(int i)
{
  return i >= 0 && i < this->GetNumberOfInsertedKnots()
    ? this->InsertedKnots[static_cast<std::size_t>(i)]
    : 0.0;
}

std::string vtkFairingPIACurveFilter::Fair(vtkInformationVector** input,
  vtkInformationVector* output, const ipia::FairingParameters& parameters)
{
  Curves curves(this, vtkPolyData::GetData(input[0]), vtkPolyData::GetData(input[1]));
  std::string refusal = curves.read(parameters);
  refusal = refusal.empty() ? curves.checkMemory(parameters) : refusal;
  refusal = refusal.empty() ? curves.run(parameters) : refusal;
  if (!refusal.empty() || this->Aborted)
  {
    return refusal;
  }
  vtkPolyData* data = vtkPolyData::GetData(output, 2);
  curves.writeData(data);
  curves.writeControls(vtkPolyData::GetData(output, 1));
  curves.writeSamples(vtkPolyData::GetData(output, 0), data);
  ipia::addHistories(vtkPolyData::GetData(output, 0)->GetFieldData(), curves.Rounds);
  this->SetResults(curves.Rounds);
  return {};
}

void vtkFairingPIACurveFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfControlPoints: " << this->NumberOfControlPoints << "\n";
  os << indent << "SampleDimensions: " << this->SampleDimensions << "\n";
  os << indent << "Closure: " << this->Closure << "\n";
  os << indent << "InsertedKnots: " << this->InsertedKnots.size() << "\n";
}
