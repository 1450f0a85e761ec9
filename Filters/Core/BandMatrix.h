// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Square band matrices, also those of closed curves, whose bands go round the corners.
 */
#ifndef ipia_BandMatrix_h
#define ipia_BandMatrix_h

#include "Types.h"

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace ipia
{
/**
 * A Size x Size matrix whose row i has entries in the columns i - HalfWidth to i + HalfWidth,
 * modulo Size if Wraps. Stored by diagonals. Where Size < 2 HalfWidth + 1 and the matrix wraps, two
 * diagonals can share a column; their entries add up.
 */
struct BandMatrix
{
  std::int64_t Size = 0;
  int HalfWidth = 0;
  bool Wraps = false;
  std::vector<double> Entries; ///< (2 HalfWidth + 1) x Size, the lowest diagonal first

  BandMatrix() = default;
  BandMatrix(std::int64_t size, int halfWidth, bool wraps)
    : Size(size)
    , HalfWidth(halfWidth)
    , Wraps(wraps)
    , Entries(static_cast<std::size_t>((2 * halfWidth + 1) * size))
  {
  }

  /// Entry of row i on diagonal @a offset, -HalfWidth <= offset <= HalfWidth.
  double& at(std::int64_t i, int offset)
  {
    return this->Entries[static_cast<std::size_t>((offset + this->HalfWidth) * this->Size + i)];
  }
  double at(std::int64_t i, int offset) const
  {
    return this->Entries[static_cast<std::size_t>((offset + this->HalfWidth) * this->Size + i)];
  }

  /// The column of row i on diagonal @a offset, or -1 where the band ends.
  std::int64_t column(std::int64_t i, int offset) const
  {
    std::int64_t j = i + offset;
    if (this->Wraps)
    {
      j %= this->Size;
      return j < 0 ? j + this->Size : j;
    }
    return j < 0 || j >= this->Size ? -1 : j;
  }

  /// y += A x, both of length Size.
  void addProduct(const double* x, double* y) const
  {
    for (int offset = -this->HalfWidth; offset <= this->HalfWidth; ++offset)
    {
      const double* __restrict diagonal =
        &this->Entries[static_cast<std::size_t>((offset + this->HalfWidth) * this->Size)];
      const std::int64_t begin = std::min<std::int64_t>(std::max(-offset, 0), this->Size);
      const std::int64_t end = std::max(begin, this->Size - std::max(offset, 0));
      const double* __restrict from = x + offset;
      double* __restrict to = y;
#pragma omp simd
      for (std::int64_t i = begin; i < end; ++i)
      {
        to[i] += diagonal[i] * from[i];
      }
      if (this->Wraps)
      {
        for (std::int64_t i = 0; i < begin; ++i)
        {
          y[i] += diagonal[i] * x[this->column(i, offset)];
        }
        for (std::int64_t i = end; i < this->Size; ++i)
        {
          y[i] += diagonal[i] * x[this->column(i, offset)];
        }
      }
    }
  }

  Eigen::MatrixXd toDense() const
  {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(this->Size, this->Size);
    for (std::int64_t i = 0; i < this->Size; ++i)
    {
      for (int offset = -this->HalfWidth; offset <= this->HalfWidth; ++offset)
      {
        const std::int64_t j = this->column(i, offset);
        if (j >= 0)
        {
          dense(i, j) += this->at(i, offset);
        }
      }
    }
    return dense;
  }
};
}

#endif
