// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The solution of a fit problem by the method that its parameters choose.
 */
#ifndef IPIAFitSolution_h
#define IPIAFitSolution_h

#include "Core/BrickSpline.h"
#include "Core/ImplicitFit.h"
#include "Core/IncrementalFit.h"
#include "IPIAFitProblem.h"
#include "IPIAPlacedSpline.h"

namespace ipia
{
template <int Dim>
struct FitSolution
{
  Placement<Dim> Place;
  std::shared_ptr<const ImplicitSpline<Dim>> Function; ///< nullptr if the fit is to stay in bricks
  std::shared_ptr<const BrickSpline<Dim>> Bricks;      ///< of the hierarchy; nullptr without
  Vector Support; ///< as coefficients, see scaledSupport(); empty where it was not asked for
  SolverResult Solver;
  double AverageError = 0;
  double MaximumError = 0;
  double Oscillation = 0;               ///< of a single level with offset rows, 0 otherwise
  double WeightStepSize = 0;            ///< the smallest that a step of the weights was taken with
  double OffsetDistance = 0;            ///< of the offset rows, 0 without
  int NumberOfLevels = 1;               ///< of the hierarchy
  double Noise = 0;                     ///< see HierarchicalResult
  double SmoothingLength = 0;           ///< in world units
  double FlippedNormals = 0;            ///< share of the normals, see SampleFaultCounts
  double ShareOfOutliers = 0;           ///< of the points
  std::vector<std::int64_t> Outliers;   ///< these, of the problem's cloud, ascending
  std::int64_t NumberOfPointsAdded = 0; ///< see HierarchicalResult
  std::int64_t NumberOfCoefficientsSolved = 0; ///< on all levels
  std::string Error;   ///< why there is no result; empty otherwise, or if it was aborted
  std::string Warning; ///< what the user should know about the result
  bool Aborted = false;

  bool isValid() const { return this->Error.empty() && !this->Aborted; }

  std::shared_ptr<const PlacedSpline> placed() const
  {
    return this->Function ? placedSpline<Dim>(this->Function, this->Place)
                          : placedSpline<Dim>(this->Bricks, this->Place);
  }
};

/// Where a problem lies, and the lattice it is solved on.
template <int Dim>
Placement<Dim> placementOf(const FitProblem& problem);
template <int Dim>
Lattice<Dim> latticeOf(const FitProblem& problem, const Placement<Dim>& place);

/// @param incremental  if given, adds to its last fit where it can; of the hierarchy
template <int Dim>
FitSolution<Dim> solve(const FitProblem& problem, const FitParameters& parameters,
  const ProgressCallback& progress, IncrementalFit<Dim>* incremental = nullptr);
}

#endif
