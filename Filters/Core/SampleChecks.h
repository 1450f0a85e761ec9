// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Which samples contradict a coarse fit of all of them: outliers, and normals that are flipped.
 */
#ifndef ipia_SampleChecks_h
#define ipia_SampleChecks_h

#include "PointSamples.h"

#include <vector>

namespace ipia
{
/// A sample as the fit sees it.
struct SampleCheck
{
  float Distance = 0;  ///< from the zero set, knot spacings of the level, signed
  float Agreement = 1; ///< n . grad f / |grad f|; 1 for samples without a normal
};

/// What is wrong with a sample.
enum class SampleFault : char
{
  None,
  Outlier, ///< far from what the others agree on
  Flipped  ///< its normal points against the fit and those of its neighbours
};

struct SampleFaults
{
  std::vector<SampleFault> Faults; ///< of each sample; empty if there are none
  double Outliers = 0;             ///< number of outliers
  double Flipped = 0;              ///< number of flipped normals
};

/// What was found and corrected before: more of its kind is then searched for more closely.
struct EarlierFaults
{
  bool Outliers = false;
  bool Flipped = false;
  bool NoFlips = false; ///< turning normals did not help: no others are flipped either
};

/**
 * The faults of samples, given how they fit a level that they determine by far.
 *
 * An outlier is more than 1.5 knot spacings and four standard deviations, by the median, away from
 * the zero set, or, where there are some, hardly has neighbours and none that agree with it. A
 * normal is flipped if it points against the gradient of f and against the sum of the normals of
 * the samples around it, those about in its tangent plane: on parts too thin for the level the
 * gradient alone would accuse sound normals of one side. Where there are some, all normals are
 * compared with those around them. A few faults count for none.
 *
 * @param samples  sorted
 * @param checks   of each sample
 * @param earlier  what was found before
 */
template <int Dim>
SampleFaults findFaults(const Samples<Dim>& samples, const std::vector<SampleCheck>& checks,
  const EarlierFaults& earlier, int threads);
}

#endif
