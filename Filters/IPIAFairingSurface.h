// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What happens to the points of vtkFairingPIASurfaceFilter, from input to outputs.
 */
#ifndef IPIAFairingSurface_h
#define IPIAFairingSurface_h

#include "IPIAFairingRound.h"
#include "vtkFairingPIASurfaceFilter.h"

#include "vtkPointSet.h"
#include "vtkPolyData.h"

#include <string>
#include <vector>

/// The points of the input and the surface through them.
class vtkFairingPIASurfaceFilter::Surface
{
public:
  Surface(vtkFairingPIASurfaceFilter* filter, vtkPointSet* input, vtkPolyData* controls)
    : Filter(filter)
    , Input(input)
    , Controls(controls)
    , Rounds(1)
  {
  }

  std::string read(const ipia::FairingParameters& parameters);
  /// Why the samples would not fit into memory, or nothing.
  std::string checkMemory(const ipia::FairingParameters& parameters) const;
  std::string run(const ipia::FairingParameters& parameters);
  void writeData(vtkPolyData* output);
  void writeControls(vtkPolyData* output) const;
  void writeSamples(vtkPolyData* output, vtkPolyData* data) const;

  const std::vector<ipia::FairingRound>& rounds() const { return this->Rounds; }

private:
  ipia::FairingRound& round() { return this->Rounds.front(); }
  const ipia::FairingRound& round() const { return this->Rounds.front(); }

  /// Number of samples along an axis.
  std::size_t sampleCount(std::size_t axis) const;
  std::string checkGrid();
  std::string readGridSize();
  std::string readPoints();
  std::string readGivenParameters();
  std::string readGridParameters();
  std::string readEarlierRound();
  std::string start(int degree);
  void interpolateArrays(vtkPolyData* output, vtkPolyData* data, const std::vector<double>& u,
    const std::vector<double>& v) const;

  vtkFairingPIASurfaceFilter* Filter;
  vtkPointSet* Input;
  vtkPolyData* Controls;
  std::vector<ipia::FairingRound> Rounds; ///< one
};

#endif
