// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The linear system of fairing-PIA, for curves and tensor-product surfaces.
 *
 * H. Jiang, H. Lin: Fairing-PIA: progressive iterative approximation for fairing curve and surface
 * generation, 2022.
 */
#ifndef ipia_FairingSystem_h
#define ipia_FairingSystem_h

#include "TensorSpline.h"

#include <vector>

namespace ipia
{
/**
 * Data points Q with parameters in [0, 1]. Gridded: Parameters[0] and [1] belong to the rows and
 * columns of a grid, m = m_0 m_1, those along axis 0 fastest; a curve is a grid with one row,
 * Parameters[1] = (0). Scattered: both are m long.
 */
struct FairingData
{
  Eigen::MatrixXd Points; ///< m by 3
  std::array<Vector, 2> Parameters;
  bool Gridded = true;
};

/**
 * A P = (I - Omega) N^T Q with A = (I - Omega) N^T N + Omega D.
 *
 * N is the collocation matrix of the data, Omega = diag(omega_j) the fairing weights in [0, 1], one
 * per control point, and D the matrix of the energy of order r: for curves
 * (D)_jl = int N_j^(r) N_l^(r) dt, so that P^T D P is the stretch (r = 1), strain (2) or jerk (3)
 * energy; for surfaces that of sum_k (r over k) |d^r S / du^(r-k) dv^k|^2, membrane (1) or thin
 * plate energy (2), S_uu^2 + 2 S_uv^2 + S_vv^2.
 *
 * No matrix of the surface is ever formed: gridded data and the energy are sums of Kronecker
 * products of band matrices, scattered data a band of bands.
 */
class FairingSystem
{
public:
  /**
   * @param weights  omega, one per control point
   * @param order    r, 1 to 3
   * @param threads  0: OpenMP's choice. Results do not depend on it.
   */
  FairingSystem(const std::array<BSplineBasis, 2>& axes, const FairingData& data,
    const Vector& weights, int order, int threads);

  std::int64_t size() const { return this->Weights.size(); }
  const Vector& weights() const { return this->Weights; }
  int threads() const { return this->Threads; }

  /// N^T Q, size() by 3.
  const Eigen::MatrixXd& rightHandSide() const { return this->DataSide; }

  /// N^T N @a x and D @a x, size() by 3. Not to be called from two threads at once.
  void apply(const Eigen::MatrixXd& x, Eigen::MatrixXd& fitting, Eigen::MatrixXd& fairing) const;

  /**
   * Calls @a visit(l, g, d) for the entries (j, l) of N^T N and D that can be other than 0, once
   * each, or more often where a closed axis is shorter than its band; then they add up.
   */
  template <typename Visitor>
  void visitRow(std::int64_t j, const Visitor& visit) const
  {
    const std::int64_t columns = this->Axes[0].size();
    const std::int64_t i = j % columns, row = j / columns;
    const int p = this->Axes[0].degree(), q = this->Axes[1].degree();
    for (int dv = -q; dv <= q; ++dv)
    {
      const std::int64_t toRow = this->Gram[1].column(row, dv);
      for (int du = -p; toRow >= 0 && du <= p; ++du)
      {
        const std::int64_t to = this->Gram[0].column(i, du);
        if (to >= 0)
        {
          visit(to + columns * toRow, this->fittingEntry(i, row, du, dv),
            this->fairingEntry(i, row, du, dv));
        }
      }
    }
  }

  /// sum_l |A_jl| of each row.
  Vector absoluteRowSums() const;

private:
  struct EnergyTerm
  {
    double Factor;
    BandMatrix Along[2];
  };

  void addScatteredData(const FairingData& data);
  void addGriddedData(const FairingData& data);
  double fittingEntry(std::int64_t i, std::int64_t row, int du, int dv) const;
  double fairingEntry(std::int64_t i, std::int64_t row, int du, int dv) const;
  void addAcross(const BandMatrix& matrix, double factor, const Eigen::MatrixXd& along,
    std::int64_t row, Eigen::Index coordinate, Eigen::MatrixXd& result) const;

  std::array<BSplineBasis, 2> Axes;
  Vector Weights;
  int Threads;
  bool Gridded;
  BandMatrix Gram[2]; ///< N^T N of each axis of gridded data; of scattered ones the shape alone
  /// Of scattered data: block (row, row + dv) of N^T N is Blocks[row (2 q + 1) + dv + q].
  std::vector<BandMatrix> Blocks;
  std::vector<EnergyTerm> Terms;
  Eigen::MatrixXd DataSide;
  mutable std::vector<Eigen::MatrixXd> Along; ///< kept, as it is needed in every iteration
};

/// Q - N P at the data, m by 3.
Eigen::MatrixXd fittingResiduals(const TensorSpline& spline, const FairingData& data, int threads);

/// E_fit = sqrt(sum |Q - P(t)|^2 / m).
double rootMeanSquare(const Eigen::MatrixXd& residuals);

/// P^T D P for order r = 1, 2 or 3, the energy of the spline; see FairingSystem.
double fairingEnergy(const TensorSpline& spline, int order);

/**
 * Values at the data points as values of control points: for each the mean, weighted by its basis
 * function, sum_i N_j(t_i) x_i / sum_i N_j(t_i); @a otherwise where no data point is in its
 * support. Stays within the range of the values.
 */
Vector carryToControlPoints(const std::array<BSplineBasis, 2>& axes, const FairingData& data,
  const Vector& values, double otherwise);
}

#endif
