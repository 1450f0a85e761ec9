// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The solution of a fit problem by the method that its parameters choose.
 */
#ifndef IPIAFitSolution_h
#define IPIAFitSolution_h

#include "Core/BrickSpline.h"
#include "Core/ImplicitFit.h"
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
  double Oscillation = 0;     ///< of a single level with offset rows, 0 otherwise
  double WeightStepSize = 0;  ///< the smallest that a step of the weights was taken with
  double OffsetDistance = 0;  ///< of the offset rows, 0 without
  int NumberOfLevels = 1;     ///< of the hierarchy
  double Noise = 0;           ///< see HierarchicalResult
  double SmoothingLength = 0; ///< in world units
  double FlippedNormals = 0;  ///< share of the normals, see HierarchicalResult
  double Outliers = 0;        ///< share of the points
  std::string Error;          ///< why there is no result; empty otherwise, or if it was aborted
  std::string Warning;        ///< what the user should know about the result
  bool Aborted = false;

  bool isValid() const { return this->Error.empty() && !this->Aborted; }

  std::shared_ptr<const PlacedSpline> placed() const
  {
    return this->Function ? placedSpline<Dim>(this->Function, this->Place)
                          : placedSpline<Dim>(this->Bricks, this->Place);
  }
};

template <int Dim>
FitSolution<Dim> solve(
  const FitProblem& problem, const FitParameters& parameters, const ProgressCallback& progress);
}

#endif
