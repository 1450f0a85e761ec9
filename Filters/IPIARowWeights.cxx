// SPDX-License-Identifier: BSD-3-Clause
#include "IPIARowWeights.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

namespace ipia
{
namespace
{
/// Weights are at most this many times the typical one.
constexpr double LargestRatio = 1e30;
}

bool isOfBlock(vtkPolyData* block, vtkDataArray* array)
{
  vtkFieldData* field = block->GetFieldData();
  for (int k = 0; array && k < field->GetNumberOfArrays(); ++k)
  {
    if (field->GetAbstractArray(k) == array)
    {
      return true;
    }
  }
  return false;
}

vtkSmartPointer<vtkDoubleArray> weightsOfBlocks(
  const std::vector<vtkPolyData*>& blocks, const std::vector<vtkDataArray*>& arrays)
{
  auto weights = vtkSmartPointer<vtkDoubleArray>::New();
  vtkIdType total = 0;
  for (vtkPolyData* block : blocks)
  {
    total += block->GetNumberOfPoints();
  }
  weights->SetNumberOfTuples(total);
  double* next = weights->GetPointer(0);
  for (std::size_t b = 0; b < blocks.size(); ++b)
  {
    next = std::fill_n(next, blocks[b]->GetNumberOfPoints(), arrays[b]->GetComponent(0, 0));
  }
  return weights;
}

bool weighByLength(
  vtkDataArray* normals, const vtkIdType* ids, std::size_t n, std::vector<double>& weights)
{
  std::vector<double> lengths(n);
  for (std::size_t k = 0; k < n; ++k)
  {
    double v[3];
    normals->GetTuple(ids[k], v);
    const double length = std::hypot(v[0], v[1], v[2]);
    lengths[k] = std::isfinite(length) ? length : 0;
  }
  std::vector<double> positive;
  std::copy_if(lengths.begin(), lengths.end(), std::back_inserter(positive),
    [](double length) { return length > 0; });
  if (positive.empty())
  {
    return false;
  }
  const auto middle = positive.begin() + static_cast<std::ptrdiff_t>(positive.size() / 2);
  std::nth_element(positive.begin(), middle, positive.end());
  weights.resize(n, 1.0);
  bool any = false;
  for (std::size_t k = 0; k < n; ++k)
  {
    weights[k] *= std::min(lengths[k] / *middle, LargestRatio);
    any = any || weights[k] > 0;
  }
  return any;
}
}
