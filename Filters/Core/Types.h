// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The few types that every part of the core shares.
 *
 * Dim is 2 or 3 throughout. All lengths in the core are in the caller's units, all positions
 * relative to the corner lo of the domain, in double, so that data far from the origin lose no
 * digits.
 */
#ifndef ipia_Types_h
#define ipia_Types_h

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace ipia
{
template <int Dim>
using Point = Eigen::Matrix<double, Dim, 1>;

/// n points as a Dim x n matrix, one point a column.
template <int Dim>
using Points = Eigen::Matrix<double, Dim, Eigen::Dynamic>;

/// Row-wise attributes or coefficients; coefficients are ordered x fastest, as VTK orders points.
using Vector = Eigen::VectorXd;

template <int Dim>
using Index = std::array<std::int64_t, Dim>;

/// Called with the share of the work done, in [0, 1]; returns false to abort.
using ProgressCallback = std::function<bool(double)>;
}

#endif
