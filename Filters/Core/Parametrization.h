// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Parameters of ordered points, knots from parameters, and control points to begin with.
 */
#ifndef ipia_Parametrization_h
#define ipia_Parametrization_h

#include "BSplineBasis.h"

namespace ipia
{
enum class ParametrizationType
{
  Uniform,    ///< equal steps
  Chord,      ///< steps as the distances of the points
  Centripetal ///< steps as the square roots of the distances
};

/**
 * Parameters t_0 = 0 < ... of m ordered points in [0, 1]. Of an open curve the last one is 1; of a
 * closed one, whose first point is not repeated, the step from the last point to the first ends
 * at 1.
 * @param points  m by number of coordinates
 */
Vector parametrize(const Eigen::MatrixXd& points, ParametrizationType type, bool closed);

/**
 * Parameters of @a rows ordered points for a grid of rows x columns points, the rows fastest: the
 * mean over the columns of the parameters of each column. Columns without extent do not count.
 * @param points  rows * columns by number of coordinates
 * @param axis    0: along the rows; 1: along the columns, mean over the rows
 */
Vector parametrizeGrid(const Eigen::MatrixXd& points, std::int64_t rows, std::int64_t columns,
  int axis, ParametrizationType type, bool closed);

/**
 * A basis of n functions whose knots average the parameters t_0 <= ... <= t_{m-1}, so that every
 * span has data: with d = m / (n - p), i = floor(j d) and alpha = j d - i the knots are
 * u_{j+p} = (1 - alpha) t_{i-1} + alpha t_i, j = 1, ..., n - p - 1 (Jiang and Lin; Piegl and
 * Tiller, eq. 9.69). Closed: n spans, d = m / n, u_j = (1 - alpha) t_i + alpha t_{i+1} with t_m
 * = 1. Knots that differ by less than BSplineBasis::SmallestSpan, as means of equal parameters do
 * by rounding, are made equal. Needs p + 1 <= n <= m.
 */
BSplineBasis averagedKnots(const Vector& parameters, int degree, std::int64_t n, bool closed);

/// A basis of n >= degree + 1 functions on equal spans.
BSplineBasis uniformKnots(int degree, std::int64_t n, bool closed);

/**
 * For each control point the number of the data point to begin with: 0, floor(m j / n) - 1 for the
 * j-th (from 1), and m - 1. Closed: floor(m (j - (p - 1) / 2) / n) modulo m for the j-th (from 0).
 */
std::vector<std::int64_t> initialPoints(const BSplineBasis& basis, std::int64_t m);
}

#endif
