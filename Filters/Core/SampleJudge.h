// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Fits that start again without the samples that contradict them.
 */
#ifndef ipia_SampleJudge_h
#define ipia_SampleJudge_h

#include "SampleChecks.h"

namespace ipia
{
/// How many samples were faulty, of how many.
struct SampleFaultCounts
{
  double Samples = 0;
  double Outliers = 0;
  double Normals = 0; ///< of samples that are no outliers
  double Flipped = 0;

  double shareOfOutliers() const { return this->Outliers > 0 ? this->Outliers / this->Samples : 0; }
  double shareOfFlippedNormals() const
  {
    return this->Flipped > 0 ? this->Flipped / this->Normals : 0;
  }
};

/**
 * Judges samples by one fit of them after the other, see findFaults().
 *
 * In each round outliers go, and flipped normals are turned: with the others right, those that were
 * turned by mistake are turned back in the next one. In the end samples whose normals stayed turned
 * lose them. Where turning does not help, as noise mixes the sides of thin parts, all normals are
 * as they were.
 */
template <int Dim>
class SampleJudge
{
public:
  /// @param rows  of the input that the samples are
  SampleJudge(const Samples<Dim>& samples, std::vector<std::int64_t> rows);

  /// Whether the verdict is final; then samples need no checks.
  bool isDone() const { return this->Done; }

  /**
   * Corrects the samples that were fitted.
   *
   * @param samples  sorted, those of the constructor or as corrected before
   * @param checks   of each, by the fit
   * @return whether to fit again, as there were faults
   */
  bool correct(Samples<Dim>& samples, const std::vector<SampleCheck>& checks, int threads);

  const SampleFaultCounts& counts() const { return this->Counts; }
  Samples<Dim>& outliers() { return this->Outliers; }
  std::vector<std::int64_t> outlierRows() const; ///< ascending

private:
  void leaveOutAndTurn(const SampleFaults& faults, Samples<Dim>& samples);
  template <typename Action>
  void forTurned(Samples<Dim>& samples, const Action& action) const;

  std::vector<char> Turned; ///< for each sample that is left, whether its normal was; empty: none
  std::vector<std::int64_t> Rows; ///< of the samples that are left
  Samples<Dim> Outliers;
  std::vector<std::int64_t> OutlierRows;
  SampleFaultCounts Counts;
  EarlierFaults Earlier;
  double MostTurned = 0; ///< in one round
  int Round = 0;
  bool Done = false;
};
}

#endif
