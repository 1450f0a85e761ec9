// SPDX-License-Identifier: BSD-3-Clause
#include "BrickOperator.h"

#include "FairingKernel.h"
#include "Parallel.h"
#include "RowKernel.h"

#include <cstring>

namespace ipia
{
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
  const float* input, std::int32_t inputBricks, float sign, BrickValues& output) const
{
  static constexpr std::array<float, BrickSize<Dim>> zeros{};
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
        : zeros.data();
    }
    dispatch<FairingKernel<Dim>>(arguments);
  }
}

template <int Dim>
void BrickOperator<Dim>::fill(BrickValues& values, float value) const
{
  const auto n = static_cast<std::int64_t>(this->Bricks.numberOfActiveBricks()) * BrickSize<Dim>;
  values.resize(static_cast<std::size_t>(n));
  parallelChunks(n, this->Threads,
    [&](std::int64_t begin, std::int64_t end)
    { std::fill_n(values.begin() + begin, end - begin, value); });
}

template <int Dim>
void BrickOperator<Dim>::residual(BrickValues& gradient) const
{
  const float* c = this->Bricks.coefficients().data();
  this->applyFairing(c, this->Bricks.numberOfBricks(), -1, gradient);
  this->sweepRows<static_cast<int>(Sweep::Residual)>(
    c, this->Bricks.numberOfBricks(), gradient.data());
}

template <int Dim>
void BrickOperator<Dim>::product(const BrickValues& p, BrickValues& product) const
{
  this->applyFairing(p.data(), this->Bricks.numberOfActiveBricks(), 1, product);
  this->sweepRows<static_cast<int>(Sweep::Product)>(
    p.data(), this->Bricks.numberOfActiveBricks(), product.data());
}

template <int Dim>
void BrickOperator<Dim>::diagonal(BrickValues& diagonal) const
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
  this->fill(diagonal, fairing);
  this->sweepRows<static_cast<int>(Sweep::Diagonal)>(nullptr, 0, diagonal.data());
}

template <int Dim>
double BrickOperator<Dim>::energy() const
{
  BrickValues values;
  this->evaluateWithGradient(this->Bricks.coefficients(), values);
  return parallelSum(static_cast<std::int64_t>(this->Rows.Rows.size()), this->Threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      double sum = 0;
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      {
        const HermiteRow<Dim>& row = this->Rows.Rows[k];
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
    });
}

template <int Dim>
void BrickOperator<Dim>::density(BrickValues& sums) const
{
  this->fill(sums, 0);
  this->sweepRows<static_cast<int>(Sweep::Density)>(nullptr, 0, sums.data());
}

template <int Dim>
void BrickOperator<Dim>::evaluate(const BrickValues& coefficients, BrickValues& values) const
{
  values.resize(this->Rows.Rows.size());
  this->sweepRows<static_cast<int>(Sweep::Value)>(coefficients.data(),
    static_cast<std::int32_t>(coefficients.size() / BrickSize<Dim>), values.data());
}

template <int Dim>
void BrickOperator<Dim>::evaluateWithGradient(
  const BrickValues& coefficients, BrickValues& values) const
{
  values.resize(this->Rows.Rows.size() * (1 + Dim));
  this->sweepRows<static_cast<int>(Sweep::ValueAndSlope)>(coefficients.data(),
    static_cast<std::int32_t>(coefficients.size() / BrickSize<Dim>), values.data());
}

template class BrickOperator<2>;
template class BrickOperator<3>;
}
