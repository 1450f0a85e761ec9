// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What happens to the lines of vtkFairingPIACurveFilter, from input to outputs.
 */
#ifndef IPIAFairingCurves_h
#define IPIAFairingCurves_h

#include "IPIAFairingRound.h"
#include "vtkFairingPIACurveFilter.h"

#include "vtkPolyData.h"

#include <string>
#include <vector>

/// The lines of the input and what becomes of them.
class vtkFairingPIACurveFilter::Curves
{
public:
  Curves(vtkFairingPIACurveFilter* filter, vtkPolyData* input, vtkPolyData* controls)
    : Filter(filter)
    , Input(input)
    , Controls(controls)
  {
  }

  std::string read(const ipia::FairingParameters& parameters);
  /// Why the samples would not fit into memory, or nothing.
  std::string checkMemory(const ipia::FairingParameters& parameters) const;
  std::string run(const ipia::FairingParameters& parameters);
  void writeData(vtkPolyData* output) const;
  void writeControls(vtkPolyData* output) const;
  void writeSamples(vtkPolyData* output, vtkPolyData* data) const;

  std::vector<ipia::FairingRound> Rounds;

private:
  struct Line
  {
    std::vector<vtkIdType> Ids; ///< the first point of a closed one not repeated
    bool Closed = false;
  };

  std::string readLines();
  vtkIdType sampleCount(const ipia::FairingRound& round) const;
  std::string readPoints(std::size_t k);
  std::string readParameters(std::size_t k, vtkDataArray* given);
  std::string readEarlierRound();
  std::string start(std::size_t k, const ipia::FairingParameters& parameters);

  vtkFairingPIACurveFilter* Filter;
  vtkPolyData* Input;
  vtkPolyData* Controls;
  std::vector<Line> Lines;
};

#endif
