// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The oscillation R(C) of a lattice of coefficients and the steps that keep it small (Huang, 2024,
 * eq. 31 to 34).
 *
 * R(C) = sum_i sum over the axis neighbours j of i of (c_j - c_i)^2. Each edge counts twice, so
 * that with the Laplacian of the grid, (L C)_i = sum_j (c_i - c_j), R = 2 C^T L C and grad R = 4 L
 * C.
 */
#ifndef ipia_Oscillation_h
#define ipia_Oscillation_h

#include "Lattice.h"

namespace ipia
{
/// R(C).
template <int Dim>
double oscillation(const Lattice<Dim>& lattice, const Vector& coefficients);

/// @a laplacian = L C; returns R(C).
template <int Dim>
double oscillation(
  const Lattice<Dim>& lattice, const Vector& coefficients, Vector& laplacian, int threads);

/// How the weight lambda of the oscillation enters a step of the coefficients.
enum class OscillationStep
{
  /// C <- C + mu [D^T W (b - D C) - 2 lambda L C], mu = 2 / (||D^T W D||_inf + 8 Dim lambda): the
  /// minimiser of E + lambda R, for any lambda.
  Energy,
  /// C <- C + mu D^T W (b - D C) - 4 lambda L C, mu = 2 / ||D^T W D||_inf, eq. 33 of the paper: the
  /// minimiser of E + (2 lambda / mu) R. Diverges from some lambda below 1 / (8 Dim) on.
  AsPrinted
};

struct OscillationOptions
{
  double Weight = 0; ///< lambda >= 0
  OscillationStep Step = OscillationStep::Energy;
};

/**
 * The oscillation's part in an iteration: that of C <- C + mu [D^T W (b - D C) - kappa L C].
 */
template <int Dim>
class OscillationTerm
{
public:
  OscillationTerm(const Lattice<Dim>& lattice, const OscillationOptions& options, int threads);

  bool isActive() const { return this->Options.Weight > 0; }

  /// mu for the largest row sum of D^T W D, or a given one > 0; settles kappa.
  double chooseStepSize(double largestRowSum, double given);

  /// To be called when the coefficients have changed.
  void update(const Vector& coefficients);

  /// lambda R(C), which belongs to the energy that is reported.
  double energy() const { return this->Options.Weight * this->Value; }

  /// (kappa / 2) R(C): with E it makes the energy that the steps descend.
  double descendedEnergy() const { return this->Kappa / 2 * this->Value; }

  /// The sum of weights that the edges add to those of the rows, for bounds of rounding.
  double sumOfWeights() const;

  double kappa() const { return this->Kappa; }

  /// L C
  const Vector& laplacian() const { return this->Laplacian; }

private:
  const Lattice<Dim> ControlLattice;
  const OscillationOptions Options;
  const int Threads;
  double Kappa;
  double Value = 0; // R(C)
  Vector Laplacian;
};
}

#endif
