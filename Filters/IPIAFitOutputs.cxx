// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAFitOutputs.h"

#include "Core/Parallel.h"
#include "IPIAAttributes.h"
#include "vtkIPIAImplicitFunction.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace ipia
{
namespace
{
/// Samples one quantity of the fit into component c of an array over an extent.
template <int Dim, typename ArrayType>
bool sampleInto(ArrayType* array, int component, const ImplicitSpline<Dim>& function,
  const AxisPositions<Dim>& positions, int derivativeAxis, const ProgressCallback& progress)
{
  using Scalar = typename ArrayType::ValueType;
  const int components = array->GetNumberOfComponents();
  if (components == 1)
  {
    return function.sample(positions, array->GetPointer(0), 0, derivativeAxis, progress);
  }
  std::vector<Scalar> plane(static_cast<std::size_t>(array->GetNumberOfTuples()));
  const bool done = function.sample(positions, plane.data(), 0, derivativeAxis, progress);
  Scalar* values = array->GetPointer(0);
  for (std::size_t i = 0; i < plane.size(); ++i)
  {
    values[i * static_cast<std::size_t>(components) + static_cast<std::size_t>(component)] =
      plane[i];
  }
  return done;
}

template <int Dim, typename ArrayType>
bool sampleAs(const FitProblem& problem, const FitSolution<Dim>& fit, const ImageContents& contents,
  const ProgressCallback& report, vtkImageData* image)
{
  AxisPositions<Dim> positions;
  for (int a = 0; a < Dim; ++a)
  {
    const int axis = fit.Place.Axis[static_cast<std::size_t>(a)];
    const int* extent = image->GetExtent();
    for (int i = extent[2 * axis]; i <= extent[2 * axis + 1]; ++i)
    {
      // As vtkImageData places its points, so that samples equal the function at those.
      const double world = problem.Origin[axis] + i * problem.SampleSpacing[axis];
      positions[static_cast<std::size_t>(a)].push_back(world - problem.Origin[axis]);
    }
  }

  const double ofArrays = contents.Arrays ? contents.Arrays->numberOfComponents() : 0;
  const double quantities =
    1 + (contents.Gradient ? Dim : 0) + (contents.Support ? 1 : 0) + ofArrays;
  int finished = 0;
  const auto progress = [&](double share) { return report((finished + share) / quantities); };
  const auto newArray = [image](const char* name, int components)
  {
    auto array = vtkSmartPointer<ArrayType>::New();
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(image->GetNumberOfPoints());
    return array;
  };

  // Sampling reports from one thread, which may find nothing left to do; so each end is reported.
  const auto finish = [&]
  {
    ++finished;
    return progress(0);
  };

  auto f = newArray("f", 1);
  if (!sampleInto<Dim>(f.Get(), 0, *fit.Function, positions, -1, progress) || !finish())
  {
    return false;
  }
  image->GetPointData()->SetScalars(f);
  if (contents.Gradient)
  {
    auto gradient = newArray("Gradient", 3);
    gradient->Fill(0);
    for (int a = 0; a < Dim; ++a)
    {
      if (!sampleInto<Dim>(gradient.Get(), fit.Place.Axis[static_cast<std::size_t>(a)],
            *fit.Function, positions, a, progress) ||
        !finish())
      {
        return false;
      }
    }
    turnVectors(fit.Place.Turn, gradient);
    image->GetPointData()->AddArray(gradient);
  }
  if (contents.Support)
  {
    auto support = newArray("Support", 1);
    const ImplicitSpline<Dim> density(fit.Function->lattice(), fit.Support);
    if (!sampleInto<Dim>(support.Get(), 0, density, positions, -1, progress) || !finish())
    {
      return false;
    }
    image->GetPointData()->AddArray(support);
  }
  if (ofArrays > 0)
  {
    return contents.Arrays->sample<Dim>(positions, image->GetPointData(), progress);
  }
  return true;
}
}

template <int Dim>
bool sampleFit(const FitProblem& problem, const FitSolution<Dim>& fit,
  const ImageContents& contents, const ProgressCallback& report, vtkImageData* image)
{
  return contents.ScalarType == VTK_DOUBLE
    ? sampleAs<Dim, vtkDoubleArray>(problem, fit, contents, report, image)
    : sampleAs<Dim, vtkFloatArray>(problem, fit, contents, report, image);
}

template bool sampleFit(const FitProblem&, const FitSolution<2>&, const ImageContents&,
  const ProgressCallback&, vtkImageData*);
template bool sampleFit(const FitProblem&, const FitSolution<3>&, const ImageContents&,
  const ProgressCallback&, vtkImageData*);

void writeFittedPoints(const PointCloud& cloud, const std::vector<std::int64_t>& outliers,
  vtkIPIAImplicitFunction* function, vtkPolyData* output)
{
  const auto n = static_cast<vtkIdType>(cloud.Ids.size());
  vtkNew<vtkIdList> from, to;
  from->SetNumberOfIds(n);
  to->SetNumberOfIds(n);
  vtkNew<vtkPoints> points;
  points->SetDataType(cloud.Source->GetPoints()->GetDataType());
  points->SetNumberOfPoints(n);
  vtkNew<vtkDoubleArray> residual, distance, agreement;
  residual->SetName("Residual");
  distance->SetName("Distance");
  agreement->SetName("NormalAgreement");
  residual->SetNumberOfTuples(n);
  distance->SetNumberOfTuples(n);
  agreement->SetNumberOfTuples(n);
  vtkNew<vtkUnsignedCharArray> outlier;
  outlier->SetName("Outlier");
  outlier->SetNumberOfTuples(n);
  outlier->Fill(0);
  for (const std::int64_t k : outliers)
  {
    outlier->SetValue(k, 1);
  }
  for (vtkIdType i = 0; i < n; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    from->SetId(i, cloud.Ids[k]);
    to->SetId(i, i);
    points->SetPoint(i, cloud.Source->GetPoint(cloud.Ids[k]));
  }
  parallelChunks(n, resolveThreads(0),
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        double g[3];
        const double f = function->EvaluateFunctionAndGradient(
          cloud.Positions[static_cast<std::size_t>(i)].data(), g);
        const double slope = vtkMath::Norm(g);
        residual->SetValue(i, f);
        // Where f is flat there is no distance to tell; f itself is the best guess.
        distance->SetValue(i, slope > 0 ? f / slope : f);
        const double along = vtkMath::Dot(cloud.Normals[static_cast<std::size_t>(i)].data(), g);
        agreement->SetValue(i, slope > 0 ? along / slope : 0.0);
      }
    });
  output->SetPoints(points);
  output->GetPointData()->CopyAllOn();
  output->GetPointData()->CopyAllocate(cloud.Source->GetPointData(), n);
  output->GetPointData()->SetNumberOfTuples(n);
  output->GetPointData()->CopyData(cloud.Source->GetPointData(), from, to);
  output->GetPointData()->AddArray(residual);
  output->GetPointData()->AddArray(distance);
  output->GetPointData()->AddArray(agreement);
  output->GetPointData()->AddArray(outlier);
  if (!cloud.Feathering.empty())
  {
    vtkNew<vtkDoubleArray> feathering;
    feathering->SetName("Feathering");
    feathering->SetNumberOfTuples(n);
    std::copy(cloud.Feathering.begin(), cloud.Feathering.end(), feathering->GetPointer(0));
    output->GetPointData()->AddArray(feathering);
  }
  vtkNew<vtkCellArray> vertices;
  vertices->InsertNextCell(to);
  output->SetVerts(vertices);
}
}
