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

// The cubic basis and its derivative as polynomials in t, one lane a basis function.
constexpr Float4 Basis0 = { 1.F / 6, 4.F / 6, 1.F / 6, 0 };
constexpr Float4 Basis1 = { -.5F, 0, .5F, 0 };
constexpr Float4 Basis2 = { .5F, -1, .5F, 0 };
constexpr Float4 Basis3 = { -1.F / 6, .5F, -.5F, 1.F / 6 };

struct AxisBasis
{
  Float4 Value, Slope;
};

IPIA_INLINE void evaluateBasis(float t, Float4& value, Float4& slope)
{
  value = Basis0 + t * (Basis1 + t * (Basis2 + t * Basis3));
  slope = Basis1 + t * (2.F * Basis2 + (3.F * t) * Basis3);
}

// Four lanes to sixteen, in steps that double a vector: GCC 12 takes a wider step through memory
// and waits for it there.
#define IPIA_TWICE(v) __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7)
#define IPIA_REPEAT_ALL(v) \
  __builtin_shufflevector( \
    IPIA_TWICE(v), IPIA_TWICE(v), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#define IPIA_REPEAT_EACH(v) \
  __builtin_shufflevector(  \
    IPIA_REPEAT_ALL(v), IPIA_REPEAT_ALL(v), 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3)

IPIA_INLINE float sumOf(const Float16& v)
{
  const Float8 a = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7) +
    __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
  const Float4 b =
    __builtin_shufflevector(a, a, 0, 1, 2, 3) + __builtin_shufflevector(a, a, 4, 5, 6, 7);
  return (b[0] + b[2]) + (b[1] + b[3]);
}

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

