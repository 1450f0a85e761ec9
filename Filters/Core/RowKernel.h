// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The sweep over the rows of one brick: gather from a window of coefficients, scatter into one.
 */
#ifndef ipia_RowKernel_h
#define ipia_RowKernel_h

#include "HermiteRows.h"
#include "RowRegisters.h"

namespace ipia
{
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
    static_assert(WindowWidth == 8, "as the registers load and add");
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
          c[k] = Wide::load(in + corner + k * sliceSize);
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
          add[k].addTo(out + corner + k * sliceSize);
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
}

#endif
