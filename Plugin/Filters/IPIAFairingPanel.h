// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What both fairing filters for ParaView have in common: arrays by name, and parallel servers.
 */
#ifndef IPIAFairingPanel_h
#define IPIAFairingPanel_h

#include "IPIAGather.h"
#include "IPIAPanelArrays.h"
#include "vtkFiltersIPIAParaViewModule.h" // for the export macro

#include <memory>
#include <string>

class vtkFairingPIAFilter;

namespace ipia
{
/// An array with a tick box: without it, none.
class VTKFILTERSIPIAPARAVIEW_EXPORT OptionalArray
{
public:
  OptionalArray(HiddenArrays& arrays, int index, const char* name, bool use);

  void SetName(const char* name);
  void SetUse(bool use);
  bool GetUse() const { return this->Use; }

private:
  void Take();

  HiddenArrays& Arrays;
  int Index;
  std::string Name;
  bool Use;
};

/// The arrays of a fairing filter by their indices, of which those of the control points (port 1)
/// are optional.
class VTKFILTERSIPIAPARAVIEW_EXPORT FairingArrays : public HiddenArrays
{
public:
  explicit FairingArrays(vtkFairingPIAFilter* filter);

  OptionalArray Weights;
  OptionalArray Movable;
};

/// Makes a port take composite data as one if there are several ranks: otherwise each would be
/// asked for the blocks that it has, and all must meet.
void takeBlocksAsOne(vtkInformation* portInfo);

/// The input of a fairing filter: its own or, with several ranks, as gathered on the first. What
/// the user is to know of that is told as the filter's error or warning.
class FairingInput
{
public:
  /// Collective.
  FairingInput(vtkFairingPIAFilter* filter, vtkInformationVector** input);

  /// nullptr where there is nothing to fair: on the other ranks, and if the parts do not fit.
  vtkInformationVector** Get() const { return this->Vectors; }

private:
  std::unique_ptr<ReplacedInput> Gathered;
  vtkInformationVector** Vectors = nullptr;
};
}

#endif
