// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Loops and sums over threads whose results do not depend, bit for bit, on how many there are.
 */
#ifndef ipia_Parallel_h
#define ipia_Parallel_h

#include "Types.h"

#include <omp.h>

#include <algorithm>
#include <vector>

namespace ipia
{
/// The number of threads that a request means: 0 is OpenMP's own choice (OMP_NUM_THREADS).
inline int resolveThreads(int requested)
{
  return requested > 0 ? requested : omp_get_max_threads();
}

/// Coefficients that one task of a vector operation owns. A constant, so that sums are grouped
/// alike for any number of threads.
constexpr std::int64_t VectorChunk = 8192;

inline std::int64_t numberOfChunks(std::int64_t n)
{
  return (n + VectorChunk - 1) / VectorChunk;
}

/// Calls body(begin, end) for fixed chunks of [0, n).
template <typename Body>
void parallelChunks(std::int64_t n, int threads, const Body& body)
{
  const std::int64_t chunks = numberOfChunks(n);
  // Waking threads costs more than a chunk.
#pragma omp parallel for schedule(static) num_threads(chunks > 1 ? threads : 1)
  for (std::int64_t i = 0; i < chunks; ++i)
  {
    body(i * VectorChunk, std::min(n, (i + 1) * VectorChunk));
  }
}

/// Sum of body(begin, end) over fixed chunks of [0, n), added to @a sum in order.
template <typename Sum = double, typename Body>
Sum parallelSum(std::int64_t n, int threads, const Body& body, Sum sum = Sum{})
{
  std::vector<Sum> partial(static_cast<std::size_t>(numberOfChunks(n)), sum);
  parallelChunks(n, threads,
    [&](std::int64_t begin, std::int64_t end)
    { partial[static_cast<std::size_t>(begin / VectorChunk)] = body(begin, end); });
  for (const Sum& p : partial)
  {
    sum += p;
  }
  return sum;
}
}

#endif
