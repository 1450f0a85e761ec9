// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The whole fit on one lattice: from oriented points to the function and its figures.
 */
#ifndef ipia_ImplicitFit_h
#define ipia_ImplicitFit_h

#include "ImplicitSpline.h"
#include "RationalSolver.h"

namespace ipia
{
/**
 * What is to be fitted. Positions are relative to the lower corner of the domain and inside it.
 *
 * Point k gives a row f(p_k) = 0, and with a normal one or two offset rows,
 * f(p_k + sigma_k n_k) = +epsilon_k and f(p_k - sigma'_k n_k) = -epsilon'_k, all with its weight.
 * Offset rows that leave the domain are left out.
 */
template <int Dim>
struct FitInput
{
  Points<Dim> Positions; ///< Dim x n
  Points<Dim> Normals;   ///< Dim x n, unit length, towards f > 0; a zero column has no offset rows
  Vector Weights;        ///< n, >= 0; empty: 1

  Vector OutwardDistance;  ///< sigma, n; a zero leaves the row out
  double OutwardValue = 0; ///< epsilon; 0: equal to the distance
  Vector InwardDistance;   ///< sigma', n, or empty for outward rows alone
  double InwardValue = 0;  ///< epsilon'; 0: equal to the distance

  Points<Dim> ExtraPositions; ///< Dim x m: further rows of weight 1 ...
  Vector ExtraValues;         ///< ... with their own target values
};

enum class Basis
{
  BSpline,        ///< f = sum_i c_i B_i
  UniformRational ///< f = sum_i c_i w_i B_i / sum_i w_i B_i; SolverType::ProgressiveIteration only
};

struct FitOptions
{
  SolverOptions Solver;
  Basis Type = Basis::BSpline;
  RationalOptions Rational;
  FarFieldOptions FarField; ///< Threshold 0: no far field
  int Threads = 0;
};

template <int Dim>
struct FitResult
{
  ImplicitSpline<Dim> Function;
  SolverResult Solver;
  /// The density of rows s(x) over its median at the points: 1 where data are typical.
  Vector Support;
  double AverageError = 0; ///< E_ave, mean of f^2 over the points
  double MaximumError = 0; ///< E_max, max |f| over the points
  double Oscillation = 0;  ///< R(C), sum over coefficients of squared differences to each neighbour
  double WeightStepSize = 0; ///< the smallest tau taken; 0 without weights
};

template <int Dim>
FitResult<Dim> fitImplicit(const Lattice<Dim>& lattice, const FitInput<Dim>& input,
  const FitOptions& options, const ProgressCallback& progress = {});

/// The density of points sum_i B_i(x) sum_k B_i(x_k), as coefficients, over its median at the
/// points.
template <int Dim>
Vector scaledSupport(const Lattice<Dim>& lattice, const Points<Dim>& positions, int threads);
}

#endif
