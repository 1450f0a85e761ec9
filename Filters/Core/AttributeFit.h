// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Values at scattered points (colours, scalars, vectors) as smooth functions in space.
 *
 * A least-squares linear function takes the first part of an array. Its rest, in units s of the
 * largest, is fitted as f is in HierarchicalFit.h, coarse to fine, by rows of values alone: each
 * level minimises, from the exact knot refinement of the one before,
 *
 *   sum_k w_k (v(p_k) - v_k)^2 + tau_1 sum |D_a c|^2 + tau_2 sum [ |D_aa c|^2 + 2 |D_ab c|^2 ].
 *
 * Noise is smoothed by prediction: every eighth point is held out and the others are fitted on all
 * levels, then, where that predicts the held-out values better, with larger tau_2. The coarsest
 * level and largest tau_2 that predict within a quarter of a percent of the best are taken, and the
 * fit goes on from there with all points. The components of an array are predicted together; arrays
 * choose each for itself.
 */
#ifndef ipia_AttributeFit_h
#define ipia_AttributeFit_h

#include "AttributeSpline.h"

namespace ipia
{
/// Arrays with a value at each of the same points.
template <int Dim>
struct AttributeInput
{
  Points<Dim> Positions; ///< Dim x n, relative to the lower corner of the domain and inside it
  Vector Weights;        ///< n, >= 0, not all 0; empty: 1
  std::vector<Eigen::MatrixXd> Arrays; ///< components x n each, finite
};

/// What was chosen for an array.
struct AttributeReport
{
  int Level = 0;              ///< the finest of its spline; 0 is the coarsest
  int NumberOfLevels = 0;     ///< that there are on the lattice
  double ThinPlate = 0;       ///< tau_2 of the finest
  double PredictionError = 0; ///< root mean square at the held-out points; 0 where none are
};

template <int Dim>
struct AttributeResult
{
  bool Aborted = false;
  std::vector<AttributeSpline<Dim>> Arrays; ///< empty if aborted
  std::vector<AttributeReport> Reports;
};

/// @param lattice  the finest lattice
template <int Dim>
AttributeResult<Dim> fitAttributes(const Lattice<Dim>& lattice, AttributeInput<Dim> input,
  int threads = 0, const ProgressCallback& progress = {});
}

#endif
