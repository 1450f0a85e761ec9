// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Row weights that are not given point by point: one for each block, or by the length of normals.
 */
#ifndef IPIARowWeights_h
#define IPIARowWeights_h

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <vector>

class vtkDataArray;
class vtkDoubleArray;
class vtkPolyData;

namespace ipia
{
/// Whether an array is one of the field data of a block, which has one value for all its points.
bool isOfBlock(vtkPolyData* block, vtkDataArray* array);

/// The value of each block's array for all its points, one block after the other.
vtkSmartPointer<vtkDoubleArray> weightsOfBlocks(
  const std::vector<vtkPolyData*>& blocks, const std::vector<vtkDataArray*>& arrays);

/**
 * Multiplies weights by the lengths of normals over the median of those that have one, and by 0
 * where the length is 0 or not finite.
 *
 * @param normals  as given
 * @param ids      the n tuples of it that count
 * @param weights  n, or empty: 1
 * @return whether any weight is not 0
 */
bool weighByLength(
  vtkDataArray* normals, const vtkIdType* ids, std::size_t n, std::vector<double>& weights);
}

#endif
