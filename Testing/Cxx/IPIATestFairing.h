// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the tests of the fairing filters share: lines and grids as input, and looking at outputs.
 */
#ifndef IPIATestFairing_h
#define IPIATestFairing_h

#include "IPIATestUtilities.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFairingPIACurveFilter.h"
#include "vtkFairingPIASurfaceFilter.h"
#include "vtkFloatArray.h"
#include "vtkMath.h"
#include "vtkStructuredGrid.h"

#include <array>
#include <functional>
#include <random>

namespace ipiatest
{
using Vector3 = std::array<double, 3>;

/// Normally distributed numbers that are the same on every platform.
class Noise
{
public:
  explicit Noise(double deviation, unsigned seed = 1)
    : Deviation(deviation)
    , Engine(seed)
  {
  }

  double operator()()
  {
    // Box and Muller.
    const double a = (static_cast<double>(this->Engine()) + 1) / 4294967296.0;
    const double b = static_cast<double>(this->Engine()) / 4294967296.0;
    return this->Deviation * std::sqrt(-2 * std::log(a)) * std::cos(2 * vtkMath::Pi() * b);
  }

private:
  double Deviation;
  std::mt19937 Engine;
};

/// One polyline; closed ones come back to their first point.
inline vtkSmartPointer<vtkPolyData> ToLine(
  const std::vector<Vector3>& positions, bool closed = false)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(static_cast<int>(positions.size() + (closed ? 1 : 0)));
  for (const Vector3& x : positions)
  {
    lines->InsertCellPoint(points->InsertNextPoint(x.data()));
  }
  if (closed)
  {
    lines->InsertCellPoint(0);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  return data;
}

/// Points of a curve at equal steps from 0 to 1; of a closed one without the last.
inline std::vector<Vector3> CurvePoints(
  int count, bool closed, const std::function<Vector3(double)>& curve)
{
  std::vector<Vector3> points;
  for (int k = 0; k < count; ++k)
  {
    points.push_back(curve(static_cast<double>(k) / (closed ? count : count - 1)));
  }
  return points;
}

/// The starfish r = 1 + 0.35 cos(5 angle) with noise.
inline std::vector<Vector3> StarfishPoints(int count, double noise)
{
  Noise random(noise);
  return CurvePoints(count, true,
    [&](double t)
    {
      const double angle = 2 * vtkMath::Pi() * t, r = 1 + 0.35 * std::cos(5 * angle);
      const double x = r * std::cos(angle) + random(), y = r * std::sin(angle) + random();
      return Vector3{ x, y, 0 };
    });
}

/// A wave in space, from one end to the other.
inline std::vector<Vector3> WavePoints(int count)
{
  return CurvePoints(count, false,
    [](double t) {
      return Vector3{ 3 * t, std::sin(6 * t), 0.5 * std::cos(9 * t) };
    });
}

/// m x n x 1 points of a surface at equal steps of u and v from 0 to 1.
inline vtkSmartPointer<vtkStructuredGrid> ToGrid(
  int m, int n, const std::function<Vector3(double, double)>& surface)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      points->InsertNextPoint(
        surface(static_cast<double>(i) / (m - 1), static_cast<double>(j) / (n - 1)).data());
    }
  }
  auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
  grid->SetDimensions(m, n, 1);
  grid->SetPoints(points);
  return grid;
}

/// A height field with noise.
inline vtkSmartPointer<vtkStructuredGrid> WavyGrid(int m, int n, double noise = 0)
{
  Noise random(noise);
  return ToGrid(m, n,
    [&](double u, double v) {
      return Vector3{ 2 * u, v, 0.2 * std::sin(5 * u) * std::cos(4 * v) + random() };
    });
}

/// Adds an array of one value per point.
inline void AddArray(
  vtkDataSet* data, const char* name, const std::function<double(vtkIdType)>& value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  for (vtkIdType k = 0; k < data->GetNumberOfPoints(); ++k)
  {
    array->InsertNextValue(value(k));
  }
  data->GetPointData()->AddArray(array);
}

/// Chooses a point array.
inline void Choose(vtkAlgorithm* filter, int index, int port, const char* name)
{
  filter->SetInputArrayToProcess(index, port, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
}

inline vtkPolyData* Output(vtkAlgorithm* filter, int port)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(port));
}

inline vtkDataArray* PointArray(vtkAlgorithm* filter, int port, const char* name)
{
  return Output(filter, port)->GetPointData()->GetArray(name);
}

/// One of the filters, set to iterate as long as it takes to be exact.
template <typename Class>
vtkSmartPointer<Class> NewExactFilter(vtkDataObject* data)
{
  auto filter = vtkSmartPointer<Class>::New();
  filter->SetInputDataObject(data);
  filter->SetTolerance(1e-9);
  filter->SetMaximumNumberOfIterations(100000);
  return filter;
}

inline bool AllOutputsAreEmpty(vtkAlgorithm* filter)
{
  return IsEmpty(Output(filter, 0)) && IsEmpty(Output(filter, 1)) && IsEmpty(Output(filter, 2));
}

/// Every number of every output.
inline bool AllOutputsAreFinite(vtkAlgorithm* filter)
{
  for (int port = 0; port < 3; ++port)
  {
    vtkPolyData* data = Output(filter, port);
    if (data->GetNumberOfPoints() == 0 || !IsFinite(data->GetPoints()->GetData()) ||
      !IsFinite(data->GetPointData()) || !IsFinite(data->GetFieldData()))
    {
      return false;
    }
  }
  return true;
}

/// Points, point arrays and field data of all outputs, bit for bit.
inline bool SameBits(vtkAlgorithm* a, vtkAlgorithm* b)
{
  for (int port = 0; port < 3; ++port)
  {
    vtkPolyData *x = Output(a, port), *y = Output(b, port);
    if (!SameArray(x->GetPoints()->GetData(), y->GetPoints()->GetData()) ||
      x->GetPointData()->GetNumberOfArrays() != y->GetPointData()->GetNumberOfArrays() ||
      x->GetFieldData()->GetNumberOfArrays() != y->GetFieldData()->GetNumberOfArrays())
    {
      return false;
    }
    for (vtkFieldData* field : { static_cast<vtkFieldData*>(x->GetPointData()), x->GetFieldData() })
    {
      vtkFieldData* other = field == x->GetPointData()
        ? static_cast<vtkFieldData*>(y->GetPointData())
        : y->GetFieldData();
      for (int k = 0; k < field->GetNumberOfArrays(); ++k)
      {
        if (!SameArray(field->GetArray(k), other->GetArray(field->GetArrayName(k))))
        {
          return false;
        }
      }
    }
  }
  return true;
}

/// The largest distance of points with the same number.
inline double LargestDistance(vtkPolyData* a, vtkPolyData* b)
{
  return LargestDifference(a->GetPoints()->GetData(), b->GetPoints()->GetData());
}
}

#endif
