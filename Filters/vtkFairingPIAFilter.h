// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFairingPIAFilter
 * @brief   what the filters for fair B-spline curves and surfaces share
 *
 * Abstract; see vtkFairingPIACurveFilter and vtkFairingPIASurfaceFilter.
 *
 * ### Method
 * Data points Q with parameters in [0, 1] are approximated by a B-spline with control points P.
 * With N the collocation matrix, D the matrix of the energy of derivatives of order r and Omega =
 * diag(omega_j) one fairing weight per control point, 0 for fitting alone to 1 for fairing alone,
 * fairing-PIA takes
 *
 *     P <- P + M [ (I - Omega) N^T (Q - N P) - Omega D P ],   M = diag(mu_j),
 *     mu_j = 1 / sum_l |A_jl|,   A = (I - Omega) N^T N + Omega D
 *
 * (Jiang and Lin, eq. 4 and 23), whose limit solves A P = (I - Omega) N^T Q. With equal weights
 * that is the minimiser of (1 - omega) sum |Q - P(t)|^2 + omega E, the classical fair curve or
 * surface. Energies refer to parameters in [0, 1], so that a weight has the same effect whatever
 * the units of length. Equal weights always converge. Unequal ones converge where A is diagonally
 * dominant, and as a rule also elsewhere; the filter watches the iteration error, warns if the
 * tolerance was not reached, and refuses a result that diverged.
 *
 * ### Weights
 * The user's always come first: a point array of the data, SetInputArrayToProcess(0, 0, ...), each
 * control point taking the mean of the values in its support, weighted by its basis function; or
 * one value per control point, the array `FairingWeight` of input port 1 (SetInputArrayToProcess(1,
 * 1,
 * ...) for another). Without either, all control points have FairingWeight, except those that
 * AutomaticFairing chooses.
 *
 * ### Rounds
 * Input port 1 takes output 1 of an earlier round: control points, knots and weights to go on with,
 * where Degree, number of control points and knots are those of the earlier round. Edit its
 * `FairingWeight`, insert knots (which leaves the curve or surface as it is), and update. Each
 * round solves for all control points, so that a change fades away from where weights were changed
 * but is nowhere exactly 0. With an array of control points that may move,
 * SetInputArrayToProcess(2, 1,
 * ...), values other than 0, all others stay as they are, and the curve or surface changes in
 * the supports of those alone.
 *
 * ### Errors
 * Refused with one error and empty outputs: weights outside [0, 1], too few points, coinciding
 * neighbours where parameters depend on distances, parameters that are unsorted or outside [0, 1],
 * values that are not finite, points whose extent is not from 1e-100 to 1e100, lines and grids that
 * do not fit their points, arrays that are not there, hold no numbers, are not of points or have
 * not one tuple per point, control points of an earlier round that do not fit or are none at all,
 * different knots nearer than 1e-12 to each other, what the machine's memory would not hold,
 * divergence, and equations without a unique solution (Solver). An array is none by the names ""
 * and "None". A knot to be inserted that differs from another by less than 1e-12 counts as that
 * one. One warning tells that the tolerance was not reached. An abort leaves empty outputs.
 *
 * Blanking and ghost arrays are ignored: all points count. Each block of a composite is an input of
 * its own; an empty one is refused as an input without points.
 *
 * ### Threads and reproducibility
 * The fit runs on OpenMP threads (OMP_NUM_THREADS). Results do not depend on their number, bit for
 * bit.
 *
 * Y. Jiang, H. Lin: Fairing-PIA: progressive-iterative approximation for fairing curve and surface
 * generation, 2022.
 *
 * @sa vtkFairingPIACurveFilter vtkFairingPIASurfaceFilter
 */
#ifndef vtkFairingPIAFilter_h
#define vtkFairingPIAFilter_h

#include "vtkFiltersIPIAModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

#include <string> // for std::string
#include <vector> // for std::vector

namespace ipia
{
struct FairingParameters;
class FairingRound;
}

