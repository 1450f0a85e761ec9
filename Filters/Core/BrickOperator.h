// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The normal equations of one level on its band: rows and fairing energy, in single precision.
 *
 * The least-squares energy of a level is, with f_a = h_a df/dx_a and s_a = h / h_a (h the mean
 * spacing),
 *
 *   E = sum_k w_k (f(x_k) - v_k)^2 + sum_k g_k sum_a s_a^2 (f_a(x_k) - slope_ka)^2
 *     + tau_1 sum |D_a c|^2 + tau_2 sum [ |D_aa c|^2 + 2 |D_ab c|^2 ]
 *
 * where D are differences of neighbouring coefficients (scaled by s_a): the membrane and thin-plate
 * energies of f. At the border of the lattice the differences that leave it are left out (natural
 * boundary); at the border of the band coefficients keep their inherited values.
 *
 * Vectors have BrickSize values per brick: of all stored bricks for f, of the active ones
 * otherwise.
 */
#ifndef ipia_BrickOperator_h
#define ipia_BrickOperator_h

#include "HermiteRows.h"

namespace ipia
{
struct FairingWeights
{
  float Membrane = 0;  ///< tau_1
  float ThinPlate = 0; ///< tau_2

  bool any() const { return this->Membrane > 0 || this->ThinPlate > 0; }
};

template <int Dim>
class BrickOperator
{
public:
  BrickOperator(const BrickLattice<Dim>& bricks, const HermiteRows<Dim>& rows,
    const FairingWeights& fairing, int threads);

  /// @a gradient = minus half the gradient of E at the lattice's coefficients.
  void residual(BrickValues& gradient) const;

  /// @a product = A p, the system matrix times a vector that is 0 outside the active bricks.
  void product(const BrickValues& p, BrickValues& product) const;

  /// @a diagonal of A.
  void diagonal(BrickValues& diagonal) const;

  /// sum_k w_k (f - v)^2 + g_k sum_a s_a^2 (f_a - slope)^2 at the lattice's coefficients.
  double energy() const;

  /// @a sums_i = sum_k w_k B_i(x_k).
  void density(BrickValues& sums) const;

  /// The spline with the given coefficients (all stored, or the active bricks') at the rows:
  /// values[row.Source].
  void evaluate(const BrickValues& coefficients, BrickValues& values) const;

  /// Value and derivatives by the local coordinates at the rows: (1 + Dim) values per row.Source.
  void evaluateWithGradient(const BrickValues& coefficients, BrickValues& values) const;

private:
  template <int Kind>
  void sweepRows(const float* input, std::int32_t inputBricks, float* output) const;
  void applyFairing(
    const float* input, std::int32_t inputBricks, float sign, BrickValues& output) const;

  void fill(BrickValues& values, float value) const;

  const BrickLattice<Dim>& Bricks;
  const HermiteRows<Dim>& Rows;
  FairingWeights Fairing;
  std::array<float, Dim> AxisScale; ///< s_a^2
  int Threads;
};
}

#endif
