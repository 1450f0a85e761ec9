// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a fit leaves for others: an image of its samples, and the points with what it says of them.
 */
#ifndef IPIAFitOutputs_h
#define IPIAFitOutputs_h

#include "IPIAFitSolution.h"

class vtkIPIAImplicitFunction;
class vtkImageData;
class vtkPolyData;

namespace ipia
{
class AttributeFields;

/// What an image has beside f.
struct ImageContents
{
  int ScalarType = 0; ///< VTK_FLOAT or VTK_DOUBLE
  bool Gradient = false;
  bool Support = false;
  AttributeFields* Arrays = nullptr; ///< the point arrays, if any
};

/**
 * Fills an image, which has its extent and its place, with samples of a fit.
 *
 * @return false if the callback aborted
 */
template <int Dim>
bool sampleFit(const FitProblem& problem, const FitSolution<Dim>& fit,
  const ImageContents& contents, const ProgressCallback& report, vtkImageData* image);

/// The points of a fit with all their arrays, Residual, Distance, NormalAgreement and Outlier.
void writeFittedPoints(const PointCloud& cloud, const std::vector<std::int64_t>& outliers,
  vtkIPIAImplicitFunction* function, vtkPolyData* output);
}

#endif