class VTKFILTERSIPIA_EXPORT vtkFairingPIAFilter : public vtkPolyDataAlgorithm
{
public:
  vtkAbstractTypeMacro(vtkFairingPIAFilter, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Control points of an earlier round (port 1, optional), output 1 of this filter.
   */
  void SetControlPointsConnection(vtkAlgorithmOutput* output);
  void SetControlPointsData(vtkPolyData* controlPoints);
  ///@}

  ///@{
  /**
   * Degree of the B-splines, 1 to 5, default 3. An earlier round on port 1 has its own.
   */
  vtkSetClampMacro(Degree, int, 1, 5);
  vtkGetMacro(Degree, int);
  ///@}

  ///@{
  /**
   * Order r of the derivatives whose energy is kept low, 1 to 3, no more than the degree,
   * default 2. Curves: stretch, strain or jerk, the integral of |P^(r)|^2. Surfaces: membrane S_u^2
   * + S_v^2, thin plate S_uu^2 + 2 S_uv^2 + S_vv^2, and S_uuu^2 + 3 S_uuv^2 + 3 S_uvv^2 + S_vvv^2.
   */
  vtkSetClampMacro(DerivativeOrder, int, 1, 3);
  vtkGetMacro(DerivativeOrder, int);
  ///@}

  /// Where the parameters of the data come from.
  enum Parametrizations
  {
    Uniform = 0,     ///< equal steps
    Chord = 1,       ///< steps as the distances of neighbours (default)
    Centripetal = 2, ///< steps as the square roots of the distances
    Given = 3        ///< SetInputArrayToProcess(3, 0, ...), values in [0, 1]
  };

  ///@{
  /**
   * Parameters of the data points. Default Chord.
   */
  vtkSetClampMacro(Parametrization, int, Uniform, Given);
  vtkGetMacro(Parametrization, int);
  void SetParametrizationToUniform() { this->SetParametrization(Uniform); }
  void SetParametrizationToChord() { this->SetParametrization(Chord); }
  void SetParametrizationToCentripetal() { this->SetParametrization(Centripetal); }
  void SetParametrizationToGiven() { this->SetParametrization(Given); }
  ///@}

  ///@{
  /**
   * omega of control points that nothing else gives a weight, in [0, 1], default 1e-6.
   */
  vtkSetMacro(FairingWeight, double);
  vtkGetMacro(FairingWeight, double);
  ///@}

  /// How control points to fair are chosen, where the user gives no weights.
  enum AutomaticFairings
  {
    Off = 0, ///< not at all (default)
    /// By second differences of the data, |Q_{i-1} - 2 Q_i + Q_{i+1}|, as section 5.2 of the paper;
    /// of scattered data by those of the control net with FairingWeight alone.
    SecondDifference = 1,
    /// By |d kappa / ds| (surfaces: |grad H|) of the curve with FairingWeight alone, its root mean
    /// square in the support of each control point.
    CurvatureVariation = 2
  };

  ///@{
  /**
   * The AutomaticShare of the control points for which the measure is largest get
   * AutomaticFairingWeight. Default Off. In a later round the weights on port 1 are the user's;
   * SetInputArrayToProcess(1, 1, 0, ..., "") takes none from there.
   */
  vtkSetClampMacro(AutomaticFairing, int, Off, CurvatureVariation);
  vtkGetMacro(AutomaticFairing, int);
  void SetAutomaticFairingToOff() { this->SetAutomaticFairing(Off); }
  void SetAutomaticFairingToSecondDifference() { this->SetAutomaticFairing(SecondDifference); }
  void SetAutomaticFairingToCurvatureVariation() { this->SetAutomaticFairing(CurvatureVariation); }
  ///@}

  ///@{
  /**
   * The share of control points that AutomaticFairing chooses, in [0, 1], default 0.25, and their
   * weight, in [0, 1], default 1e-4.
   */
  vtkSetMacro(AutomaticShare, double);
  vtkGetMacro(AutomaticShare, double);
  vtkSetMacro(AutomaticFairingWeight, double);
  vtkGetMacro(AutomaticFairingWeight, double);
  ///@}

  /// Ways to the control points.
  enum Solvers
  {
    ProgressiveIteration = 0, ///< the paper's step (default)
    BiconjugateGradient = 1,  ///< stabilised, to the same limit in fewer iterations
    SparseDirect = 2          ///< factorisation of A: the classical minimisation of the energy
  };

  ///@{
  /**
   * Default ProgressiveIteration. SparseDirect refines its solution once, and refuses it as not
   * unique if it is not finite, if the refinement moves the control points by more than 1e-3 of
   * their size, which is to say that rounding times the condition of A leaves fewer than three
   * digits, or if more than 1e-6 of the iteration error is left and that is not rounding of A P.
   * Such are a FairingWeight of 1, where A = D does not see polynomials of low degree, and one of 0
   * with as many control points as data. ProgressiveIteration keeps what A does not see.
   */
  vtkSetClampMacro(Solver, int, ProgressiveIteration, SparseDirect);
  vtkGetMacro(Solver, int);
  void SetSolverToProgressiveIteration() { this->SetSolver(ProgressiveIteration); }
  void SetSolverToBiconjugateGradient() { this->SetSolver(BiconjugateGradient); }
  void SetSolverToSparseDirect() { this->SetSolver(SparseDirect); }
  ///@}

  ///@{
  /**
   * The iteration ends when its error, |(I - Omega) N^T (Q - N P) - Omega D P| over that at the
   * beginning, is below Tolerance (>= 0, default 1e-6; 0: never), at the latest after
   * MaximumNumberOfIterations (>= 1, default 1000).
   */
  vtkSetClampMacro(MaximumNumberOfIterations, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumNumberOfIterations, int);
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * One mu for all control points; 0 (the default): mu_j = 1 / sum_l |A_jl|. With equal weights any
   * below 2 / lambda_max(A) converges.
   */
  vtkSetMacro(StepSize, double);
  vtkGetMacro(StepSize, double);
  ///@}

  ///@{
  /**
   * Results of the last update, also as field data of output 0, which has the histories besides
   * (`IterationErrorHistory`, `FittingErrorHistory`, `FairingEnergyHistory`; those of several
   * curves one after the other, beginning at `HistoryOffsets`). FittingError is sqrt(sum |Q -
   * P(t)|^2 / m), world units, over all data points; FairingEnergy P^T D P, world units squared,
   * the sum over curves; NumberOfIterationsUsed and IterationError the largest of all curves. 0
   * after a refusal.
   */
  vtkGetMacro(FittingError, double);
  vtkGetMacro(FairingEnergy, double);
  vtkGetMacro(NumberOfIterationsUsed, int);
  vtkGetMacro(IterationError, double);
  ///@}

protected:
  vtkFairingPIAFilter();
  ~vtkFairingPIAFilter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

  /// Reads the input, runs the rounds and writes the outputs; returns why nothing came out, or
  /// nothing.
  virtual std::string Fair(vtkInformationVector** input, vtkInformationVector* output,
    const ipia::FairingParameters& parameters) = 0;

  /// Empties the outputs; the results are 0.
  void Clear(vtkInformationVector* output);
  /// True if the user aborted; the outputs are emptied then.
  bool Report(double share);
  void SetResults(const std::vector<ipia::FairingRound>& rounds);

  int Degree;
  int DerivativeOrder;
  int Parametrization;
  double FairingWeight;
  int AutomaticFairing;
  double AutomaticShare;
  double AutomaticFairingWeight;
  int Solver;
  int MaximumNumberOfIterations;
  double Tolerance;
  double StepSize;

  double FittingError;
  double FairingEnergy;
  int NumberOfIterationsUsed;
  double IterationError;
  bool Aborted;

private:
  vtkFairingPIAFilter(const vtkFairingPIAFilter&) = delete;
  void operator=(const vtkFairingPIAFilter&) = delete;

  ipia::FairingParameters Parameters() const;
};

#endif
