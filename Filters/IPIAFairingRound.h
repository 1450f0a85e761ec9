// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * One round of fairing-PIA on one curve or surface, between VTK's arrays and the core.
 */
#ifndef IPIAFairingRound_h
#define IPIAFairingRound_h

#include "Core/FairingIteration.h"

#include "vtkType.h"

#include <array>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataSet;
class vtkDoubleArray;
class vtkFieldData;
class vtkPolyData;

namespace ipia
{
/// The parameters that vtkFairingPIACurveFilter and vtkFairingPIASurfaceFilter share.
struct FairingParameters
{
  int Degree;
  int DerivativeOrder;
  double FairingWeight;
  FairingOptions Options;
  int AutomaticFairing;
  double AutomaticShare;
  double AutomaticFairingWeight;

  /// Why they cannot be used; empty if they can.
  std::string refusal() const;
};

/// What a curve or surface begins with and what becomes of it.
class FairingRound
{
public:
  /// In coordinates relative to Centre.
  FairingData Data;
  Eigen::RowVector3d Centre = Eigen::RowVector3d::Zero();
  /// Number of data points along both axes; of a curve { m, 1 }, of scattered data { 0, 0 }.
  std::array<std::int64_t, 2> GridSize{};
  /// With Axes and ControlPoints to begin with.
  TensorSpline Spline;

  /// The user's, one per data point or one per control point; empty: none.
  Vector DataWeights, ControlWeights;
  /// One per control point, 0 where it stays; empty: all move.
  Vector Movable;
  /// To insert before the round, per axis.
  std::array<std::vector<double>, 2> InsertedKnots;

  /// The weights that were used, one per control point.
  Vector Weights;
  Eigen::MatrixXd Residuals;
  FairingResult Result;
  /// The fit by which weights were chosen did not reach the tolerance.
  bool ChoiceUnfinished = false;
  double FittingError = 0;
  double FairingEnergy = 0;

  /// Takes the points and moves them about the origin.
  void setPoints(const Eigen::MatrixXd& points);

  /// Control points from ordered data, as the paper takes them.
  void startFromGrid();
  /// Control points from scattered data: the mean of the data in each support, and where there are
  /// none that of the nearest control points which have some.
  void startFromScatteredData();

  /// Inserts the knots, chooses the weights and iterates. Returns why it is refused, or nothing.
  std::string run(const FairingParameters& parameters, const ProgressCallback& progress);

private:
  std::string insertKnots();
  std::string chooseWeights(const FairingParameters& parameters, const ProgressCallback& progress);
};

/// A knot that coincides with others more than @a degree times, or with an end of the domain; else
/// -1.
double excessKnot(const std::vector<double>& interior, int degree);

/**
 * The point array that the user has chosen with SetInputArrayToProcess, or none: where nothing was
 * chosen, by the names "" and "None", and where a default is not there.
 * @param what  it is the array of, for messages
 * Returns why it cannot be used, or nothing.
 */
std::string chooseArray(vtkAlgorithm* filter, int index, vtkDataSet* input, int components,
  const std::string& what, vtkDataArray*& array);

/// A message where a point array has not one tuple per point.
std::string checkPointArrays(vtkDataSet* input);

/// Extents outside of it, cubed and divided by, leave the range of double.
constexpr double LargestExtent = 1e100, SmallestExtent = 1e-100;

/// A message where the points have an extent with whose powers one cannot compute.
std::string checkExtent(const Eigen::MatrixXd& points);

/// A message where the fit and its samples would not fit into the memory of the machine.
std::string checkMemory(const std::vector<FairingRound>& rounds,
  const FairingParameters& parameters, double samples, double bytesPerSample, vtkDataSet* input);

/// A message where knots are all but equal.
std::string checkSpans(const std::vector<double>& interior);

/// A message where a value of a weight array is not in [0, 1].
std::string checkWeights(const Vector& weights, const std::string& name);

/// The name of an array, or nothing.
std::string nameOf(vtkDataArray* array);

/// The first component of an array.
Vector toVector(vtkDataArray* array);

/// A new point array of doubles, to be filled.
vtkDoubleArray* addPointArray(vtkPolyData* data, const char* name, int components);

/// An array of one component as field data; replaces one of that name.
void addFieldArray(vtkFieldData* field, const char* name, const std::vector<double>& values);
void addFieldArray(vtkFieldData* field, const char* name, const std::vector<std::int64_t>& values);

/// What the rounds of a filter tell, as field data: histories one after the other, and where each
/// begins.
void addHistories(vtkFieldData* field, const std::vector<FairingRound>& rounds);
}

#endif
