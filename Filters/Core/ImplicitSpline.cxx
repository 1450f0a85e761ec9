// SPDX-License-Identifier: BSD-3-Clause
#include "ImplicitSpline.h"

#include "CubicBasis.h"
#include "Dispatch.h"
#include "OutsideDomain.h"
#include "Parallel.h"

#include <cstring>

namespace ipia
{
namespace
{
/// The nearest point of the domain.
template <int Dim>
struct Nearest
{
  std::array<AxisLocation, Dim> At;
  std::int64_t Box;
  Point<Dim> Away; ///< from the nearest point of the domain to the position

  IPIA_INLINE Nearest(const Lattice<Dim>& lattice, const Point<Dim>& position)
  {
    Index<Dim> box;
    for (int a = 0; a < Dim; ++a)
    {
      const double inside = std::min(std::max(position[a], 0.0), lattice.extent(a));
      this->At[a] = lattice.locate(inside, a);
      // An end of the domain that rounding has put outside is not outside.
      const double away = position[a] - inside;
      this->Away[a] = std::abs(away) <= 1e-12 * lattice.extent(a) ? 0.0 : away;
      box[a] = lattice.locateBox(inside, a);
    }
    this->Box = lattice.boxIndex(box);
  }
};

/// sum_i c_i B_i, and its gradient unless nullptr.
template <int Dim>
IPIA_INLINE double sumAt(const Lattice<Dim>& lattice, const double* coefficients,
  const std::array<AxisLocation, Dim>& at, Point<Dim>* gradient)
{
  std::array<BasisValues, 3> w = { BasisValues{ 1 }, BasisValues{ 1 }, BasisValues{ 1 } };
  std::array<BasisValues, 3> d{};
  Index<Dim> cell;
  for (int a = 0; a < Dim; ++a)
  {
    const auto i = static_cast<std::size_t>(a);
    w[i] = cubicBasis(at[i].T);
    if (gradient)
    {
      d[i] = cubicBasisFirstDerivative(at[i].T);
    }
    cell[i] = at[i].Cell;
  }
  // Sums along z and y first, one lane per coefficient along x.
  const auto& size = lattice.Size;
  const double* base = coefficients + lattice.coefficientIndex(cell);
  Vector4 f{}, fy{}, fz{};
  for (std::size_t k = 0; k < (Dim == 3 ? Order : 1); ++k)
  {
    for (std::size_t j = 0; j < Order; ++j)
    {
      Vector4 c;
      std::memcpy(&c,
        base + (static_cast<std::int64_t>(k) * size[1] + static_cast<std::int64_t>(j)) * size[0],
        sizeof(c));
      f += w[2][k] * w[1][j] * c;
      if (gradient)
      {
        fy += w[2][k] * d[1][j] * c;
        fz += d[2][k] * w[1][j] * c;
      }
    }
  }
  const auto alongX = [](const BasisValues& x, const Vector4& v)
  { return x[0] * v[0] + x[1] * v[1] + x[2] * v[2] + x[3] * v[3]; };
  if (gradient)
  {
    const Point<Dim>& h = lattice.Spacing;
    (*gradient)[0] = alongX(d[0], f) / h[0];
    (*gradient)[1] = alongX(w[0], fy) / h[1];
    if (Dim == 3)
    {
      (*gradient)[Dim - 1] = alongX(w[0], fz) / h[Dim - 1];
    }
  }
  return alongX(w[0], f);
}

/// What evaluation needs: @a Weights is nullptr where the spline is not rational, otherwise @a
/// Coefficients are those of the numerator.
struct Coefficients
{
  const double* Values;
  const double* Weights;
};

/// f at a position anywhere, and its gradient unless nullptr.
template <int Dim>
IPIA_INLINE double evaluateAt(const Lattice<Dim>& lattice, const Coefficients& coefficients,
  const FarField& farField, const Point<Dim>& position, Point<Dim>* gradient)
{
  const Nearest<Dim> nearest(lattice, position);
  const double constant = farField.Sign.empty() ? 0.0 : farField.value(nearest.Box);
  if (gradient)
  {
    gradient->setZero();
  }
  double f = constant;
  if (constant == 0)
  {
    f = sumAt<Dim>(lattice, coefficients.Values, nearest.At, gradient);
    if (coefficients.Weights)
    {
      Point<Dim> slope;
      const double d =
        sumAt<Dim>(lattice, coefficients.Weights, nearest.At, gradient ? &slope : nullptr);
      f /= d;
      if (gradient)
      {
        *gradient = (*gradient - f * slope) / d;
      }
    }
  }
  return continueOutside<Dim>(nearest.Away, f, gradient);
}

template <int Dim>
struct PointsKernel
{
  static IPIA_INLINE void run(const Lattice<Dim>& lattice, const Coefficients& coefficients,
    const FarField& farField, const Points<Dim>& positions, Vector& values, Points<Dim>& gradients)
  {
    for (Eigen::Index k = 0; k < positions.cols(); ++k)
    {
      const Point<Dim> x = positions.col(k);
      Point<Dim> g;
      values[k] = evaluateAt<Dim>(lattice, coefficients, farField, x, &g);
      gradients.col(k) = g;
    }
  }
};

/// Slices along the last axis that a rational spline samples at a time.
template <int Dim>
constexpr std::size_t SlabSize = Dim == 3 ? 16 : 1024;

Coefficients coefficientsOf(
  const Vector& polynomial, const Vector& numerator, const Vector& weights)
{
  return weights.size() ? Coefficients{ numerator.data(), weights.data() }
                        : Coefficients{ polynomial.data(), nullptr };
}
}

template <int Dim>
ImplicitSpline<Dim>::ImplicitSpline(
  const Lattice<Dim>& lattice, Vector coefficients, FarField farField)
  : ControlLattice(lattice)
  , Coefficients(std::move(coefficients))
  , Far(std::move(farField))
{
}

template <int Dim>
ImplicitSpline<Dim>::ImplicitSpline(
  const Lattice<Dim>& lattice, Vector coefficients, Vector weights, FarField farField)
  : ControlLattice(lattice)
  , Coefficients(std::move(coefficients))
  , Weights(std::move(weights))
  , Numerator(this->Coefficients.cwiseProduct(this->Weights))
  , Far(std::move(farField))
{
}

template <int Dim>
double ImplicitSpline<Dim>::value(const Point<Dim>& position) const
{
  return evaluateAt<Dim>(this->ControlLattice,
    coefficientsOf(this->Coefficients, this->Numerator, this->Weights), this->Far, position,
    nullptr);
}

template <int Dim>
Point<Dim> ImplicitSpline<Dim>::gradient(const Point<Dim>& position) const
{
  Point<Dim> g;
  this->valueAndGradient(position, g);
  return g;
}

template <int Dim>
double ImplicitSpline<Dim>::valueAndGradient(const Point<Dim>& position, Point<Dim>& gradient) const
{
  return evaluateAt<Dim>(this->ControlLattice,
    coefficientsOf(this->Coefficients, this->Numerator, this->Weights), this->Far, position,
    &gradient);
}

template <int Dim>
void ImplicitSpline<Dim>::valuesAndGradients(
  const Points<Dim>& positions, Vector& values, Points<Dim>& gradients) const
{
  values.resize(positions.cols());
  gradients.resize(Dim, positions.cols());
  dispatch<PointsKernel<Dim>>(this->ControlLattice,
    coefficientsOf(this->Coefficients, this->Numerator, this->Weights), this->Far, positions,
    values, gradients);
}

template <int Dim>
template <typename Scalar>
bool ImplicitSpline<Dim>::sampleRational(const AxisPositions<Dim>& positions, Scalar* values,
  int threads, int derivativeAxis, const ProgressCallback& progress) const
{
  const std::vector<double>& last = positions[Dim - 1];
  std::size_t slice = 1;
  for (std::size_t a = 0; a + 1 < Dim; ++a)
  {
    slice *= positions[a].size();
  }
  const std::size_t room = slice * std::min(SlabSize<Dim>, last.size());
  std::vector<double> numerator(room), denominator(room), slopes, weightSlopes;
  if (derivativeAxis >= 0)
  {
    slopes.resize(room);
    weightSlopes.resize(room);
  }
  AxisPositions<Dim> slab = positions;
  for (std::size_t begin = 0; begin < last.size(); begin += SlabSize<Dim>)
  {
    const std::size_t end = std::min(begin + SlabSize<Dim>, last.size());
    slab[Dim - 1].assign(last.begin() + static_cast<std::ptrdiff_t>(begin),
      last.begin() + static_cast<std::ptrdiff_t>(end));
    const auto fill = [&](const Vector& coefficients, std::array<double, 2> constants, int axis,
                        std::vector<double>& to)
    {
      if (!to.empty())
      {
        sampleSpline<Dim>(this->ControlLattice, coefficients, this->Far, constants, slab, to.data(),
          threads, axis, {});
      }
    };
    // In the far field the quotient is its constant, and the slopes are 0.
    fill(this->Numerator, { -this->Far.Magnitude, this->Far.Magnitude }, -1, numerator);
    fill(this->Weights, { 1, 1 }, -1, denominator);
    fill(this->Numerator, { 0, 0 }, derivativeAxis, slopes);
    fill(this->Weights, { 0, 0 }, derivativeAxis, weightSlopes);
    Scalar* const out = values + begin * slice;
    parallelChunks(static_cast<std::int64_t>((end - begin) * slice), resolveThreads(threads),
      [&](std::int64_t from, std::int64_t to)
      {
        for (auto i = static_cast<std::size_t>(from); i < static_cast<std::size_t>(to); ++i)
        {
          const double f = numerator[i] / denominator[i];
          out[i] = static_cast<Scalar>(
            slopes.empty() ? f : (slopes[i] - f * weightSlopes[i]) / denominator[i]);
        }
      });
    if (progress && !progress(static_cast<double>(end) / static_cast<double>(last.size())))
    {
      return false;
    }
  }
  return true;
}

template <int Dim>
template <typename Scalar>
bool ImplicitSpline<Dim>::sample(const AxisPositions<Dim>& positions, Scalar* values, int threads,
  int derivativeAxis, const ProgressCallback& progress) const
{
  if (this->isRational())
  {
    return this->sampleRational(positions, values, threads, derivativeAxis, progress);
  }
  const double constant = derivativeAxis >= 0 ? 0.0 : this->Far.Magnitude;
  return sampleSpline<Dim>(this->ControlLattice, this->Coefficients, this->Far,
    { -constant, constant }, positions, values, threads, derivativeAxis, progress);
}

template class ImplicitSpline<2>;
template class ImplicitSpline<3>;
template bool ImplicitSpline<2>::sample(
  const AxisPositions<2>&, float*, int, int, const ProgressCallback&) const;
template bool ImplicitSpline<2>::sample(
  const AxisPositions<2>&, double*, int, int, const ProgressCallback&) const;
template bool ImplicitSpline<3>::sample(
  const AxisPositions<3>&, float*, int, int, const ProgressCallback&) const;
template bool ImplicitSpline<3>::sample(
  const AxisPositions<3>&, double*, int, int, const ProgressCallback&) const;
}
