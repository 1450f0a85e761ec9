// SPDX-License-Identifier: BSD-3-Clause
#include "BrickOperator.h"

#include "Dispatch.h"
#include "Parallel.h"

#include <cstring>

namespace ipia
{
namespace
{
using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Float16 = float __attribute__((vector_size(64)));

/// Four rows of four coefficients, where registers hold sixteen.
struct OneRegister
{
  Float16 V;

  static IPIA_INLINE OneRegister zero() { return { Float16{} }; }

  /// Row j at from + j * stride.
  static IPIA_INLINE OneRegister load(const float* from, int stride)
  {
    Float4 r[4];
    for (int j = 0; j < 4; ++j)
    {
      std::memcpy(&r[j], from + j * stride, sizeof(Float4));
    }
    const Float8 low = __builtin_shufflevector(r[0], r[1], 0, 1, 2, 3, 4, 5, 6, 7);
    const Float8 high = __builtin_shufflevector(r[2], r[3], 0, 1, 2, 3, 4, 5, 6, 7);
    return { __builtin_shufflevector(
      low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) };
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

  static IPIA_INLINE TwoRegisters load(const float* from, int stride)
  {
    TwoRegisters loaded;
    for (int half = 0; half < 2; ++half)
    {
      Float4 a, b;
      std::memcpy(&a, from + 2 * half * stride, sizeof(Float4));
      std::memcpy(&b, from + (2 * half + 1) * stride, sizeof(Float4));
      loaded.V[half] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    return loaded;
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

// The cubic basis and its derivative as polynomials in t, one lane a basis function.
constexpr Float4 Basis0 = { 1.F / 6, 4.F / 6, 1.F / 6, 0 };
constexpr Float4 Basis1 = { -.5F, 0, .5F, 0 };
constexpr Float4 Basis2 = { .5F, -1, .5F, 0 };
constexpr Float4 Basis3 = { -1.F / 6, .5F, -.5F, 1.F / 6 };

/// Basis functions and derivatives at the local coordinates t[a] of a row, four per axis.
template <typename Wide>
struct RowBasis
{
  alignas(64) float Value[16];
  alignas(64) float Slope[16];

  /// @param t       four floats, as many of which count as there are axes
  /// @param squared both are squared
  IPIA_INLINE RowBasis(const float* t, bool squared)
  {
    Float4 four;
    std::memcpy(&four, t, sizeof(four));
    const Wide u = Wide::columns(four), b1 = Wide::rows(Basis1), b2 = Wide::rows(Basis2),
               b3 = Wide::rows(Basis3);
    Wide value = Wide::rows(Basis0) + u * (b1 + u * (b2 + u * b3));
    Wide slope = b1 + u * (2.F * b2 + 3.F * (u * b3));
    if (squared)
    {
      value = value * value;
      slope = slope * slope;
    }
    std::memcpy(this->Value, &value, sizeof(value));
    std::memcpy(this->Slope, &slope, sizeof(slope));
  }

  static IPIA_INLINE Float4 axis(const float* from, int a)
  {
    Float4 v;
    std::memcpy(&v, from + 4 * a, sizeof(v));
    return v;
  }
};

template <int Dim>
constexpr int ChildCount = 1 << Dim;

/// What the rows of a brick are swept for.
enum class Sweep
{
  Residual,     // A^T W (b - A c)
  Product,      // A^T W A p
  Diagonal,     // diag(A^T W A)
  Density,      // B^T w
  Value,        // f at the rows
  ValueAndSlope // f and its derivatives at the rows
};

template <int Dim>
struct BrickArguments
{
  const HermiteRow<Dim>* Begin;
  const HermiteRow<Dim>* End;
  /// The bricks of the window: this one and its upper neighbours; nullptr where there is none.
  std::array<const float*, ChildCount<Dim>> Input;
  std::array<float*, ChildCount<Dim>> Output;
  std::array<float, Dim> AxisScale;
  float* Values; // of the evaluating sweeps
};

/// Calls action(window offset, brick index, offset in the brick) for every row of four
/// coefficients.
template <int Dim, typename Action>
IPIA_INLINE void forWindowRows(const Action& action)
{
  for (int child = 0; child < ChildCount<Dim>; ++child)
  {
    const int corner =
      BrickWidth * ((child & 1) + WindowWidth * ((child >> 1 & 1) + WindowWidth * (child >> 2)));
    for (int z = 0; z < (Dim == 3 ? BrickWidth : 1); ++z)
    {
      for (int y = 0; y < BrickWidth; ++y)
      {
        action(
          corner + WindowWidth * (y + WindowWidth * z), child, BrickWidth * (y + BrickWidth * z));
      }
    }
  }
}

template <int Dim, Sweep Kind, typename Wide>
struct RowKernel
{
  static IPIA_INLINE void run(const BrickArguments<Dim>& arguments)
  {
    constexpr int slices = Dim == 3 ? Order : 1;
    constexpr bool gather = Kind != Sweep::Diagonal && Kind != Sweep::Density;
    constexpr bool scatter = Kind != Sweep::Value && Kind != Sweep::ValueAndSlope;
    constexpr int sliceSize = WindowWidth * WindowWidth;
    alignas(64) float in[WindowSize<Dim>];
    alignas(64) float out[WindowSize<Dim>];
    if (gather)
    {
      forWindowRows<Dim>(
        [&](int window, int child, int offset)
        {
          const float* from = arguments.Input[static_cast<std::size_t>(child)];
          Float4 row{};
          if (from)
          {
            std::memcpy(&row, from + offset, sizeof(row));
          }
          std::memcpy(in + window, &row, sizeof(row));
        });
    }
    if (scatter)
    {
      std::memset(out, 0, sizeof(out));
    }
    // Value, y, z and x derivative of a row have one row of lanes each; which weight counts there.
    Float4 ofGradient{};
    ofGradient[3] = arguments.AxisScale[0];
    ofGradient[1] = arguments.AxisScale[1];
    ofGradient[2] = Dim == 3 ? arguments.AxisScale[Dim - 1] : 0.F;
    const Wide valueScale = Wide::columns(Float4{ 1, 0, 0, 0 });
    const Wide gradientScale = Kind == Sweep::Density ? Wide::zero() : Wide::columns(ofGradient);

    for (auto row = arguments.Begin; row != arguments.End;)
    {
      const std::int32_t cell = row->Cell;
      const int corner = (cell & 3) + WindowWidth * ((cell >> 2 & 3) + WindowWidth * (cell >> 4));
      Wide c[slices], add[slices];
      for (int k = 0; k < slices; ++k)
      {
        add[k] = Wide::zero();
        if (gather)
        {
          c[k] = Wide::load(in + corner + k * sliceSize, WindowWidth);
        }
      }
      for (; row != arguments.End && row->Cell == cell; ++row)
      {
        const RowBasis<Wide> basis(row->T.data(), Kind == Sweep::Diagonal);
        const Float4 x = basis.axis(basis.Value, 0), dx = basis.axis(basis.Slope, 0);
        const Wide yy = Wide::columns(basis.axis(basis.Value, 1));
        const Wide dyy = Wide::columns(basis.axis(basis.Slope, 1));
        constexpr float one[1] = { 1 }, none[1] = { 0 };
        const float* z = Dim == 3 ? basis.Value + 8 : one;
        const float* dz = Dim == 3 ? basis.Slope + 8 : none;
        const Wide along = Wide::threeAndOne(x, dx);
        Wide r = row->Weight * valueScale + row->GradientWeight * gradientScale;
        if (gather)
        {
          Wide g = z[0] * c[0], gz = dz[0] * c[0];
          for (int k = 1; k < slices; ++k)
          {
            g += z[k] * c[k];
            gz += dz[k] * c[k];
          }
          const Wide f = (Wide::sumsOfRows(g * yy, g * dyy, gz * yy) * along).sumsInRows();
          if (!scatter)
          {
            float* at = arguments.Values +
              static_cast<std::int64_t>(row->Source) * (Kind == Sweep::Value ? 1 : 1 + Dim);
            at[0] = f.row(0)[0];
            if (Kind == Sweep::ValueAndSlope)
            {
              at[1] = f.row(3)[0];
              at[2] = f.row(1)[0];
              if (Dim == 3)
              {
                at[Dim] = f.row(2)[0];
              }
            }
            continue;
          }
          if (Kind == Sweep::Residual)
          {
            Float4 target;
            std::memcpy(&target, &row->Value, sizeof(target));
            target = __builtin_shufflevector(target, target, 0, 2, 3, 1);
            r = r * (Wide::columns(target) - f);
          }
          else
          {
            r = r * f;
          }
        }
        r = r * along;
        Wide s = yy * (r.template everyRow<0>() + r.template everyRow<3>());
        s += dyy * r.template everyRow<1>();
        const Wide t = yy * r.template everyRow<2>();
        for (int k = 0; k < slices; ++k)
        {
          add[k] += z[k] * s;
          if (Dim == 3)
          {
            add[k] += dz[k] * t;
          }
        }
      }
      if (scatter)
      {
        for (int k = 0; k < slices; ++k)
        {
          float* at = out + corner + k * sliceSize;
          for (int j = 0; j < Order; ++j)
          {
            Float4 total;
            std::memcpy(&total, at + j * WindowWidth, sizeof(total));
            total += add[k].row(j);
            std::memcpy(at + j * WindowWidth, &total, sizeof(total));
          }
        }
      }
    }

    if (scatter)
    {
      forWindowRows<Dim>(
        [&](int window, int child, int offset)
        {
          float* to = arguments.Output[static_cast<std::size_t>(child)];
          if (to)
          {
            Float4 total, part;
            std::memcpy(&total, to + offset, sizeof(total));
            std::memcpy(&part, out + window, sizeof(part));
            total += part;
            std::memcpy(to + offset, &total, sizeof(total));
          }
        });
    }
  }
};

/// The second and fourth difference operators of one axis at the ends of the lattice: row i of
/// K1 = D1^T D1 and K2 = D2^T D2 with differences that leave the lattice left out.
struct EndStencils
{
  std::array<float, 3> First;
  std::array<float, 5> Second;

  EndStencils(std::int64_t i, std::int64_t n)
    : First{}
    , Second{}
  {
    const auto inside = [n](std::int64_t k) { return k >= 0 && k < n; };
    // Difference d joins coefficients d and d + 1.
    for (std::int64_t d = i - 1; d <= i; ++d)
    {
      if (inside(d) && inside(d + 1))
      {
        this->First[1] += 1;
        this->First[d == i ? 2 : 0] -= 1;
      }
    }
    // Second difference r is centred at coefficient r.
    constexpr std::array<float, 3> mask{ 1, -2, 1 };
    for (std::int64_t r = i - 1; r <= i + 1; ++r)
    {
      if (inside(r - 1) && inside(r + 1))
      {
        for (std::int64_t k = -1; k <= 1; ++k)
        {
          this->Second[static_cast<std::size_t>(r + k - i + 2)] +=
            mask[static_cast<std::size_t>(i - r + 1)] * mask[static_cast<std::size_t>(k + 1)];
        }
      }
    }
  }
};

template <int Dim>
struct FairingArguments
{
  /// The bricks around this one, nullptr where there is none.
  std::array<const float*, BrickLattice<Dim>::NeighbourCount> Input;
  float* Output;
  Index<Dim> First; ///< the first coefficient of the brick
  Index<Dim> Size;  ///< of the lattice
  std::array<float, Dim> AxisScale;
  FairingWeights Weights;
  float Sign;
};

/// output = sign * (tau_2 K_thinplate + tau_1 K_membrane) input on one brick.
template <int Dim>
struct FairingKernel
{
  static IPIA_INLINE void run(const FairingArguments<Dim>& arguments)
  {
    // The brick with a rim of two coefficients on every side.
    constexpr int slices = Dim == 3 ? WindowWidth : 1;
    alignas(64) float in[WindowSize<Dim>];
    for (int z = 0; z < slices; ++z)
    {
      for (int y = 0; y < WindowWidth; ++y)
      {
        const int brickY = (y + 2) / BrickWidth, brickZ = Dim == 3 ? (z + 2) / BrickWidth : 0;
        const int rowZ = Dim == 3 ? (z + 2) % BrickWidth : 0;
        const int inBrick = BrickWidth * ((y + 2) % BrickWidth + BrickWidth * rowZ);
        const auto row = static_cast<std::size_t>(3 * brickY + 9 * brickZ);
        float* to = in + WindowWidth * (y + WindowWidth * z);
        const float *low = arguments.Input[row], *middle = arguments.Input[row + 1],
                    *high = arguments.Input[row + 2];
        to[0] = low ? low[inBrick + 2] : 0.F;
        to[1] = low ? low[inBrick + 3] : 0.F;
        for (int x = 0; x < BrickWidth; ++x)
        {
          to[2 + x] = middle ? middle[inBrick + x] : 0.F;
        }
        to[6] = high ? high[inBrick] : 0.F;
        to[7] = high ? high[inBrick + 1] : 0.F;
      }
    }
    bool interior = true;
    for (int a = 0; a < Dim; ++a)
    {
      interior = interior && arguments.First[a] >= 2 &&
        arguments.First[a] + BrickWidth + 2 <= arguments.Size[a];
    }
    if (interior)
    {
      runInside(arguments, in);
    }
    else
    {
      runAtBorder(arguments, in);
    }
  }

private:
  static constexpr std::array<int, 3> Stride{ 1, WindowWidth, WindowWidth* WindowWidth };

  /// Inside the lattice the thin plate is the square of the membrane L = sum_a s_a^2 K1_a.
  static IPIA_INLINE void runInside(const FairingArguments<Dim>& arguments, const float* in)
  {
    const auto& scale = arguments.AxisScale;
    float centre = 0;
    for (int a = 0; a < Dim; ++a)
    {
      centre += 2 * scale[a];
    }
    alignas(64) float once[WindowSize<Dim>];
    constexpr int firstSlice = Dim == 3 ? 1 : 0, lastSlice = Dim == 3 ? 7 : 1;
    for (int z = firstSlice; z < lastSlice; ++z)
    {
      // Whole rows at once; the wrapped values at their ends are not used.
      const float* p = in + WindowWidth * (WindowWidth * z + 1);
      float* q = once + WindowWidth * (WindowWidth * z + 1);
      for (int i = 1; i < 6 * WindowWidth - 1; ++i)
      {
        float v = centre * p[i] - scale[0] * (p[i - 1] + p[i + 1]) -
          scale[1] * (p[i - WindowWidth] + p[i + WindowWidth]);
        if (Dim == 3)
        {
          v -= scale[Dim - 1] * (p[i - Stride[2]] + p[i + Stride[2]]);
        }
        q[i] = v;
      }
    }
    const float plate = arguments.Sign * arguments.Weights.ThinPlate;
    const float membrane = arguments.Sign * arguments.Weights.Membrane;
    for (int z = 0; z < (Dim == 3 ? BrickWidth : 1); ++z)
    {
      for (int y = 0; y < BrickWidth; ++y)
      {
        const float* p = once + 2 + WindowWidth * (y + 2 + (Dim == 3 ? WindowWidth * (z + 2) : 0));
        float* out = arguments.Output + BrickWidth * (y + BrickWidth * z);
        for (int x = 0; x < BrickWidth; ++x)
        {
          float v = centre * p[x] - scale[0] * (p[x - 1] + p[x + 1]) -
            scale[1] * (p[x - WindowWidth] + p[x + WindowWidth]);
          if (Dim == 3)
          {
            v -= scale[Dim - 1] * (p[x - Stride[2]] + p[x + Stride[2]]);
          }
          out[x] = plate * v + membrane * p[x];
        }
      }
    }
  }

  static void runAtBorder(const FairingArguments<Dim>& arguments, const float* in)
  {
    const float plate = arguments.Sign * arguments.Weights.ThinPlate;
    const float membrane = arguments.Sign * arguments.Weights.Membrane;
    for (int k = 0; k < BrickSize<Dim>; ++k)
    {
      std::array<int, 3> local{ k & 3, k >> 2 & 3, k >> 4 };
      const float* p = in + 2 + local[0] + WindowWidth * (local[1] + 2);
      p += Dim == 3 ? WindowWidth * WindowWidth * (local[2] + 2) : 0;
      float plateSum = 0, membraneSum = 0;
      std::array<std::array<float, 3>, Dim> first;
      bool inside = true;
      for (int a = 0; a < Dim; ++a)
      {
        const std::int64_t i = arguments.First[a] + local[static_cast<std::size_t>(a)];
        inside = inside && i < arguments.Size[a];
        const EndStencils stencils(i, arguments.Size[a]);
        const int stride = Stride[static_cast<std::size_t>(a)];
        const float s = arguments.AxisScale[a];
        first[a] = stencils.First;
        for (int d = -2; d <= 2; ++d)
        {
          plateSum += s * s * stencils.Second[static_cast<std::size_t>(d + 2)] * p[d * stride];
        }
        for (int d = -1; d <= 1; ++d)
        {
          membraneSum += s * stencils.First[static_cast<std::size_t>(d + 1)] * p[d * stride];
        }
      }
      for (int a = 0; a < Dim; ++a)
      {
        for (int b = a + 1; b < Dim; ++b)
        {
          const float s = 2 * arguments.AxisScale[a] * arguments.AxisScale[b];
          for (int d = -1; d <= 1; ++d)
          {
            for (int e = -1; e <= 1; ++e)
            {
              plateSum += s * first[a][static_cast<std::size_t>(d + 1)] *
                first[b][static_cast<std::size_t>(e + 1)] *
                p[d * Stride[static_cast<std::size_t>(a)] +
                  e * Stride[static_cast<std::size_t>(b)]];
            }
          }
        }
      }
      arguments.Output[k] = inside ? plate * plateSum + membrane * membraneSum : 0.F;
    }
  }
};
}

template <int Dim>
BrickOperator<Dim>::BrickOperator(const BrickLattice<Dim>& bricks, const HermiteRows<Dim>& rows,
  const FairingWeights& fairing, int threads)
  : Bricks(bricks)
  , Rows(rows)
  , Fairing(fairing)
  , Threads(threads)
{
  const Point<Dim>& h = bricks.lattice().Spacing;
  for (int a = 0; a < Dim; ++a)
  {
    const double s = h.mean() / h[a];
    this->AxisScale[a] = static_cast<float>(s * s);
  }
}

template <int Dim>
template <int Kind>
void BrickOperator<Dim>::sweepRows(
  const float* input, std::int32_t inputBricks, float* output) const
{
  // Offsets 0 and 1 per axis among the neighbours' -1, 0, 1.
  std::array<std::size_t, ChildCount<Dim>> upper;
  for (std::size_t child = 0; child < upper.size(); ++child)
  {
    upper[child] = 0;
    for (int a = 0, power = 1; a < Dim; ++a, power *= 3)
    {
      upper[child] += static_cast<std::size_t>(power) * (1 + (child >> a & 1));
    }
  }
#pragma omp parallel num_threads(this->Threads)
  for (std::size_t colour = 0; colour < HermiteRows<Dim>::NumberOfColours; ++colour)
  {
    const auto first = static_cast<std::int64_t>(this->Rows.ColourBegin[colour]);
    const auto last = static_cast<std::int64_t>(this->Rows.ColourBegin[colour + 1]);
#pragma omp for schedule(dynamic, 32)
    for (std::int64_t b = first; b < last; ++b)
    {
      const auto& brick = this->Rows.Bricks[static_cast<std::size_t>(b)];
      const auto& neighbours = this->Bricks.neighbours(brick.Id);
      BrickArguments<Dim> arguments;
      arguments.Begin = this->Rows.Rows.data() + brick.Begin;
      arguments.End = this->Rows.Rows.data() + brick.End;
      arguments.AxisScale = this->AxisScale;
      arguments.Values = output;
      for (std::size_t child = 0; child < upper.size(); ++child)
      {
        const std::int32_t id = neighbours[upper[child]];
        const std::int64_t at = static_cast<std::int64_t>(id) * BrickSize<Dim>;
        arguments.Input[child] =
          id != BrickLattice<Dim>::Absent && id < inputBricks ? input + at : nullptr;
        arguments.Output[child] =
          id != BrickLattice<Dim>::Absent && id < this->Bricks.numberOfActiveBricks() ? output + at
                                                                                      : nullptr;
      }
      constexpr auto kind = static_cast<Sweep>(Kind);
      dispatchByWidth<RowKernel<Dim, kind, OneRegister>, RowKernel<Dim, kind, TwoRegisters>>(
        arguments);
    }
  }
}

template <int Dim>
void BrickOperator<Dim>::applyFairing(
  const float* input, std::int32_t inputBricks, float sign, std::vector<float>& output) const
{
  const std::int32_t active = this->Bricks.numberOfActiveBricks();
  output.resize(static_cast<std::size_t>(active) * BrickSize<Dim>);
#pragma omp parallel for schedule(static) num_threads(this->Threads)
  for (std::int32_t b = 0; b < active; ++b)
  {
    float* out = output.data() + static_cast<std::int64_t>(b) * BrickSize<Dim>;
    if (!this->Fairing.any())
    {
      std::memset(out, 0, BrickSize<Dim> * sizeof(float));
      continue;
    }
    FairingArguments<Dim> arguments;
    arguments.Output = out;
    arguments.Size = this->Bricks.lattice().Size;
    arguments.AxisScale = this->AxisScale;
    arguments.Weights = this->Fairing;
    arguments.Sign = sign;
    for (int a = 0; a < Dim; ++a)
    {
      arguments.First[a] = this->Bricks.position(b)[a] * BrickWidth;
    }
    const auto& neighbours = this->Bricks.neighbours(b);
    for (std::size_t k = 0; k < neighbours.size(); ++k)
    {
      const std::int32_t id = neighbours[k];
      arguments.Input[k] = id != BrickLattice<Dim>::Absent && id < inputBricks
        ? input + static_cast<std::int64_t>(id) * BrickSize<Dim>
        : nullptr;
    }
    dispatch<FairingKernel<Dim>>(arguments);
  }
}

template <int Dim>
void BrickOperator<Dim>::residual(std::vector<float>& gradient) const
{
  const float* c = this->Bricks.coefficients().data();
  this->applyFairing(c, this->Bricks.numberOfBricks(), -1, gradient);
  this->sweepRows<static_cast<int>(Sweep::Residual)>(
    c, this->Bricks.numberOfBricks(), gradient.data());
}

template <int Dim>
void BrickOperator<Dim>::product(const std::vector<float>& p, std::vector<float>& product) const
{
  this->applyFairing(p.data(), this->Bricks.numberOfActiveBricks(), 1, product);
  this->sweepRows<static_cast<int>(Sweep::Product)>(
    p.data(), this->Bricks.numberOfActiveBricks(), product.data());
}

template <int Dim>
void BrickOperator<Dim>::diagonal(std::vector<float>& diagonal) const
{
  // Inside the lattice: (sum_a 2 s_a^2)^2 + sum_a 2 s_a^4 of the thin plate, sum_a 2 s_a^2 of the
  // membrane; at its border the exact values are smaller, which a preconditioner may ignore.
  float sum = 0, squares = 0;
  for (float s : this->AxisScale)
  {
    sum += 2 * s;
    squares += 2 * s * s;
  }
  const float fairing =
    this->Fairing.ThinPlate * (sum * sum + squares) + this->Fairing.Membrane * sum;
  diagonal.assign(
    static_cast<std::size_t>(this->Bricks.numberOfActiveBricks()) * BrickSize<Dim>, fairing);
  this->sweepRows<static_cast<int>(Sweep::Diagonal)>(nullptr, 0, diagonal.data());
}

template <int Dim>
double BrickOperator<Dim>::energy() const
{
  std::vector<float> values;
  this->evaluateWithGradient(this->Bricks.coefficients(), values);
  double sum = 0;
  for (const HermiteRow<Dim>& row : this->Rows.Rows)
  {
    const float* at = values.data() + static_cast<std::int64_t>(row.Source) * (1 + Dim);
    const double miss = at[0] - row.Value;
    sum += row.Weight * miss * miss;
    for (int a = 0; a < Dim; ++a)
    {
      const double slope = at[1 + a] - row.Slope[a];
      sum += static_cast<double>(row.GradientWeight) * this->AxisScale[a] * slope * slope;
    }
  }
  return sum;
}

template <int Dim>
void BrickOperator<Dim>::density(std::vector<float>& sums) const
{
  sums.assign(static_cast<std::size_t>(this->Bricks.numberOfActiveBricks()) * BrickSize<Dim>, 0.F);
  this->sweepRows<static_cast<int>(Sweep::Density)>(nullptr, 0, sums.data());
}

template <int Dim>
void BrickOperator<Dim>::evaluate(
  const std::vector<float>& coefficients, std::vector<float>& values) const
{
  values.resize(this->Rows.Rows.size());
  this->sweepRows<static_cast<int>(Sweep::Value)>(coefficients.data(),
    static_cast<std::int32_t>(coefficients.size() / BrickSize<Dim>), values.data());
}

template <int Dim>
void BrickOperator<Dim>::evaluateWithGradient(
  const std::vector<float>& coefficients, std::vector<float>& values) const
{
  values.resize(this->Rows.Rows.size() * (1 + Dim));
  this->sweepRows<static_cast<int>(Sweep::ValueAndSlope)>(coefficients.data(),
    static_cast<std::int32_t>(coefficients.size() / BrickSize<Dim>), values.data());
}

template class BrickOperator<2>;
template class BrickOperator<3>;
}
