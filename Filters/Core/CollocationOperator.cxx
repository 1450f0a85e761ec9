// SPDX-License-Identifier: BSD-3-Clause
#include "CollocationOperator.h"

#include "Dispatch.h"
#include "Parallel.h"
#include "TileSweep.h"

#include <cstring>

namespace ipia
{
namespace
{
// The cubic basis as a polynomial in t, one lane a basis function (see CubicBasis.h).
constexpr Vector4 Basis0 = { 1. / 6, 4. / 6, 1. / 6, 0 };
constexpr Vector4 Basis1 = { -.5, 0, .5, 0 };
constexpr Vector4 Basis2 = { .5, -1, .5, 0 };
constexpr Vector4 Basis3 = { -1. / 6, .5, -.5, 1. / 6 };

enum class Product
{
  Residual,   // w (b - f)
  Normal,     // w f
  ColumnSums, // w
  Support     // 1
};

/// All rows of one tile: gather f, scatter what Kind makes of it. The 16 coefficients of a slice
/// (y, x) are two vectors; a tricubic cell has four slices, a bicubic one.
template <int Dim, Product Kind>
struct TileKernel
{
  static IPIA_INLINE void run(const ConstraintRow<Dim>* rows,
    const typename ConstraintRows<Dim>::Cell* begin, const typename ConstraintRows<Dim>::Cell* end,
    const std::array<std::int64_t, 2>& stride, const double* coefficients, double* result,
    double& energy)
  {
    constexpr int slices = Dim == 3 ? Order : 1;
    constexpr bool gather = Kind == Product::Residual || Kind == Product::Normal;
    double sum = 0;
    for (auto cell = begin; cell != end; ++cell)
    {
      Vector8 c[slices][2], add[slices][2];
      for (int k = 0; k < slices; ++k)
      {
        for (int p = 0; p < 2; ++p)
        {
          add[k][p] = Vector8{};
          if (gather)
          {
            const double* at = coefficients + cell->Coefficient + k * stride[1] + 2 * p * stride[0];
            std::memcpy(&c[k][p], at, 4 * sizeof(double));
            std::memcpy(
              reinterpret_cast<double*>(&c[k][p]) + 4, at + stride[0], 4 * sizeof(double));
          }
        }
      }
      for (auto row = rows + cell[0].Begin; row != rows + cell[1].Begin; ++row)
      {
        const double tx = row->T[0], ty = row->T[1];
        const Vector4 x = Basis0 + tx * (Basis1 + tx * (Basis2 + tx * Basis3));
        const Vector4 y = Basis0 + ty * (Basis1 + ty * (Basis2 + ty * Basis3));
        const Vector8 xx = __builtin_shufflevector(x, x, 0, 1, 2, 3, 0, 1, 2, 3);
        const Vector8 yx[2] = { __builtin_shufflevector(y, y, 0, 0, 0, 0, 1, 1, 1, 1) * xx,
          __builtin_shufflevector(y, y, 2, 2, 2, 2, 3, 3, 3, 3) * xx };
        Vector4 z = { 1, 0, 0, 0 };
        if (Dim == 3)
        {
          const double tz = row->T[Dim - 1];
          z = Basis0 + tz * (Basis1 + tz * (Basis2 + tz * Basis3));
        }

        double scale = Kind == Product::Support ? 1.0 : row->Weight;
        if (gather)
        {
          Vector8 g0 = z[0] * c[0][0], g1 = z[0] * c[0][1];
          for (int k = 1; k < slices; ++k)
          {
            g0 += z[k] * c[k][0];
            g1 += z[k] * c[k][1];
          }
          const Vector8 g = g0 * yx[0] + g1 * yx[1];
          const Vector4 half =
            __builtin_shufflevector(g, g, 0, 1, 2, 3) + __builtin_shufflevector(g, g, 4, 5, 6, 7);
          const double f = (half[0] + half[2]) + (half[1] + half[3]);
          if (Kind == Product::Residual)
          {
            const double r = row->Target - f;
            scale *= r;
            sum += scale * r;
          }
          else
          {
            scale *= f;
          }
        }
        const Vector8 s0 = scale * yx[0], s1 = scale * yx[1];
        for (int k = 0; k < slices; ++k)
        {
          add[k][0] += z[k] * s0;
          add[k][1] += z[k] * s1;
        }
      }
      for (int k = 0; k < slices; ++k)
      {
        for (int j = 0; j < Order; ++j)
        {
          double* at = result + cell->Coefficient + k * stride[1] + j * stride[0];
          Vector4 total, part;
          std::memcpy(&total, at, sizeof(total));
          std::memcpy(
            &part, reinterpret_cast<const double*>(&add[k][j / 2]) + 4 * (j % 2), sizeof(part));
          total += part;
          std::memcpy(at, &total, sizeof(total));
        }
      }
    }
    energy = sum;
  }
};
}

template <int Dim>
CollocationOperator<Dim>::CollocationOperator(const ConstraintRows<Dim>& rows, int threads)
  : Rows(rows)
  , Threads(resolveThreads(threads))
{
}

template <int Dim>
template <typename Kernel>
double CollocationOperator<Dim>::sweep(const double* coefficients, Vector& result) const
{
  const Lattice<Dim>& lattice = this->Rows.lattice();
  result.resize(lattice.numberOfCoefficients());
  parallelChunks(result.size(), this->Threads,
    [&](std::int64_t begin, std::int64_t end) { result.segment(begin, end - begin).setZero(); });

  const std::array<std::int64_t, 2> stride = { lattice.Size[0], lattice.Size[0] * lattice.Size[1] };
  double* const out = result.data();
  return sweepTiles(this->Rows, this->Threads,
    [&](std::int64_t tile)
    {
      double energy = 0;
      dispatch<Kernel>(this->Rows.rows(), this->Rows.cells() + this->Rows.tileBegin(tile),
        this->Rows.cells() + this->Rows.tileBegin(tile + 1), stride, coefficients, out, energy);
      return energy;
    });
}

template <int Dim>
double CollocationOperator<Dim>::residual(const Vector& coefficients, Vector& gradient) const
{
  return this->sweep<TileKernel<Dim, Product::Residual>>(coefficients.data(), gradient);
}

template <int Dim>
void CollocationOperator<Dim>::normalProduct(const Vector& coefficients, Vector& product) const
{
  this->sweep<TileKernel<Dim, Product::Normal>>(coefficients.data(), product);
}

template <int Dim>
void CollocationOperator<Dim>::columnSums(Vector& sums) const
{
  this->sweep<TileKernel<Dim, Product::ColumnSums>>(nullptr, sums);
}

template <int Dim>
void CollocationOperator<Dim>::support(Vector& support) const
{
  this->sweep<TileKernel<Dim, Product::Support>>(nullptr, support);
}

template class CollocationOperator<2>;
template class CollocationOperator<3>;
}
