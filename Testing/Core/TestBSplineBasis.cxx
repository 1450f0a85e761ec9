// SPDX-License-Identifier: BSD-3-Clause
#include "BSplineBasis.h"

#include "FairingReference.h"

namespace
{
using namespace ipia;

/// Uneven knots, one of them double where the degree allows.
std::vector<double> unevenKnots(int degree)
{
  std::vector<double> knots = { 0.1, 0.15, 0.4, 0.45, 0.5, 0.7, 0.71, 0.9 };
  if (degree > 1)
  {
    knots.insert(knots.begin() + 2, 0.4);
  }
  return knots;
}

std::vector<BSplineBasis> bases()
{
  std::vector<BSplineBasis> all;
  for (int degree = 1; degree <= BSplineBasis::MaximumDegree; ++degree)
  {
    all.push_back(BSplineBasis::clamped(degree, unevenKnots(degree)));
    all.push_back(BSplineBasis::periodic(degree, unevenKnots(degree)));
    all.push_back(BSplineBasis::clamped(degree, {}));
  }
  return all;
}

std::string nameOf(const BSplineBasis& basis)
{
  return "degree " + std::to_string(basis.degree()) +
    (basis.isPeriodic() ? " closed, " : " open, ") + std::to_string(basis.size()) + " functions";
}

TEST(BSplineBasis, ValuesAndDerivativesAreThoseOfTheRecursion)
{
  for (const BSplineBasis& basis : bases())
  {
    const int p = basis.degree();
    for (const double t : { 0.0, 0.05, 0.1, 0.39, 0.4, 0.42, 0.705, 0.95, 1.0 })
    {
      std::vector<double> values(static_cast<std::size_t>(4 * (p + 1)));
      const std::int64_t k = basis.span(t);
      basis.evaluate(k, t, 3, values.data());
      for (int r = 0; r <= 3; ++r)
      {
        Vector row = Vector::Zero(basis.size());
        for (int i = 0; i <= p; ++i)
        {
          row[basis.index(k, i)] += values[static_cast<std::size_t>(r * (p + 1) + i)];
        }
        const Vector expected = r <= p ? ipia::test::basisRow(basis, t, r) : row * 0;
        EXPECT_LE((row - expected).cwiseAbs().maxCoeff(),
          1e-13 * std::max(1.0, expected.cwiseAbs().maxCoeff()))
          << nameOf(basis) << ", t " << t << ", derivative " << r;
        EXPECT_NEAR(row.sum(), r == 0 ? 1 : 0, 1e-12 * std::max(1.0, row.cwiseAbs().maxCoeff()));
      }
    }
  }
}

TEST(BSplineBasis, GramMatricesAreTheIntegrals)
{
  for (const BSplineBasis& basis : bases())
  {
    for (int r = 0; r <= 3; ++r)
    {
      const Eigen::MatrixXd gram = basis.gram(r).toDense();
      if (r > basis.degree())
      {
        EXPECT_EQ(gram.norm(), 0);
        continue;
      }
      const Eigen::MatrixXd expected = ipia::test::gramMatrix(basis, r);
      EXPECT_LE((gram - expected).norm(), 1e-13 * expected.norm())
        << nameOf(basis) << ", order " << r;
    }
  }
}

/// Of the cubic Bernstein polynomials by hand: int N_0'^2 = 9/5, int N_0''^2 = 12, int N_0'''^2
/// = 36.
TEST(BSplineBasis, GramMatricesOfBernsteinPolynomials)
{
  const BSplineBasis basis = BSplineBasis::clamped(3, {});
  EXPECT_NEAR(basis.gram(0).at(0, 0), 1 / 7.0, 1e-15);
  EXPECT_NEAR(basis.gram(1).at(0, 0), 9 / 5.0, 1e-14);
  EXPECT_NEAR(basis.gram(2).at(0, 0), 12, 1e-13);
  EXPECT_NEAR(basis.gram(3).at(0, 0), 36, 1e-12);
}

TEST(BSplineBasis, CollocationGramIsThatOfTheCollocationMatrix)
{
  const Vector parameters = ipia::test::Random(3).vector(50, 0, 1);
  for (const BSplineBasis& basis : bases())
  {
    const Eigen::MatrixXd n = ipia::test::collocation(basis, parameters);
    const Eigen::MatrixXd expected = n.transpose() * n;
    EXPECT_LE(
      (basis.collocationGram(parameters).toDense() - expected).norm(), 1e-13 * expected.norm())
      << nameOf(basis);
  }
}

TEST(BSplineBasis, BandMatrixTimesVectorIsTheDenseProduct)
{
  for (const std::int64_t size : { 3, 6, 7, 20 })
  {
    for (const bool wraps : { false, true })
    {
      ipia::test::Random random(7);
      BandMatrix matrix(size, 3, wraps);
      for (double& entry : matrix.Entries)
      {
        entry = random.uniform(-1, 1);
      }
      const Vector x = random.vector(size, -1, 1);
      Vector y = Vector::Zero(size);
      matrix.addProduct(x.data(), y.data());
      EXPECT_LE((y - matrix.toDense() * x).cwiseAbs().maxCoeff(), 1e-14) << size << wraps;
    }
  }
}

TEST(BSplineBasis, GrevilleAbscissaeReproduceTheParameter)
{
  for (const BSplineBasis& basis : bases())
  {
    if (basis.isPeriodic())
    {
      continue;
    }
    for (const double t : { 0.0, 0.2, 0.4, 0.77, 1.0 })
    {
      const Vector row = ipia::test::basisRow(basis, t, 0);
      double sum = 0;
      for (std::int64_t j = 0; j < basis.size(); ++j)
      {
        sum += row[j] * basis.greville(j);
      }
      EXPECT_NEAR(sum, t, 1e-14) << nameOf(basis);
    }
  }
}
}
