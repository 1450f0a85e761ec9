// SPDX-License-Identifier: BSD-3-Clause
#include "AttributeSpline.h"

#include "BrickSpline.h"
#include "CubicBasis.h"
#include "Parallel.h"

namespace ipia
{
namespace
{
template <int Dim>
constexpr std::size_t CellSize = Dim == 2 ? 16 : 64;
}

template <int Dim>
AttributeSpline<Dim>::AttributeSpline(
  std::shared_ptr<const Levels> levels, double scale, std::vector<Component> components)
  : Grids(std::move(levels))
  , Scale(scale)
  , Components(std::move(components))
{
}

template <int Dim>
void AttributeSpline<Dim>::evaluate(const Point<Dim>& position, double* values) const
{
  Point<Dim> nearest = position;
  for (int a = 0; a < Dim; ++a)
  {
    nearest[a] = std::min(std::max(position[a], 0.0), this->Grids->back().lattice().extent(a));
  }
  // The coefficients of the cell in their level's order, and the products of the basis functions.
  std::array<std::size_t, CellSize<Dim>> at{};
  std::array<double, CellSize<Dim>> basis{};
  const std::size_t levels = this->Scale > 0 ? this->Components.front().Splines.size() : 0;
  std::size_t l = levels;
  if (levels > 0)
  {
    Index<Dim> cell;
    std::array<BasisValues, Dim> w;
    do
    {
      --l;
      const Lattice<Dim>& lattice = (*this->Grids)[l].lattice();
      for (int a = 0; a < Dim; ++a)
      {
        const auto i = static_cast<std::size_t>(a);
        const AxisLocation on = lattice.locate(nearest[a], a);
        cell[i] = on.Cell;
        w[i] = cubicBasis(on.T);
      }
    } while (l > 0 && !(*this->Grids)[l].covers(cell));
    const BrickLattice<Dim>& bricks = (*this->Grids)[l];
    for (std::size_t k = 0; k < CellSize<Dim>; ++k)
    {
      Index<Dim> brick;
      std::int64_t inside = 0;
      double product = 1;
      for (int a = Dim - 1; a >= 0; --a)
      {
        const auto i = static_cast<std::size_t>(a);
        const std::size_t step = k >> (2 * i) & 3;
        const std::int64_t index = cell[i] + static_cast<std::int64_t>(step);
        brick[i] = index / BrickWidth;
        inside = inside * BrickWidth + index % BrickWidth;
        product *= w[i][step];
      }
      at[k] = static_cast<std::size_t>(
        static_cast<std::int64_t>(bricks.brickAt(brick)) * BrickSize<Dim> + inside);
      basis[k] = product;
    }
  }
  for (std::size_t c = 0; c < this->Components.size(); ++c)
  {
    const Component& component = this->Components[c];
    double rest = 0;
    if (levels > 0)
    {
      const BrickValues& coefficients = component.Splines[l];
      for (std::size_t k = 0; k < CellSize<Dim>; ++k)
      {
        rest += basis[k] * static_cast<double>(coefficients[at[k]]);
      }
    }
    const double v = component.Constant + component.Slope.dot(nearest) + this->Scale * rest;
    values[c] = std::min(std::max(v, component.Low), component.High);
  }
}

template <int Dim>
bool AttributeSpline<Dim>::sample(const AxisPositions<Dim>& positions, int component,
  double* values, int threads, const ProgressCallback& progress) const
{
  const Component& chosen = this->component(component);
  std::int64_t n = 1;
  for (const std::vector<double>& axis : positions)
  {
    n *= static_cast<std::int64_t>(axis.size());
  }
  if (this->Scale > 0)
  {
    const auto count = static_cast<std::ptrdiff_t>(chosen.Splines.size());
    Levels levels(this->Grids->begin(), this->Grids->begin() + count);
    for (std::size_t l = 0; l < levels.size(); ++l)
    {
      levels[l].coefficients() = chosen.Splines[l];
    }
    const BrickSpline<Dim> spline(std::move(levels));
    const ImplicitSpline<Dim> dense(spline.lattice(), spline.coefficients());
    if (!dense.sample(positions, values, threads, -1, progress))
    {
      return false;
    }
  }
  else
  {
    std::fill_n(values, n, 0.0);
  }
  const auto line = static_cast<std::int64_t>(positions[0].size());
  parallelChunks(n, resolveThreads(threads),
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        std::int64_t rest = i / line;
        double linear =
          chosen.Constant + chosen.Slope[0] * positions[0][static_cast<std::size_t>(i % line)];
        for (int a = 1; a < Dim; ++a)
        {
          const std::vector<double>& axis = positions[static_cast<std::size_t>(a)];
          const auto size = static_cast<std::int64_t>(axis.size());
          linear += chosen.Slope[a] * axis[static_cast<std::size_t>(rest % size)];
          rest /= size;
        }
        const double v = linear + this->Scale * values[i];
        values[i] = std::min(std::max(v, chosen.Low), chosen.High);
      }
    });
  return true;
}

template class AttributeSpline<2>;
template class AttributeSpline<3>;
}
