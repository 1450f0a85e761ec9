// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The coefficients that rows touch. The others do not change without an energy of their own, and
 * are many: vector operations leave them out.
 */
#ifndef ipia_TouchedCoefficients_h
#define ipia_TouchedCoefficients_h

#include "ConstraintRows.h"
#include "Parallel.h"

#include <utility>

namespace ipia
{
/// Their numbers, as runs that make tasks of about VectorChunk coefficients, the same on any number
/// of threads.
class TouchedCoefficients
{
public:
  template <int Dim>
  explicit TouchedCoefficients(const ConstraintRows<Dim>& rows);

  std::int64_t numberOfTasks() const
  {
    return static_cast<std::int64_t>(this->TaskBegin.size()) - 1;
  }

  /// Calls body(begin, end) for all runs.
  template <typename Body>
  void forEach(int threads, const Body& body) const
  {
#pragma omp parallel for schedule(static) num_threads(threads)
    for (std::int64_t task = 0; task < this->numberOfTasks(); ++task)
    {
      this->run(task, body);
    }
  }

  /// Calls body(begin, end, partial) for all runs, partial being one of the task, at first
  /// @a initial; merges the partials in order.
  template <typename T, typename Body, typename Merge>
  T reduce(int threads, const T& initial, const Body& body, const Merge& merge) const
  {
    std::vector<T> partials(static_cast<std::size_t>(this->numberOfTasks()), initial);
#pragma omp parallel for schedule(static) num_threads(threads)
    for (std::int64_t task = 0; task < this->numberOfTasks(); ++task)
    {
      T& partial = partials[static_cast<std::size_t>(task)];
      this->run(task, [&](std::int64_t begin, std::int64_t end) { body(begin, end, partial); });
    }
    T result = initial;
    for (const T& partial : partials)
    {
      result = merge(result, partial);
    }
    return result;
  }

private:
  template <typename Body>
  void run(std::int64_t task, const Body& body) const
  {
    const auto t = static_cast<std::size_t>(task);
    for (std::size_t r = this->TaskBegin[t]; r < this->TaskBegin[t + 1]; ++r)
    {
      body(this->Runs[r].first, this->Runs[r].second);
    }
  }

  std::vector<std::pair<std::int64_t, std::int64_t>> Runs; // [first, second)
  std::vector<std::size_t> TaskBegin;                      // one more than there are tasks
};
}

#endif
