// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Four rows of four coefficients as one value, held in the widest registers that a machine has.
 *
 * OneRegister and TwoRegisters have the same operations, so that the row kernel is written once.
 */
#ifndef ipia_RowRegisters_h
#define ipia_RowRegisters_h

#include "Dispatch.h"

#include <cstring>

namespace ipia
{
using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Float16 = float __attribute__((vector_size(64)));

/// Four rows of four coefficients, where registers hold sixteen.
struct OneRegister
{
  Float16 V;

  static IPIA_INLINE OneRegister zero() { return { Float16{} }; }

  /// Row j at from + 8 j. Reads up to from + 31.
  static IPIA_INLINE OneRegister load(const float* from)
  {
    Float16 low, high;
    std::memcpy(&low, from, sizeof(low));
    std::memcpy(&high, from + 16, sizeof(high));
    return { __builtin_shufflevector(
      low, high, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27) };
  }

  /// Adds row j to what is at to + 8 j. Touches, but leaves, the rest up to to + 31.
  IPIA_INLINE void addTo(float* to) const
  {
    Float16 low, high;
    std::memcpy(&low, to, sizeof(low));
    std::memcpy(&high, to + 16, sizeof(high));
    const Float16 none{};
    low += __builtin_shufflevector(
      this->V, none, 0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23);
    high += __builtin_shufflevector(
      this->V, none, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15, 20, 21, 22, 23);
    std::memcpy(to, &low, sizeof(low));
    std::memcpy(to + 16, &high, sizeof(high));
  }

  IPIA_INLINE Float4 row(int j) const
  {
    const Float8 half = j < 2
      ? __builtin_shufflevector(this->V, this->V, 0, 1, 2, 3, 4, 5, 6, 7)
      : __builtin_shufflevector(this->V, this->V, 8, 9, 10, 11, 12, 13, 14, 15);
    return j % 2 == 0 ? __builtin_shufflevector(half, half, 0, 1, 2, 3)
                      : __builtin_shufflevector(half, half, 4, 5, 6, 7);
  }

  /// v in every row. In steps that double a vector: GCC 12 takes a wider step through memory.
  static IPIA_INLINE OneRegister rows(const Float4& v)
  {
    const Float8 two = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
    return { __builtin_shufflevector(
      two, two, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) };
  }

  /// v[j] all over row j.
  static IPIA_INLINE OneRegister columns(const Float4& v)
  {
    const Float16 four = rows(v).V;
    return { __builtin_shufflevector(four, four, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3) };
  }

