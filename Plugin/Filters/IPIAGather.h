// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The points of all ranks of a parallel server on its first rank, which alone fits them.
 */
#ifndef IPIAGather_h
#define IPIAGather_h

#include "vtkSmartPointer.h"

class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;

namespace ipia
{
/// The controller of the server if there is more than one rank, otherwise nullptr.
vtkMultiProcessController* parallelController();

/// Makes a filter ask for the part of its input that this rank has, without ghosts.
void requestOwnPart(vtkMultiProcessController* controller, vtkInformation* inputInfo);

/// What one rank has gathered.
struct Gathered
{
  /// On the first rank the points of all: a vtkPolyData if only one data set has any, otherwise a
  /// vtkMultiBlockDataSet of those that have, in the order of the ranks. On the others, and where
  /// no rank has data, nullptr.
  vtkSmartPointer<vtkDataObject> Data;
  /// On the first rank: how many ranks had points.
  int RanksWithPoints = 0;
};

/// Collective: every rank calls it, with its own part of the data (or nullptr). Points and point
/// arrays travel, cells do not: a fit does not use them.
Gathered gatherPoints(vtkMultiProcessController* controller, vtkDataObject* part);

/// Takes the place of a filter's input vectors: the same, with the gathered data.
class GatheredInput
{
public:
  GatheredInput(vtkInformationVector** input, int numberOfPorts);
  ~GatheredInput();
  GatheredInput(const GatheredInput&) = delete;
  void operator=(const GatheredInput&) = delete;

  /// nullptr leaves the port without data.
  void Set(int port, vtkDataObject* data);
  vtkInformationVector** Get();

private:
  int NumberOfPorts;
  vtkInformationVector** Vectors;
};
}

#endif
