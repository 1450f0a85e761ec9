// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The data of a hierarchical fit in the order of a space-filling curve, and clusters of them.
 */
#ifndef ipia_PointSamples_h
#define ipia_PointSamples_h

#include "BulkVector.h"
#include "Lattice.h"

#include <algorithm>

namespace ipia
{
/// What is to be fitted; positions are relative to the lower corner of the domain and inside it.
template <int Dim>
struct HermiteInput
{
  Points<Dim> Positions; ///< Dim x n
  Points<Dim> Normals;   ///< Dim x n, unit length, towards f > 0; a zero column has no gradient row
  Vector Weights;        ///< n, >= 0; empty: 1
  /// n, > 0, in units of the fairing weights: the fairing near a point counts so many times, by way
  /// of rows that weigh so much less; empty: 1
  Vector LocalFairing;

  Points<Dim> ExtraPositions; ///< Dim x m: points ...
  Vector ExtraValues;         ///< ... where f shall take these values ...
  Vector ExtraWeights;        ///< ... with these weights; empty: 1
};

/// A point, an extra row, or the mean of a cluster.
template <int Dim>
struct Sample
{
  std::uint64_t Key;   ///< Morton code of its sub-cell
  Point<Dim> Position; ///< in cells of the finest lattice
  Point<Dim> Normal;
  float Value;
  float Weight;
  float Fairing;
  bool HasNormal;
  bool IsExtra; ///< not one of the points that the surface goes through
};

template <int Dim>
using Samples = BulkVector<Sample<Dim>>;

template <int Dim>
double numberOfNormals(const Samples<Dim>& samples)
{
  return static_cast<double>(std::count_if(
    samples.begin(), samples.end(), [](const Sample<Dim>& sample) { return sample.HasNormal; }));
}

/// Sub-cells per knot cell of the finest lattice and axis, as a power of two.
constexpr int SubCellBits = 3;

/// All rows in the Morton order of their sub-cells, which nests those of all coarser lattices.
///
/// @param source  on request the row that each sample was: points first, then extra rows
template <int Dim>
Samples<Dim> sortedSamples(const Lattice<Dim>& lattice, const HermiteInput<Dim>& input, int threads,
  std::vector<std::int64_t>* source = nullptr);

/// Means of the samples that share a sub-cell @a halvings coarser than those of the finest lattice.
template <int Dim>
Samples<Dim> cluster(const Samples<Dim>& samples, int halvings, int threads);
}

#endif