  /// The sum of the rows of a, b, c and a once more, as four rows.
  static IPIA_INLINE OneRegister sumsOfRows(
    const OneRegister& a, const OneRegister& b, const OneRegister& c)
  {
    const Float16 ab =
      __builtin_shufflevector(a.V, b.V, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23) +
      __builtin_shufflevector(
        a.V, b.V, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
    const Float16 ca =
      __builtin_shufflevector(c.V, a.V, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23) +
      __builtin_shufflevector(
        c.V, a.V, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
    return { __builtin_shufflevector(
               ab, ca, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27) +
      __builtin_shufflevector(ab, ca, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31) };
  }

  /// The sum of each row all over it.
  IPIA_INLINE OneRegister sumsInRows() const
  {
    const Float16 two = this->V +
      __builtin_shufflevector(
        this->V, this->V, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
    return { two +
      __builtin_shufflevector(two, two, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14) };
  }

  /// Row j in every row.
  template <int J>
  IPIA_INLINE OneRegister everyRow() const
  {
    constexpr int k = 4 * J;
    return { __builtin_shufflevector(this->V, this->V, k, k + 1, k + 2, k + 3, k, k + 1, k + 2,
      k + 3, k, k + 1, k + 2, k + 3, k, k + 1, k + 2, k + 3) };
  }

  /// v in the first three rows, last in the fourth.
  static IPIA_INLINE OneRegister threeAndOne(const Float4& v, const Float4& last)
  {
    const Float8 two = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
    const Float8 end = __builtin_shufflevector(v, last, 0, 1, 2, 3, 4, 5, 6, 7);
    return { __builtin_shufflevector(
      two, end, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) };
  }

  friend IPIA_INLINE OneRegister operator*(const OneRegister& a, const OneRegister& b)
  {
    return { a.V * b.V };
  }
  friend IPIA_INLINE OneRegister operator+(const OneRegister& a, const OneRegister& b)
  {
    return { a.V + b.V };
  }
  friend IPIA_INLINE OneRegister operator-(const OneRegister& a, const OneRegister& b)
  {
    return { a.V - b.V };
  }
  friend IPIA_INLINE OneRegister operator*(float a, const OneRegister& b) { return { a * b.V }; }
  IPIA_INLINE void operator+=(const OneRegister& other) { this->V += other.V; }
};

/// The same where they hold eight.
struct TwoRegisters
{
  Float8 V[2];

  static IPIA_INLINE TwoRegisters zero() { return { { Float8{}, Float8{} } }; }

  static IPIA_INLINE TwoRegisters load(const float* from)
  {
    TwoRegisters loaded;
    for (int half = 0; half < 2; ++half)
    {
      Float4 a, b;
      std::memcpy(&a, from + 16 * half, sizeof(Float4));
      std::memcpy(&b, from + 16 * half + 8, sizeof(Float4));
      loaded.V[half] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    return loaded;
  }

  IPIA_INLINE void addTo(float* to) const
  {
    for (int j = 0; j < 4; ++j)
    {
      Float4 total;
      std::memcpy(&total, to + 8 * j, sizeof(total));
      total += this->row(j);
      std::memcpy(to + 8 * j, &total, sizeof(total));
    }
  }

  IPIA_INLINE Float4 row(int j) const
  {
    const Float8& half = this->V[j / 2];
    return j % 2 == 0 ? __builtin_shufflevector(half, half, 0, 1, 2, 3)
                      : __builtin_shufflevector(half, half, 4, 5, 6, 7);
  }

  static IPIA_INLINE TwoRegisters rows(const Float4& v)
  {
    const Float8 two = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
    return { { two, two } };
  }

  static IPIA_INLINE TwoRegisters columns(const Float4& v)
  {
    const Float8 two = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
    return { { __builtin_shufflevector(two, two, 0, 0, 0, 0, 5, 5, 5, 5),
      __builtin_shufflevector(two, two, 2, 2, 2, 2, 7, 7, 7, 7) } };
  }

  static IPIA_INLINE TwoRegisters sumsOfRows(
    const TwoRegisters& a, const TwoRegisters& b, const TwoRegisters& c)
  {
    const Float8 a2 = a.V[0] + a.V[1], b2 = b.V[0] + b.V[1], c2 = c.V[0] + c.V[1];
    return { { __builtin_shufflevector(a2, b2, 0, 1, 2, 3, 8, 9, 10, 11) +
        __builtin_shufflevector(a2, b2, 4, 5, 6, 7, 12, 13, 14, 15),
      __builtin_shufflevector(c2, a2, 0, 1, 2, 3, 8, 9, 10, 11) +
        __builtin_shufflevector(c2, a2, 4, 5, 6, 7, 12, 13, 14, 15) } };
  }

  IPIA_INLINE TwoRegisters sumsInRows() const
  {
    TwoRegisters sums;
    for (int half = 0; half < 2; ++half)
    {
      const Float8& v = this->V[half];
      const Float8 two = v + __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5);
      sums.V[half] = two + __builtin_shufflevector(two, two, 1, 0, 3, 2, 5, 4, 7, 6);
    }
    return sums;
  }

  template <int J>
  IPIA_INLINE TwoRegisters everyRow() const
  {
    constexpr int k = 4 * (J % 2);
    const Float8& v = this->V[J / 2];
    const Float8 two =
      __builtin_shufflevector(v, v, k, k + 1, k + 2, k + 3, k, k + 1, k + 2, k + 3);
    return { { two, two } };
  }

  static IPIA_INLINE TwoRegisters threeAndOne(const Float4& v, const Float4& last)
  {
    return { { __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7),
      __builtin_shufflevector(v, last, 0, 1, 2, 3, 4, 5, 6, 7) } };
  }

  friend IPIA_INLINE TwoRegisters operator*(const TwoRegisters& a, const TwoRegisters& b)
  {
    return { { a.V[0] * b.V[0], a.V[1] * b.V[1] } };
  }
  friend IPIA_INLINE TwoRegisters operator+(const TwoRegisters& a, const TwoRegisters& b)
  {
    return { { a.V[0] + b.V[0], a.V[1] + b.V[1] } };
  }
  friend IPIA_INLINE TwoRegisters operator-(const TwoRegisters& a, const TwoRegisters& b)
  {
    return { { a.V[0] - b.V[0], a.V[1] - b.V[1] } };
  }
  friend IPIA_INLINE TwoRegisters operator*(float a, const TwoRegisters& b)
  {
    return { { a * b.V[0], a * b.V[1] } };
  }
  IPIA_INLINE void operator+=(const TwoRegisters& other)
  {
    this->V[0] += other.V[0];
    this->V[1] += other.V[1];
  }
};
}

#endif
