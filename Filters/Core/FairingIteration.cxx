// SPDX-License-Identifier: BSD-3-Clause
#include "FairingIteration.h"

#include "Parallel.h"

#include <Eigen/Sparse>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ipia
{
namespace
{
using Eigen::MatrixXd;

/// The iteration error at which an iteration has diverged.
constexpr double DivergedError = 1e6;

/// Rounding of A P and its right-hand side, in units of their size.
constexpr double Rounding = 64 * std::numeric_limits<double>::epsilon();

/// SparseDirect: the most that refinement may move the control points, and the most that may be
/// left of the error.
constexpr double LargestRefinement = 1e-3, LargestDirectError = 1e-6;

/// Control points with what A makes of them, kept up to date by linearity.
struct State
{
  MatrixXd X, Fitting, Fairing; ///< x, N^T N x, D x
};

class Iteration
{
public:
  Iteration(const FairingSystem& system, const MatrixXd& residuals, const FairingOptions& options,
    TensorSpline& spline, const ProgressCallback& progress)
    : System(system)
    , Options(options)
    , Progress(progress)
    , Points(spline.ControlPoints)
    , DataCount(static_cast<double>(residuals.rows()))
    , FirstSquaredResidual(residuals.squaredNorm())
  {
    this->Current.X = this->Points;
    system.apply(this->Current.X, this->Current.Fitting, this->Current.Fairing);
    this->First = this->Current;
    this->Residual.resize(system.size(), 3);
    this->updateResidual();
    this->FirstNorm = std::sqrt(this->dot(this->Residual, this->Residual));
    this->RoundingNorm = options.Tolerance > 0 ? Rounding * this->sizeOfTerms() : 0.0;
    this->record();
  }

  FairingResult run()
  {
    if (!this->Current.X.allFinite() || !std::isfinite(this->FirstNorm))
    {
      this->Result.Status = FairingStatus::NotFinite;
      return this->Result;
    }
    switch (this->Options.Solver)
    {
      case FairingSolver::ProgressiveIteration:
        this->progressiveIteration();
        break;
      case FairingSolver::BiconjugateGradient:
        this->biconjugateGradient();
        break;
      case FairingSolver::SparseDirect:
        this->sparseDirect();
        break;
    }
    if (!this->Current.X.allFinite() && this->Result.Status != FairingStatus::Singular)
    {
      this->Result.Status = FairingStatus::Diverged;
    }
    this->Points = this->Current.X;
    return this->Result;
  }

private:
  bool isMovable(std::int64_t j) const
  {
    return this->Options.Movable.empty() || this->Options.Movable[static_cast<std::size_t>(j)];
  }

  double dot(const MatrixXd& a, const MatrixXd& b) const
  {
    return parallelSum(a.size(), this->System.threads(),
      [&](std::int64_t begin, std::int64_t end)
      {
        const auto n = end - begin;
        return Eigen::Map<const Vector>(a.data() + begin, n)
          .dot(Eigen::Map<const Vector>(b.data() + begin, n));
      });
  }

  /// Calls body(row, coordinate) for all entries.
  template <typename Body>
  void forEach(const Body& body) const
  {
    parallelChunks(this->System.size(), this->System.threads(),
      [&](std::int64_t begin, std::int64_t end)
      {
        for (Eigen::Index c = 0; c < 3; ++c)
        {
          for (std::int64_t j = begin; j < end; ++j)
          {
            body(j, c);
          }
        }
      });
  }

  /// (I - Omega) N^T (Q - N P) - Omega D P of the control points that move.
  void updateResidual()
  {
    const Vector& w = this->System.weights();
    const MatrixXd& b = this->System.rightHandSide();
    this->forEach(
      [&](std::int64_t j, Eigen::Index c)
      {
        this->Residual(j, c) = this->isMovable(j)
          ? (1 - w[j]) * (b(j, c) - this->Current.Fitting(j, c)) -
            w[j] * this->Current.Fairing(j, c)
          : 0.0;
      });
  }

  double sizeOfTerms() const
  {
    const Vector& w = this->System.weights();
    MatrixXd terms(this->System.size(), 3);
    this->forEach(
      [&](std::int64_t j, Eigen::Index c)
      {
        terms(j, c) = !this->isMovable(j) ? 0.0
                                          : (1 - w[j]) *
              (std::abs(this->System.rightHandSide()(j, c)) +
                std::abs(this->Current.Fitting(j, c))) +
            w[j] * std::abs(this->Current.Fairing(j, c));
      });
    return std::sqrt(this->dot(terms, terms));
  }

  /// Appends the current state to the history; returns the iteration error.
  double record()
  {
    const double norm = std::sqrt(this->dot(this->Residual, this->Residual));
    const double error = norm == 0 ? 0.0 : norm / this->FirstNorm;
    FairingHistory& history = this->Result.History;
    history.IterationError.push_back(error);
    history.Energy.push_back(this->dot(this->Current.X, this->Current.Fairing));
    // |Q - N P|^2 from the change since the beginning, where it is known.
    const MatrixXd &x = this->Current.X, &g = this->Current.Fitting;
    const MatrixXd &x0 = this->First.X, &g0 = this->First.Fitting;
    const MatrixXd& b = this->System.rightHandSide();
    const double squared = this->FirstSquaredResidual +
      parallelSum(x.size(), this->System.threads(),
        [&](std::int64_t begin, std::int64_t end)
        {
          double sum = 0;
          for (std::int64_t k = begin; k < end; ++k)
          {
            const double before = g0.data()[k];
            sum += (x.data()[k] - x0.data()[k]) * (g.data()[k] + before - 2 * b.data()[k]);
          }
          return sum;
        });
    history.FittingError.push_back(std::sqrt(std::max(squared, 0.0) / this->DataCount));
    return norm <= this->RoundingNorm ? 0.0 : error;
  }

  /// True to go on to one more iteration from a state of that error.
  bool proceed(double error)
  {
    const int done = this->Result.NumberOfIterations;
    const double tolerance = this->Options.Tolerance;
    if (!(error <= DivergedError))
    {
      this->Result.Status = FairingStatus::Diverged;
      return false;
    }
    if (error == 0 || error < tolerance)
    {
      this->Result.Status = FairingStatus::Converged;
      return false;
    }
    if (done >= this->Options.MaximumNumberOfIterations)
    {
      this->Result.Status = tolerance > 0 ? FairingStatus::NotConverged : FairingStatus::AllDone;
      return false;
    }
    const double byCount = double(done) / this->Options.MaximumNumberOfIterations;
    const double byError =
      tolerance > 0 && tolerance < 1 && error < 1 ? std::log(error) / std::log(tolerance) : 0.0;
    this->Share = std::max({ this->Share, byCount, byError });
    if (this->Progress && !this->Progress(this->Share))
    {
      this->Result.Status = FairingStatus::Aborted;
      return false;
    }
    ++this->Result.NumberOfIterations;
    return true;
  }

  /// mu_j; 0 for control points that no data and no energy touch.
  Vector stepSizes() const
  {
    if (this->Options.StepSize > 0)
    {
      return Vector::Constant(this->System.size(), this->Options.StepSize);
    }
    Vector sizes = this->System.absoluteRowSums();
    for (double& size : sizes)
    {
      size = size > 0 ? 1 / size : 0.0;
    }
    return sizes;
  }

  void progressiveIteration()
  {
    const Vector mu = this->stepSizes();
    for (double error = this->firstError(); this->proceed(error); error = this->record())
    {
      this->forEach([&](std::int64_t j, Eigen::Index c)
        { this->Current.X(j, c) += mu[j] * this->Residual(j, c); });
      this->System.apply(this->Current.X, this->Current.Fitting, this->Current.Fairing);
      this->updateResidual();
    }
  }

  /// y = A M x with what it is made of, on the control points that move.
  void product(const Vector& mu, const MatrixXd& x, State& scaled, MatrixXd& y) const
  {
    const Vector& w = this->System.weights();
    scaled.X.resize(x.rows(), 3);
    y.resize(x.rows(), 3);
    this->forEach([&](std::int64_t j, Eigen::Index c) { scaled.X(j, c) = mu[j] * x(j, c); });
    this->System.apply(scaled.X, scaled.Fitting, scaled.Fairing);
    this->forEach(
      [&](std::int64_t j, Eigen::Index c)
      {
        y(j, c) = this->isMovable(j)
          ? (1 - w[j]) * scaled.Fitting(j, c) + w[j] * scaled.Fairing(j, c)
          : 0.0;
      });
  }

  void advance(double step, const State& direction)
  {
    this->forEach(
      [&](std::int64_t j, Eigen::Index c)
      {
        this->Current.X(j, c) += step * direction.X(j, c);
        this->Current.Fitting(j, c) += step * direction.Fitting(j, c);
        this->Current.Fairing(j, c) += step * direction.Fairing(j, c);
      });
  }

  void biconjugateGradient()
  {
    // Van der Vorst 1992, with right preconditioning, so that the residual is the true one.
    const Vector mu = this->stepSizes();
    MatrixXd shadow = this->Residual, p = this->Residual, v, t;
    State alongP, alongS;
    double rho = this->dot(shadow, this->Residual);
    for (double error = this->firstError(); this->proceed(error); error = this->record())
    {
      this->product(mu, p, alongP, v);
      const double slope = this->dot(shadow, v);
      const double alpha = rho / slope;
      if (slope == 0 || !std::isfinite(alpha))
      {
        return this->breakDown();
      }
      this->forEach(
        [&](std::int64_t j, Eigen::Index c) { this->Residual(j, c) -= alpha * v(j, c); });
      this->advance(alpha, alongP);
      this->product(mu, this->Residual, alongS, t);
      const double squared = this->dot(t, t);
      const double omega = squared > 0 ? this->dot(t, this->Residual) / squared : 0.0;
      this->advance(omega, alongS);
      this->forEach(
        [&](std::int64_t j, Eigen::Index c) { this->Residual(j, c) -= omega * t(j, c); });
      const double next = this->dot(shadow, this->Residual);
      const double beta = next / rho * alpha / omega;
      if (next == 0 || omega == 0 || !std::isfinite(beta))
      {
        if (this->record() != 0)
        {
          return this->breakDown();
        }
        this->Result.Status = FairingStatus::Converged;
        return;
      }
      rho = next;
      this->forEach([&](std::int64_t j, Eigen::Index c)
        { p(j, c) = this->Residual(j, c) + beta * (p(j, c) - omega * v(j, c)); });
    }
  }

  /// There is no next direction: nothing is left to do, or the method ends here.
  void breakDown()
  {
    this->Result.Status =
      this->Options.Tolerance > 0 ? FairingStatus::NotConverged : FairingStatus::AllDone;
  }

  void sparseDirect()
  {
    const Vector& w = this->System.weights();
    std::vector<std::int64_t> unknown(static_cast<std::size_t>(this->System.size()), -1);
    std::int64_t n = 0;
    for (std::int64_t j = 0; j < this->System.size(); ++j)
    {
      if (this->isMovable(j))
      {
        unknown[static_cast<std::size_t>(j)] = n++;
      }
    }
    if (!this->proceed(this->firstError()))
    {
      return;
    }
    const bool symmetric = w.minCoeff() == w.maxCoeff();
    std::vector<Eigen::Triplet<double>> entries;
    MatrixXd side(n, 3);
    for (std::int64_t j = 0; j < this->System.size(); ++j)
    {
      const std::int64_t row = unknown[static_cast<std::size_t>(j)];
      if (row < 0)
      {
        continue;
      }
      side.row(row) = this->Residual.row(j);
      this->System.visitRow(j,
        [&](std::int64_t l, double g, double d)
        {
          const std::int64_t column = unknown[static_cast<std::size_t>(l)];
          const double value = (1 - w[j]) * g + w[j] * d;
          if (column >= 0 && value != 0 && (!symmetric || column <= row))
          {
            entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
          }
        });
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    entries = {};
    bool solved = false;
    if (symmetric)
    {
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
      solved = this->solveAndRefine(factors, unknown, side);
    }
    else
    {
      Eigen::SparseLU<Eigen::SparseMatrix<double>> factors(matrix);
      solved = this->solveAndRefine(factors, unknown, side);
    }
    const double error = this->record();
    const bool small = error <= LargestDirectError || this->residualIsRounding();
    this->Result.Status = solved && small ? FairingStatus::Converged : FairingStatus::Singular;
  }

  /// Moves the control points that @a unknown numbers by the solution for @a side, then by that for
  /// the residual it leaves. False if the second step shows that the first means nothing.
  template <typename Factors>
  bool solveAndRefine(
    const Factors& factors, const std::vector<std::int64_t>& unknown, MatrixXd side)
  {
    for (const bool refinement : { false, true })
    {
      if (factors.info() != Eigen::Success)
      {
        return false;
      }
      const MatrixXd step = factors.solve(side);
      if (!step.allFinite())
      {
        return false;
      }
      double squaredSize = 0;
      for (std::int64_t j = 0; j < this->System.size(); ++j)
      {
        const std::int64_t row = unknown[static_cast<std::size_t>(j)];
        if (row >= 0)
        {
          this->Current.X.row(j) += step.row(row);
          squaredSize += this->Current.X.row(j).squaredNorm();
        }
      }
      this->System.apply(this->Current.X, this->Current.Fitting, this->Current.Fairing);
      this->updateResidual();
      if (refinement)
      {
        return step.norm() <= LargestRefinement * std::sqrt(squaredSize);
      }
      for (std::int64_t j = 0; j < this->System.size(); ++j)
      {
        const std::int64_t row = unknown[static_cast<std::size_t>(j)];
        if (row >= 0)
        {
          side.row(row) = this->Residual.row(j);
        }
      }
    }
    return true;
  }

  /// The residual is no larger than the rounding of A P and of the right-hand side.
  bool residualIsRounding() const
  {
    const Vector sums = this->System.absoluteRowSums();
    const double size = sums.norm() * this->Current.X.cwiseAbs().maxCoeff() +
      std::sqrt(this->dot(this->System.rightHandSide(), this->System.rightHandSide()));
    return std::sqrt(this->dot(this->Residual, this->Residual)) <= Rounding * size;
  }

  /// The error of the state that the history has already.
  double firstError() const { return this->FirstNorm <= this->RoundingNorm ? 0.0 : 1.0; }

  const FairingSystem& System;
  const FairingOptions& Options;
  const ProgressCallback& Progress;
  MatrixXd& Points;
  const double DataCount;
  const double FirstSquaredResidual;
  State Current, First;
  MatrixXd Residual;
  double FirstNorm = 0;
  double RoundingNorm = 0;
  double Share = 0;
  FairingResult Result;
};
}

FairingResult iterateFairing(const FairingSystem& system, const Eigen::MatrixXd& residuals,
  const FairingOptions& options, TensorSpline& spline, const ProgressCallback& progress)
{
  return Iteration(system, residuals, options, spline, progress).run();
}
}
