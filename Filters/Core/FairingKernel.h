// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The fairing energy's matrix times the coefficients around one brick.
 */
#ifndef ipia_FairingKernel_h
#define ipia_FairingKernel_h

#include "BrickOperator.h"
#include "RowRegisters.h"

#include <cstring>

namespace ipia
{
/// The second and fourth difference operators of one axis at the ends of the lattice: row i of
/// K1 = D1^T D1 and K2 = D2^T D2 with differences that leave the lattice left out.
struct EndStencils
{
  std::array<float, 3> First{};
  std::array<float, 5> Second{};

  EndStencils() = default;
  EndStencils(std::int64_t i, std::int64_t n)
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
  /// The bricks around this one, of zeros where there is none.
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
        std::memcpy(to, low + inBrick + 2, 2 * sizeof(float));
        std::memcpy(to + 2, middle + inBrick, BrickWidth * sizeof(float));
        std::memcpy(to + 6, high + inBrick, 2 * sizeof(float));
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
    const auto load = [](const float* from)
    {
      Float4 v;
      std::memcpy(&v, from, sizeof(v));
      return v;
    };
    for (int z = 0; z < (Dim == 3 ? BrickWidth : 1); ++z)
    {
      for (int y = 0; y < BrickWidth; ++y)
      {
        const float* p = once + 2 + WindowWidth * (y + 2 + (Dim == 3 ? WindowWidth * (z + 2) : 0));
        const Float4 middle = load(p);
        Float4 v = centre * middle - scale[0] * (load(p - 1) + load(p + 1)) -
          scale[1] * (load(p - WindowWidth) + load(p + WindowWidth));
        if (Dim == 3)
        {
          v -= scale[Dim - 1] * (load(p - Stride[2]) + load(p + Stride[2]));
        }
        const Float4 sum = plate * v + membrane * middle;
        std::memcpy(arguments.Output + BrickWidth * (y + BrickWidth * z), &sum, sizeof(sum));
      }
    }
  }

  static void runAtBorder(const FairingArguments<Dim>& arguments, const float* in)
  {
    const float plate = arguments.Sign * arguments.Weights.ThinPlate;
    const float membrane = arguments.Sign * arguments.Weights.Membrane;
    std::array<std::array<EndStencils, BrickWidth>, Dim> ofAxis;
    for (int a = 0; a < Dim; ++a)
    {
      for (int i = 0; i < BrickWidth; ++i)
      {
        ofAxis[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)] =
          EndStencils(arguments.First[a] + i, arguments.Size[a]);
      }
    }
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
        const EndStencils& stencils = ofAxis[static_cast<std::size_t>(a)][static_cast<std::size_t>(
          local[static_cast<std::size_t>(a)])];
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

#endif
