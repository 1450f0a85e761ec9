// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The fitted function: evaluation anywhere, sampling on grids.
 */
#ifndef ipia_ImplicitSpline_h
#define ipia_ImplicitSpline_h

#include "FarField.h"
#include "Lattice.h"
#include "SplineSampling.h"

namespace ipia
{
/**
 * f(x) = sum_i c_i B_i(x) on the domain, or with weights the uniform rational spline
 * f(x) = sum_i c_i w_i B_i(x) / sum_i w_i B_i(x); the constant of the far field in its cells, and
 * beyond the domain a continuation that keeps the sign: f at the nearest point of the domain, moved
 * away from 0 by the distance to it.
 */
template <int Dim>
class ImplicitSpline
{
public:
  /// Without coefficients; to be assigned to.
  ImplicitSpline() = default;

  ImplicitSpline(const Lattice<Dim>& lattice, Vector coefficients, FarField farField = {});

  /// The rational spline. @param weights  w, >= 0, with positive denominators everywhere
  ImplicitSpline(
    const Lattice<Dim>& lattice, Vector coefficients, Vector weights, FarField farField = {});

  const Lattice<Dim>& lattice() const { return this->ControlLattice; }
  const Vector& coefficients() const { return this->Coefficients; }
  const FarField& farField() const { return this->Far; }

  bool isRational() const { return this->Weights.size() > 0; }
  /// Empty if the spline is not rational.
  const Vector& weights() const { return this->Weights; }

  double value(const Point<Dim>& position) const;

  /// The exact gradient; 0 in the cells of the far field.
  Point<Dim> gradient(const Point<Dim>& position) const;

  /// Both at once; returns f.
  double valueAndGradient(const Point<Dim>& position, Point<Dim>& gradient) const;

  /// The same at many positions, one a column, with the best instructions that the machine has.
  void valuesAndGradients(
    const Points<Dim>& positions, Vector& values, Points<Dim>& gradients) const;

  /**
   * f on a grid inside the domain, x fastest.
   *
   * The tensor-product sum is taken one axis at a time, so that a sample costs about seven
   * multiply-adds; the result equals value() up to rounding. A rational spline samples numerator
   * and denominator, and for a derivative theirs too, and takes as many times as long.
   *
   * @param values          room for the product of the numbers of positions
   * @param derivativeAxis  -1: f; else the partial derivative along that axis
   * @return false if the callback aborted
   */
  template <typename Scalar>
  bool sample(const AxisPositions<Dim>& positions, Scalar* values, int threads = 0,
    int derivativeAxis = -1, const ProgressCallback& progress = {}) const;

private:
  template <typename Scalar>
  bool sampleRational(const AxisPositions<Dim>& positions, Scalar* values, int threads,
    int derivativeAxis, const ProgressCallback& progress) const;

  Lattice<Dim> ControlLattice;
  Vector Coefficients;
  Vector Weights;   // of the rational spline; empty without
  Vector Numerator; // c_i w_i; empty without
  FarField Far;
};
}

#endif
