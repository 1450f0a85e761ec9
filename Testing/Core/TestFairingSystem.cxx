// SPDX-License-Identifier: BSD-3-Clause
#include "FairingSystem.h"

#include "FairingReference.h"

namespace
{
using namespace ipia;
using ipia::test::DenseFairing;
using ipia::test::FairingProblem;

std::vector<FairingProblem> problems()
{
  std::vector<FairingProblem> all;
  for (const int degree : { 2, 3, 5 })
  {
    for (int order = 1; order <= std::min(degree, 3); ++order)
    {
      all.push_back(ipia::test::curveProblem(degree, order, false));
      all.push_back(ipia::test::curveProblem(degree, order, true));
      all.push_back(ipia::test::surfaceProblem(degree, order, true));
      all.push_back(ipia::test::surfaceProblem(degree, order, false));
    }
  }
  // Closed along both axes, once as a grid and once scattered.
  for (const bool gridded : { true, false })
  {
    FairingProblem torus = ipia::test::surfaceProblem(3, 2, gridded);
    torus.Start.Axes = { uniformKnots(3, 9, true), uniformKnots(3, 8, true) };
    all.push_back(torus);
  }
  return all;
}

TEST(FairingSystem, IsTheDenseOne)
{
  for (FairingProblem& problem : problems())
  {
    problem.Weights = ipia::test::randomWeights(problem.Start.size(), 1e-6, 0.9, 29);
    const DenseFairing dense(problem);
    const FairingSystem system = problem.system();
    const Eigen::MatrixXd& p = problem.Start.ControlPoints;
    Eigen::MatrixXd fitting, fairing;
    system.apply(p, fitting, fairing);
    const Eigen::MatrixXd gram = dense.N.transpose() * dense.N;
    const Eigen::MatrixXd side = dense.N.transpose() * problem.Data.Points;
    EXPECT_LE((fitting - gram * p).norm(), 1e-13 * (gram * p).norm());
    EXPECT_LE((fairing - dense.D * p).norm(), 1e-13 * dense.D.norm() * p.norm());
    EXPECT_LE((system.rightHandSide() - side).norm(), 1e-13 * side.norm());
    EXPECT_LE((system.absoluteRowSums().cwiseInverse() - dense.stepSizes()).norm(),
      1e-12 * dense.stepSizes().norm());

    Eigen::MatrixXd assembled = Eigen::MatrixXd::Zero(system.size(), system.size());
    for (std::int64_t j = 0; j < system.size(); ++j)
    {
      system.visitRow(j,
        [&](std::int64_t l, double g, double d)
        { assembled(j, l) += (1 - problem.Weights[j]) * g + problem.Weights[j] * d; });
    }
    EXPECT_LE((assembled - dense.A).norm(), 1e-13 * dense.A.norm());

    const Eigen::MatrixXd residuals = fittingResiduals(problem.Start, problem.Data, 1);
    EXPECT_LE((residuals - (problem.Data.Points - dense.N * p)).norm(), 1e-13 * residuals.norm());
    EXPECT_NEAR(rootMeanSquare(residuals),
      std::sqrt(residuals.squaredNorm() / static_cast<double>(residuals.rows())), 1e-15);
    const double energy = p.cwiseProduct(dense.D * p).sum();
    EXPECT_NEAR(fairingEnergy(problem.Start, problem.Order), energy, 1e-12 * energy);
  }
}

/// The parabola (t, t^2, 0) has strain energy 4, and stretch energy 1 + 4/3.
TEST(FairingSystem, EnergyOfAParabola)
{
  TensorSpline spline;
  spline.Axes[0] = BSplineBasis::clamped(2, {});
  spline.ControlPoints.resize(3, 3);
  spline.ControlPoints << 0, 0, 0, 0.5, 0, 0, 1, 1, 0;
  EXPECT_NEAR(fairingEnergy(spline, 1), 7 / 3.0, 1e-14);
  EXPECT_NEAR(fairingEnergy(spline, 2), 4, 1e-13);
}

/// The saddle z = u v: S_uv = (0, 0, 1), so the thin plate energy is 2.
TEST(FairingSystem, ThinPlateEnergyOfASaddle)
{
  TensorSpline spline;
  spline.Axes = { BSplineBasis::clamped(2, {}), BSplineBasis::clamped(2, {}) };
  spline.ControlPoints.resize(9, 3);
  for (int j = 0; j < 9; ++j)
  {
    spline.ControlPoints.row(j) << (j % 3) / 2.0, (j / 3) / 2.0, (j % 3) * (j / 3) / 4.0;
  }
  EXPECT_NEAR(fairingEnergy(spline, 2), 2, 1e-13);
}

TEST(FairingSystem, CarriedValuesAreMeansWithinTheirRange)
{
  for (const FairingProblem& problem : problems())
  {
    const DenseFairing dense(problem);
    const Vector values = ipia::test::Random(31).vector(problem.Data.Points.rows(), 0, 1);
    const Vector carried = carryToControlPoints(problem.Start.Axes, problem.Data, values, 0.5);
    const Vector expected =
      (dense.N.transpose() * values).cwiseQuotient(dense.N.colwise().sum().transpose());
    EXPECT_LE((carried - expected).cwiseAbs().maxCoeff(), 1e-12);
    const Vector ones = Vector::Ones(values.size());
    EXPECT_LE(carryToControlPoints(problem.Start.Axes, problem.Data, ones, 1).maxCoeff(), 1);
  }
  FairingProblem alone = ipia::test::surfaceProblem(3, 2, false);
  alone.Data.Points.conservativeResize(1, 3);
  alone.Data.Parameters = { Vector::Zero(1), Vector::Zero(1) };
  const Vector carried =
    carryToControlPoints(alone.Start.Axes, alone.Data, Vector::Constant(1, 0.25), 0.75);
  EXPECT_EQ(carried[0], 0.25);
  EXPECT_EQ(carried[71], 0.75);
}
}