template <int Dim, Sweep Kind>
struct RowKernel
{
  static IPIA_INLINE void run(const BrickArguments<Dim>& arguments)
  {
    constexpr int slices = Dim == 3 ? Order : 1;
    constexpr bool gather = Kind != Sweep::Diagonal && Kind != Sweep::Density;
    constexpr bool scatter = Kind != Sweep::Value && Kind != Sweep::ValueAndSlope;
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

    for (auto row = arguments.Begin; row != arguments.End;)
    {
      const std::int32_t cell = row->Cell;
      const int corner = (cell & 3) + WindowWidth * ((cell >> 2 & 3) + WindowWidth * (cell >> 4));
      Float16 c[slices], add[slices];
      for (int k = 0; k < slices; ++k)
      {
        add[k] = Float16{};
        if (gather)
        {
          const float* at = in + corner + k * WindowWidth * WindowWidth;
          for (int j = 0; j < Order; ++j)
          {
            std::memcpy(reinterpret_cast<float*>(&c[k]) + 4 * j, at + j * WindowWidth, 16);
          }
        }
      }
      for (; row != arguments.End && row->Cell == cell; ++row)
      {
        Float4 x, dx, y, dy, z{ 1, 0, 0, 0 }, dz{};
        evaluateBasis(row->T[0], x, dx);
        evaluateBasis(row->T[1], y, dy);
        if (Dim == 3)
        {
          evaluateBasis(row->T[Dim - 1], z, dz);
        }
        if (Kind == Sweep::Diagonal)
        {
          x *= x;
          y *= y;
          z *= z;
          dx *= dx * arguments.AxisScale[0];
          dy *= dy * arguments.AxisScale[1];
          dz *= dz * arguments.AxisScale[Dim - 1];
        }
        const Float16 xx = IPIA_REPEAT_ALL(x), yy = IPIA_REPEAT_EACH(y);
        const Float16 yx = yy * xx;
        const float weight = row->Weight;
        if (Kind == Sweep::Value || Kind == Sweep::Density)
        {
          if (Kind == Sweep::Value)
          {
            Float16 g = z[0] * c[0];
            for (int k = 1; k < slices; ++k)
            {
              g += z[k] * c[k];
            }
            arguments.Values[row->Source] = sumOf(g * yx);
          }
          else
          {
            const Float16 s = weight * yx;
            for (int k = 0; k < slices; ++k)
            {
              add[k] += z[k] * s;
            }
          }
          continue;
        }

        const Float16 ydx = yy * IPIA_REPEAT_ALL(dx);
        const Float16 dyx = IPIA_REPEAT_EACH(dy) * xx;
        float value = weight, slopeX = row->GradientWeight, slopeY = slopeX, slopeZ = slopeX;
        if (gather)
        {
          Float16 g = z[0] * c[0], gz = dz[0] * c[0];
          for (int k = 1; k < slices; ++k)
          {
            g += z[k] * c[k];
            gz += dz[k] * c[k];
          }
          const float f = sumOf(g * yx), fx = sumOf(g * ydx), fy = sumOf(g * dyx);
          const float fz = Dim == 3 ? sumOf(gz * yx) : 0.F;
          if (Kind == Sweep::ValueAndSlope)
          {
            float* at = arguments.Values + static_cast<std::int64_t>(row->Source) * (1 + Dim);
            at[0] = f;
            at[1] = fx;
            at[2] = fy;
            if (Dim == 3)
            {
              at[Dim] = fz;
            }
            continue;
          }
          constexpr float side = Kind == Sweep::Residual ? -1.F : 1.F;
          constexpr float target = Kind == Sweep::Residual ? 1.F : 0.F;
          value *= side * (f - target * row->Value);
          slopeX *= side * arguments.AxisScale[0] * (fx - target * row->Slope[0]);
          slopeY *= side * arguments.AxisScale[1] * (fy - target * row->Slope[1]);
          slopeZ *= side * arguments.AxisScale[Dim - 1] * (fz - target * row->Slope[Dim - 1]);
        }
        const Float16 s = value * yx + slopeX * ydx + slopeY * dyx;
        const Float16 t = slopeZ * yx;
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
          float* at = out + corner + k * WindowWidth * WindowWidth;
          for (int j = 0; j < Order; ++j)
          {
            Float4 total, part;
            std::memcpy(&total, at + j * WindowWidth, sizeof(total));
            std::memcpy(&part, reinterpret_cast<const float*>(&add[k]) + 4 * j, sizeof(part));
            total += part;
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
template <typename Kernel>
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
      dispatch<Kernel>(arguments);
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
  this->sweepRows<RowKernel<Dim, Sweep::Residual>>(
    c, this->Bricks.numberOfBricks(), gradient.data());
}

template <int Dim>
void BrickOperator<Dim>::product(const std::vector<float>& p, std::vector<float>& product) const
{
  this->applyFairing(p.data(), this->Bricks.numberOfActiveBricks(), 1, product);
  this->sweepRows<RowKernel<Dim, Sweep::Product>>(
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
  this->sweepRows<RowKernel<Dim, Sweep::Diagonal>>(nullptr, 0, diagonal.data());
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
  this->sweepRows<RowKernel<Dim, Sweep::Density>>(nullptr, 0, sums.data());
}

template <int Dim>
void BrickOperator<Dim>::evaluate(
  const std::vector<float>& coefficients, std::vector<float>& values) const
{
  values.resize(this->Rows.Rows.size());
  this->sweepRows<RowKernel<Dim, Sweep::Value>>(coefficients.data(),
    static_cast<std::int32_t>(coefficients.size() / BrickSize<Dim>), values.data());
}

template <int Dim>
void BrickOperator<Dim>::evaluateWithGradient(
  const std::vector<float>& coefficients, std::vector<float>& values) const
{
  values.resize(this->Rows.Rows.size() * (1 + Dim));
  this->sweepRows<RowKernel<Dim, Sweep::ValueAndSlope>>(coefficients.data(),
    static_cast<std::int32_t>(coefficients.size() / BrickSize<Dim>), values.data());
}

template class BrickOperator<2>;
template class BrickOperator<3>;
}
