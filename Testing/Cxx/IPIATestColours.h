// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Colours with noise at the points of a model, and how far from the truth they are on its surface.
 */
#ifndef IPIATestColours_h
#define IPIATestColours_h

#include "vtkIPIASurfaceReconstruction.h"

#include "vtkDataArray.h"
#include "vtkMinimalStandardRandomSequence.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointInterpolator.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVoronoiKernel.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace ipiatest
{
/// Root mean square errors over the vertices of the surface and red, green and blue, 0 to 255.
struct ColourErrors
{
  double OfSurface; ///< the array that the reconstruction gives it
  double OfNearest; ///< the colours of the nearest point
};

/// Gives points waves of a tenth of their longest side as colours, with noise of 5 % of the range,
/// and reconstructs them.
inline ColourErrors NoisyColours(vtkPolyData* cloud)
{
  const double* bounds = cloud->GetBounds();
  const double wave = 2 * 3.14159265358979323846 * 10 /
    std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] });
  const auto colour = [wave](const double x[3], int c)
  {
    return 127.5 *
      (1 +
        std::sin(wave * (x[c] + 0.3 * x[(c + 1) % 3]) + c) *
          std::cos(0.7 * wave * x[(c + 2) % 3] + 0.5 * c));
  };
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetName("RGB");
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(cloud->GetNumberOfPoints());
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(3);
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    double x[3];
    cloud->GetPoint(i, x);
    for (int c = 0; c < 3; ++c)
    {
      // The sum of four uniform deviates of variance 1/3, scaled to a variance of 1.
      double noise = 0;
      for (int k = 0; k < 4; ++k)
      {
        random->Next();
        noise += random->GetRangeValue(-1, 1) * std::sqrt(3. / 4);
      }
      const double v = colour(x, c) + 0.05 * 255 * noise;
      colours->SetComponent(i, c, std::min(std::max(std::round(v), 0.), 255.));
    }
  }
  cloud->GetPointData()->SetScalars(colours);
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(cloud);
  reconstruction->Update();
  vtkPolyData* surface = reconstruction->GetOutput();
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(surface->GetPoints());
  vtkNew<vtkPointInterpolator> nearest;
  nearest->SetInputData(bare);
  nearest->SetSourceData(cloud);
  vtkNew<vtkVoronoiKernel> kernel;
  nearest->SetKernel(kernel);
  nearest->Update();
  const auto error = [&](vtkDataArray* array)
  {
    double sum = 0;
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      double x[3];
      surface->GetPoint(i, x);
      for (int c = 0; c < 3; ++c)
      {
        const double miss = array->GetComponent(i, c) - colour(x, c);
        sum += miss * miss;
      }
    }
    return std::sqrt(sum / (3. * static_cast<double>(array->GetNumberOfTuples())));
  };
  const ColourErrors errors{ error(surface->GetPointData()->GetArray("RGB")),
    error(vtkPolyData::SafeDownCast(nearest->GetOutput())->GetPointData()->GetArray("RGB")) };
  std::cout << "root mean square colour error: " << errors.OfSurface
            << ", of the nearest point: " << errors.OfNearest << "\n";
  return errors;
}
}

#endif
