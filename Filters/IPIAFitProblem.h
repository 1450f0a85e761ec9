// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The parameters of a fit, and the domain, lattice and samples that follow from them and the input.
 */
#ifndef IPIAFitProblem_h
#define IPIAFitProblem_h

#include "IPIAPointArrays.h"

namespace ipia
{
/// The values of vtkIPIAImplicitFitter's parameters, under their names there.
struct FitParameters
{
  std::array<double, 6> ModelBounds;
  double Padding;
  std::array<int, 3> GridSize;
  std::array<int, 3> SampleDimensions;
  int Dimension;
  int NormalConstraint;
  double OffsetDistance;
  double OffsetValue;
  double InwardOffsetDistance;
  double InwardOffsetValue;
  int BasisType;
  double WeightStepSize;
  double OscillationWeight;
  int OscillationStep;
  double FairingWeight;
  int FairingOrder;
  int Solver;
  int NumberOfLevels;
  int MaximumNumberOfIterations;
  double Tolerance;
  int StoppingRule;
  double StepSize;
  bool GenerateGradient;
  bool GenerateSupport;
  int OutputScalarType;
  bool Incremental;
  bool FunctionOnly; ///< nothing but the function is wanted, no image and no lattice

  /// The papers' method on one level, with offset rows; otherwise the fit is hierarchical.
  bool isClassic() const;

  bool isRational() const;
};

/**
 * One problem, ready to be solved or refused.
 */
class FitProblem
{
public:
  PointCloud Cloud;
  std::vector<PointArray> Arrays; ///< of the cloud, that are fitted beside f
  std::string Refusal;            ///< empty if the problem can be solved
  vtkIdType OutsideBounds = 0;    ///< points and extra rows that were dropped

  int Dimension = 3;
  ipia::Frame Frame; ///< turned where the points lie in a tilted plane; what follows is in it
  std::array<double, 6> PointBounds{}; ///< min and max of the points per axis
  int FlatAxis = -1;                   ///< the axis across the plane in 2-D
  double Origin[3] = { 0, 0, 0 };
  double Upper[3] = { 0, 0, 0 };
  double Spacing[3] = { 1, 1, 1 };
  int GridSize[3] = { 1, 1, 1 };
  double SampleSpacing[3] = { 1, 1, 1 };
  double DataSpacing = 0; ///< of the hierarchy: the knot spacing that suits the points
  int WholeExtent[6] = { 0, -1, 0, -1, 0, -1 };

  /// Derives all from the cloud and the arrays, which have been gathered.
  void Prepare(const FitParameters& parameters);

  /// Whether neither the finest lattice nor an image of f is ever held: the function of a hierarchy
  /// in 3-D, where that alone is wanted and nothing is said about samples.
  bool staysInBricks(const FitParameters& parameters) const;

private:
  void CheckCombination(const FitParameters& parameters);
  void CheckNumbers(const FitParameters& parameters);
  /// Of all points and extra rows.
  double totalWeight() const;
  void CheckBasisAndOscillation(const FitParameters& parameters);
  void CheckPrintedStep(const FitParameters& parameters);
  void ChooseDimension(const FitParameters& parameters);
  template <int Dim>
  void ChooseLattice(const FitParameters& parameters);
  void ChooseSamples(const FitParameters& parameters);
  void DropPointsOutside();
  void CheckMemory(const FitParameters& parameters);
};
}

#endif
