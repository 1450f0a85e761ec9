// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A spline on a grid of samples.
 */
#ifndef ipia_SplineSampling_h
#define ipia_SplineSampling_h

#include "FarField.h"
#include "Lattice.h"

#include <vector>

namespace ipia
{
/// Sample positions per axis, relative to the lower corner of the domain, ascending.
template <int Dim>
using AxisPositions = std::array<std::vector<double>, Dim>;

/**
 * sum_i c_i B_i or a partial derivative of it on a grid inside the domain, x fastest; in the cells
 * of the far field its constants.
 *
 * The tensor-product sum is taken one axis at a time, so that a sample costs about seven
 * multiply-adds.
 *
 * @param constants       where the far field has the sign -1 and 1
 * @param values          room for the product of the numbers of positions
 * @param derivativeAxis  -1: the sum; else its partial derivative along that axis
 * @return false if the callback aborted
 */
template <int Dim, typename Scalar>
bool sampleSpline(const Lattice<Dim>& lattice, const Vector& coefficients, const FarField& farField,
  std::array<double, 2> constants, const AxisPositions<Dim>& positions, Scalar* values, int threads,
  int derivativeAxis, const ProgressCallback& progress);
}

#endif
