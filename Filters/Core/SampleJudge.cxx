// SPDX-License-Identifier: BSD-3-Clause
#include "SampleJudge.h"

#include <algorithm>

namespace ipia
{
namespace
{
/// The fit starts again without faulty samples as long as there are some, but not more often.
constexpr int MostRepetitions = 4;
/// Turned normals show fewer others that are flipped, at most this share of those turned before:
/// where noise mixes the sides of thin parts it does not end.
constexpr double MostNewFlips = 0.3;
}

template <int Dim>
SampleJudge<Dim>::SampleJudge(const Samples<Dim>& samples, std::vector<std::int64_t> rows)
  : Rows(std::move(rows))
{
  this->Counts.Samples = static_cast<double>(samples.size());
  for (const Sample<Dim>& sample : samples)
  {
    this->Counts.Normals += sample.HasNormal;
  }
}

template <int Dim>
template <typename Action>
void SampleJudge<Dim>::forTurned(Samples<Dim>& samples, const Action& action) const
{
  for (std::size_t k = 0; k < this->Turned.size(); ++k)
  {
    if (this->Turned[k] != 0)
    {
      action(samples[k]);
    }
  }
}

template <int Dim>
void SampleJudge<Dim>::leaveOutAndTurn(const SampleFaults& faults, Samples<Dim>& samples)
{
  this->Turned.resize(samples.size(), 0);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    Sample<Dim> sample = samples[k];
    char turned = this->Turned[k];
    if (faults.Faults[k] == SampleFault::Outlier)
    {
      ++this->Counts.Outliers;
      this->Counts.Normals -= sample.HasNormal;
      this->Counts.Flipped -= turned;
      this->Outliers.push_back(sample);
      this->OutlierRows.push_back(this->Rows[k]);
      continue;
    }
    if (faults.Faults[k] == SampleFault::Flipped)
    {
      turned = turned == 0;
      this->Counts.Flipped += turned ? 1 : -1;
      sample.Normal = -sample.Normal;
    }
    this->Turned[kept] = turned;
    this->Rows[kept] = this->Rows[k];
    samples[kept++] = sample;
  }
  samples.resize(kept);
  this->Turned.resize(kept);
  this->Rows.resize(kept);
}

template <int Dim>
bool SampleJudge<Dim>::correct(
  Samples<Dim>& samples, const std::vector<SampleCheck>& checks, int threads)
{
  if (this->Done)
  {
    return false;
  }
  const SampleFaults faults = findFaults(samples, checks, this->Earlier, threads);
  EarlierFaults& earlier = this->Earlier;
  earlier.NoFlips =
    earlier.NoFlips || (earlier.Flipped && faults.Flipped > MostNewFlips * this->MostTurned);
  earlier.Flipped = !earlier.NoFlips && (earlier.Flipped || faults.Flipped > 0);
  earlier.Outliers = earlier.Outliers || faults.Outliers > 0;
  this->MostTurned = std::max(this->MostTurned, faults.Flipped);
  this->Done = faults.Outliers + faults.Flipped == 0 || this->Round++ >= MostRepetitions;
  if (this->Done)
  {
    this->Rows = {};
    this->forTurned(samples,
      [](Sample<Dim>& sample)
      {
        sample.Normal.setZero();
        sample.HasNormal = false;
      });
    return this->Counts.Flipped > 0;
  }
  this->leaveOutAndTurn(faults, samples);
  if (earlier.NoFlips)
  {
    this->forTurned(samples, [](Sample<Dim>& sample) { sample.Normal = -sample.Normal; });
    this->Turned.clear();
    this->Counts.Flipped = 0;
  }
  return true;
}

template <int Dim>
std::vector<std::int64_t> SampleJudge<Dim>::outlierRows() const
{
  std::vector<std::int64_t> rows = this->OutlierRows;
  std::sort(rows.begin(), rows.end());
  return rows;
}

template class SampleJudge<2>;
template class SampleJudge<3>;
}
