// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The point arrays of the input that results are to have, and how their values are written.
 */
#ifndef IPIAPointArrays_h
#define IPIAPointArrays_h

#include "IPIAPointCloud.h"

class vtkDataArraySelection;

namespace ipia
{
/// An array that has the same name in the blocks of the input.
struct PointArray
{
  /// Without tuples: name, type, components and their names.
  vtkSmartPointer<vtkDataArray> Prototype;
  /// vtkDataSetAttributes::AttributeTypes, or -1: what the array is in the first block with it.
  int Attribute;
  /// Of each block of the cloud; nullptr where it has none of that name, size and width.
  std::vector<vtkDataArray*> OfBlocks;

  int NumberOfComponents() const;
};

/**
 * The numeric arrays with a name that the selection enables, in the order of their first
 * appearance, without those that the fit itself uses, ids and ghosts.
 */
std::vector<PointArray> choosePointArrays(
  const PointCloud& cloud, vtkDataArraySelection* selection);

/// A new array as the prototype, with so many tuples.
vtkSmartPointer<vtkDataArray> newArray(vtkDataArray* prototype, vtkIdType tuples);

/// Writes a component of an array, rounded where its type is integral.
/// @param values  of tuple i: values[i * stride]
void writeComponent(vtkDataArray* array, int component, const double* values, int stride);
}

#endif
