// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the tests of the core share: both dimensions as types, the B-spline basis and its
 * collocation matrix straight from the definition, and points with normals on known shapes.
 */
#ifndef ipia_TestSupport_h
#define ipia_TestSupport_h

#include "Lattice.h"
#include "PointSamples.h"

#include <Eigen/Dense>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace ipia::test
{
/// Typed tests run for both dimensions: TypeParam::value is Dim.
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

constexpr double Pi = 3.14159265358979323846;

template <int Dim>
Lattice<Dim> makeLattice(const Index<Dim>& size, const Point<Dim>& spacing)
{
  Lattice<Dim> lattice;
  lattice.Size = size;
  lattice.Spacing = spacing;
  return lattice;
}

/// On a square or cube from the origin, with the same number of cells on all axes.
template <int Dim>
Lattice<Dim> cubeLattice(double side, std::int64_t cells)
{
  Lattice<Dim> lattice;
  lattice.Size.fill(cells + 3);
  lattice.Spacing.setConstant(side / static_cast<double>(cells));
  return lattice;
}

template <int Dim>
Lattice<Dim> unitLattice(std::int64_t cells)
{
  return cubeLattice<Dim>(1, cells);
}

/// An odd-sized lattice with another spacing on each axis: 9 x 8 (x 7).
template <int Dim>
Lattice<Dim> anisotropicLattice()
{
  Lattice<Dim> lattice;
  for (int a = 0; a < Dim; ++a)
  {
    lattice.Size[a] = 9 - a;
    lattice.Spacing[a] = 0.3 + 0.2 * a;
  }
  return lattice;
}

template <int Dim>
Point<Dim> extents(const Lattice<Dim>& lattice)
{
  Point<Dim> e;
  for (int a = 0; a < Dim; ++a)
  {
    e[a] = lattice.extent(a);
  }
  return e;
}

/**
 * B-spline of the given degree on the knots t_j = (j - 3) h by the recursion of Cox and de Boor,
 * for @a i as the coefficients are numbered. The last of the @a cells spans is closed.
 */
inline double coxDeBoor(int i, int degree, double h, std::int64_t cells, double x)
{
  const auto knot = [h](int j) { return (j - 3) * h; };
  if (degree == 0)
  {
    const std::int64_t span = i - 3;
    return span < cells && x >= knot(i) && (x < knot(i + 1) || span == cells - 1) ? 1.0 : 0.0;
  }
  return (x - knot(i)) / (degree * h) * coxDeBoor(i, degree - 1, h, cells, x) +
    (knot(i + degree + 1) - x) / (degree * h) * coxDeBoor(i + 1, degree - 1, h, cells, x);
}

/// The dense collocation matrix: entry (k, i) is B_i(x_k), coefficients numbered x fastest.
template <int Dim>
Eigen::MatrixXd collocationMatrix(const Lattice<Dim>& lattice, const Points<Dim>& positions)
{
  Eigen::MatrixXd matrix(positions.cols(), lattice.numberOfCoefficients());
  for (Eigen::Index k = 0; k < matrix.rows(); ++k)
  {
    for (Eigen::Index i = 0; i < matrix.cols(); ++i)
    {
      double product = 1;
      std::int64_t rest = i;
      for (int a = 0; a < Dim; ++a)
      {
        product *= coxDeBoor(static_cast<int>(rest % lattice.Size[a]), 3, lattice.Spacing[a],
          lattice.cells(a), positions(a, k));
        rest /= lattice.Size[a];
      }
      matrix(k, i) = product;
    }
  }
  return matrix;
}

/// Numbers that are the same on every platform.
class Random
{
public:
  explicit Random(std::uint64_t seed = 1)
    : Engine(seed)
  {
  }

  double uniform(double low, double high)
  {
    return low + (high - low) * std::ldexp(static_cast<double>(this->Engine() >> 11), -53);
  }

  Vector vector(std::int64_t n, double low, double high)
  {
    Vector v(n);
    for (double& value : v)
    {
      value = this->uniform(low, high);
    }
    return v;
  }

  template <int Dim>
  Points<Dim> pointsIn(const Lattice<Dim>& lattice, std::int64_t n)
  {
    Points<Dim> points(Dim, n);
    for (std::int64_t k = 0; k < n; ++k)
    {
      for (int a = 0; a < Dim; ++a)
      {
        points(a, k) = this->uniform(0, lattice.extent(a));
      }
    }
    return points;
  }

private:
  std::mt19937_64 Engine;
};

template <int Dim>
struct OrientedPoints
{
  Points<Dim> Positions, Normals;

  void append(const OrientedPoints& other)
  {
    const Eigen::Index n = this->Positions.cols(), m = other.Positions.cols();
    this->Positions.conservativeResize(Dim, n + m);
    this->Normals.conservativeResize(Dim, n + m);
    this->Positions.rightCols(m) = other.Positions;
    this->Normals.rightCols(m) = other.Normals;
  }
};

/// n points spread evenly over a circle or sphere (a Fibonacci spiral), normals outwards.
template <int Dim>
OrientedPoints<Dim> spherePoints(const Point<Dim>& centre, double radius, std::int64_t n)
{
  OrientedPoints<Dim> points{ Points<Dim>(Dim, n), Points<Dim>(Dim, n) };
  for (std::int64_t k = 0; k < n; ++k)
  {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(n);
    const double z = Dim == 3 ? 1 - 2 * share : 0.0;
    const double angle =
      Dim == 3 ? Pi * (3 - std::sqrt(5.0)) * static_cast<double>(k) : 2 * Pi * share;
    const double r = std::sqrt(1 - z * z);
    points.Normals(0, k) = r * std::cos(angle);
    points.Normals(1, k) = r * std::sin(angle);
    if (Dim == 3)
    {
      points.Normals(Dim - 1, k) = z;
    }
    points.Positions.col(k) = centre + radius * points.Normals.col(k);
  }
  return points;
}

/// What a fit takes, with a circle or sphere about the middle of the unit square or cube.
template <int Dim>
HermiteInput<Dim> sphereInput(double radius, std::int64_t n)
{
  const auto points = spherePoints<Dim>(Point<Dim>::Constant(0.5), radius, n);
  HermiteInput<Dim> input;
  input.Positions = points.Positions;
  input.Normals = points.Normals;
  return input;
}

inline double relativeDifference(const Vector& value, const Vector& reference)
{
  return (value - reference).norm() / reference.norm();
}

inline bool sameBits(const Vector& a, const Vector& b)
{
  return a.size() == b.size() && (a.array() == b.array()).all();
}
}

#endif
