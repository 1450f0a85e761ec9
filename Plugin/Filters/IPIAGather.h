// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the fitters of a server get in place of their input: the points of all ranks on the first,
 * which alone fits them, and copies that stay the same.
 */
#ifndef IPIAGather_h
#define IPIAGather_h

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <string>
#include <vector>

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

/// The same for all inputs of all ports if there is more than one rank; returns whether there is.
bool requestOwnParts(vtkInformationVector** input, int numberOfPorts);

/// What one rank has gathered.
struct Gathered
{
  /// On the first rank the points of all: a vtkPolyData if only one data set has any or all are
  /// pieces of one, otherwise a vtkMultiBlockDataSet of those that have, in the order of the ranks.
  /// On the others, and where no rank has data, nullptr.
  vtkSmartPointer<vtkDataObject> Data;
  /// On the first rank: how many ranks had points.
  int RanksWithPoints = 0;
};

/// Collective: every rank calls it, with its own part of the data (or nullptr). Points and point
/// arrays travel, cells do not: a fit does not use them.
Gathered gatherPoints(vtkMultiProcessController* controller, vtkDataObject* part);

/// What one rank has gathered with its shape.
struct GatheredShape
{
  /// On the first rank poly data with the points and lines of all ranks, one after the other in
  /// their order, or the structured grid that all pieces make up; on the others, empty poly data.
  vtkSmartPointer<vtkDataObject> Data;
  int RanksWithPoints = 0;
  /// How many data sets had points.
  int NumberOfParts = 0;
  /// Why the pieces of a grid make up none, or nothing.
  std::string Refusal;
};

/// As gatherPoints, for filters that need lines, grids and field data (that of one data set only).
GatheredShape gatherShape(vtkMultiProcessController* controller, vtkDataObject* part);

/// What is told of a fit of the points of several ranks.
std::string gatheredWarning(int ranksWithPoints, int ranks);

/// A copy of a filter's input that stays the same object for as long as the input does. ParaView
/// puts a filter before each input that copies it whenever anything is updated: to a fitter that
/// would be other points, which it would fit again.
class SteadyCopy
{
public:
  /// The copy; nullptr without data.
  vtkDataObject* Of(vtkInformation* input);

private:
  vtkSmartPointer<vtkDataObject> Copy;
  std::vector<vtkMTimeType> Identity;
};

/// Takes the place of a filter's input vectors: the same, with other data.
class ReplacedInput
{
public:
  ReplacedInput(vtkInformationVector** input, int numberOfPorts);
  ~ReplacedInput();
  ReplacedInput(const ReplacedInput&) = delete;
  void operator=(const ReplacedInput&) = delete;

  /// nullptr leaves the port without data.
  void Set(int port, vtkDataObject* data);
  vtkInformationVector** Get();

private:
  int NumberOfPorts;
  vtkInformationVector** Vectors;
};
}

#endif
