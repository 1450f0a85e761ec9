// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The solution of a fit problem by the method that its parameters choose.
 */
#ifndef IPIAFitSolution_h
#define IPIAFitSolution_h

#include "Core/ImplicitFit.h"
#include "IPIAControlLattice.h"
#include "IPIAFitProblem.h"

namespace ipia
{
template <int Dim>
struct FitSolution
{
  Placement<Dim> Place;
  FitResult<Dim> Result;
  double OffsetDistance = 0;  ///< of the offset rows, 0 without
  int NumberOfLevels = 1;     ///< of the hierarchy
  double Noise = 0;           ///< in knot spacings of the level it was measured on
  double SmoothingLength = 0; ///< in world units
  std::string Error;          ///< why there is no result; empty otherwise, or if it was aborted
  std::string Warning;        ///< what the user should know about the result
  bool Aborted = false;

  bool isValid() const { return this->Error.empty() && !this->Aborted; }
};

template <int Dim>
FitSolution<Dim> solve(
  const FitProblem& problem, const FitParameters& parameters, const ProgressCallback& progress);
}

#endif
