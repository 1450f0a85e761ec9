// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a round of fairing-PIA takes over from an earlier one: knots, and control points with their
 * arrays.
 */
#ifndef IPIAEarlierRound_h
#define IPIAEarlierRound_h

#include "vtkType.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkFieldData;
class vtkPolyData;

namespace ipia
{
class FairingRound;

/// The degree and the knots of an earlier round.
struct EarlierKnots
{
  int Degree = 0;
  /// Those inside (0, 1), per curve or axis.
  std::vector<std::vector<double>> Interior;

  /**
   * Reads and checks the field data of control points.
   * @param count     of curves or axes
   * @param periodic  of each
   * @param name      of one of them, for messages
   * @param derivativeOrder  of the round to come, which the degree must have
   * Returns why they cannot be used, or nothing.
   */
  std::string read(vtkFieldData* field, std::size_t count, const std::vector<bool>& periodic,
    const std::function<std::string(std::size_t)>& name, int derivativeOrder);
};

/// The number of one component and tuple that field data has under a name, or NaN.
double fieldNumber(vtkFieldData* field, const char* name, vtkIdType tuple);

/// The control points of an earlier round, and the arrays that the user has chosen for them.
class EarlierControls
{
public:
  /**
   * Reads which arrays there are.
   * @param count  how many control points the knots ask for
   * Returns why they cannot be used, or nothing.
   */
  std::string read(vtkAlgorithm* filter, vtkPolyData* controls, vtkIdType count);

  /**
   * Gives a round, whose spline has its axes, as many control points as these ask for.
   * @param first  of them
   * @param name   of the curve, for messages; or nothing
   * Returns why they cannot be used, or nothing.
   */
  std::string give(vtkIdType first, const std::string& name, FairingRound& round) const;

private:
  vtkPolyData* Controls = nullptr;
  vtkDataArray* Weights = nullptr;
  vtkDataArray* Movable = nullptr;
};
}

#endif
