// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIPIAImplicitFitter
 * @brief   fit an implicit B-spline function to oriented points by I-PIA
 *
 * vtkIPIAImplicitFitter turns points with oriented normals into a function f whose zero set is the
 * surface (3-D) or curve (2-D) through the points, sampled as a vtkImageData. Who wants the surface
 * itself takes vtkIPIASurfaceReconstruction; a contour filter makes it from the image:
 *
 * @code
 *   vtkNew<vtkIPIAImplicitFitter> fitter;
 *   fitter->SetInputConnection(points->GetOutputPort()); // vtkPolyData with point normals
 *   vtkNew<vtkFlyingEdges3D> surface;                    // vtkContourFilter in the plane
 *   surface->SetInputConnection(fitter->GetOutputPort());
 *   surface->SetValue(0, 0.0);
 *   surface->Update();
 * @endcode
 *
 * Points without normals get them from vtkPCANormalEstimation first.
 *
 * ### Method
 * f(x) = sum_i C_i B_i(x) is a tensor-product cubic B-spline on a uniform lattice. Each point p_k
 * with unit normal n_k and weight w_k gives rows of a linear least-squares problem, f(p_k) = 0 and
 * those of the normal (NormalConstraint).
 *
 * By default the lattice is the finest of a hierarchy, each of half the spacing of the one before.
 * With gradient rows, grad f(p_k) = n_k, and a fairing energy each level is solved by conjugate
 * gradients from the exact knot refinement of the level before: coarse levels everywhere, so that f
 * has the right sign far from the data and across holes, fine ones in a band around the data. Noise
 * is found and smoothed by cross-validation. Documentation/Method.md has the equations.
 *
 * On a single level (NumberOfLevels 1) with offset rows, f(p_k + sigma n_k) = epsilon and on
 * request f(p_k - sigma n_k) = -epsilon, the fit is the paper's. With B the collocation matrix of
 * the rows, implicit progressive-iterative approximation takes
 *
 *     C <- C + mu B^T W (b - B C),   C = 0 at first,   mu = 2 / max_i sum_k w_k B_i(x_k)
 *
 * (Hamza, Lin, Li, eq. 11 and 16; remarks 3.1 and 3.2), whose limit is the least-squares solution
 * of least norm, (B^T W B)^+ B^T W b (theorem 3.4). Conjugate gradients reach the same limit in
 * fewer iterations.
 *
 * ### Rational splines and oscillation
 * With BasisType UniformRational (Huang, 2024)
 *
 *     f(x) = sum_i C_i R_i(x),   R_i(x) = w_i B_i(x) / sum_j w_j B_j(x),   w_i >= 0, 1 at first.
 *
 * Each iteration takes w <- max(w - tau grad_w E, 0) and then the step above with the collocation
 * matrix of the R_i. OscillationWeight lambda adds the oscillation R(C) of the coefficients to the
 * energy, so that f is smoother where no data are and has fewer extra sheets there, with either
 * basis. Both belong to a single level with offset rows. Documentation/RationalSplines.md tells
 * when they help.
 *
 * f < 0 inside and f > 0 outside, where the normals point to, as for vtkImplicitFunction; near the
 * data f approximates signed distance in world units as long as OffsetValue is 0.
 *
 * ### Far field
 * On a single level, where no row touches a coefficient it stays 0, and contour filters would draw
 * a second sheet along the inner side of the data; ripples beside the data would become bubbles.
 * The sign of f therefore holds only where data vouch for it: just outside and just inside the
 * points, and wherever these lead through supported places without a change of sign. Every
 * connected region of other places takes a constant, the OffsetValue used, with the sign of what is
 * around it, where f has the other sign or no support.
 *
 * Places are boxes of half a knot spacing about the knots and the middles between them, on which
 * the default samples lie. Supported are those where sum_i B_i sum_c B_i(x_c), over the centres
 * x_c of the knot cells that hold rows, is at least 1/50 of its median at the data. A region that
 * meets both signs keeps the spline down to 1/25 of that support, so that small holes close; what
 * is left and still meets both (an open surface, a wide hole) takes the sign of the larger share
 * and a warning says so. Boxes beside a constant with no other sign around them take it as well.
 *
 * ### Point arrays
 * The point arrays of the input (colours, scalars, vectors) become functions in space, on output 0
 * beside f, so that vtkFlyingEdges3D with InterpolateAttributes carries them to the contour. Per
 * component
 *
 *     v(x) = min(max(a + b x + sum_i D_i B_i(x), low), high),
 *
 * a least-squares linear function and a spline of what it leaves, on the levels of the hierarchy
 * and the domain of f. Each level minimises sum_k w_k (v(p_k) - v_k)^2 + tau sum |D^2 D_i|^2; where
 * there are no data v is filled smoothly from around. low and high are the least and greatest
 * value, so that colours stay colours. Noise is smoothed: of all levels and larger tau those are
 * taken that predict the values of every eighth point, held out, best.
 *
 * Arrays keep name, type and components; integral types are rounded. GetPointDataArraySelection
 * chooses them, by default all numeric ones with a name, but normals, weights and local fairing
 * weights that the fit uses, global and pedigree ids, and ghosts. In a composite input they belong
 * together by name; where a block lacks an array, or values are not finite (one warning counts
 * these), its points say nothing about it. Arrays of a name that a result has itself are left out,
 * with a warning. Neither their choice nor their values change f.
 *
 * ### Input
 * Port 0: vtkPolyData, of which the points are used (cells are not), or a composite data set of
 * them, all of whose blocks make one fit. SetInputArrayToProcess: 0, the normals (3 components;
 * default: the active point normals); 1, optional row weights w_k >= 0 (1 component), for each
 * point or, with FIELD_ASSOCIATION_NONE, one for all points of a block in its field data; 3,
 * optional local fairing weights > 0 (1 component, of the hierarchy): around points where it is 10
 * the fairing energy counts tenfold against the data, so that f is smoother there, where it is 0.1
 * a tenth; 1 is as without. Any numeric type. Normals need not have unit length. An array that is
 * named and not there is refused.
 *
 * Port 1, optional: vtkPolyData with more rows, points at which f shall take a given value, of
 * weight
 * 1. SetInputArrayToProcess 2 (port 1): the values (default: the active point scalars).
 *
 * ### Overlapping scans
 * Range scanners err most where a scan ends: at silhouettes and grazing angles the beam meets the
 * surface only in part, and so do the neighbours that normals are estimated from. As in merging of
 * range images (Turk, Levoy 1994; Curless, Levoy 1996) the points of a composite input, whose
 * blocks are scans, are feathered (FeatherScans). s_k is the distance of point k from the mean of
 * itself and the 32 nearest points of its scan, over the distance of the farthest of them: about 0
 * within the scan and 0.4 and more at its border. Its confidence is
 *
 *     c_k = 0.05 + 0.95 exp(-(s_k / 0.1)^2),
 *
 * and its weight is multiplied by min(c_k / c, 1), at least 0.05, where c is the largest confidence
 * of the points of other scans that cover it: the nearest of each, if it is within two spacings and
 * the normals within 60 degrees. The spacing of a scan is the median distance of the fourth
 * neighbours of its points; that of the two scans which is wider counts. What only one scan has
 * seen counts fully.
 *
 * ### Adding points
 * With Incremental, points that are appended to the input, or blocks to a composite one, are added
 * to the last fit: the coefficients near them are solved for, from their last values, the others
 * stay. That takes a fraction of a fit's time, and ends within 1e-3 of its f (of the longest side,
 * root mean square within two knot spacings of the points), usually much nearer. The lattice
 * must be the same: fix ModelBounds and GridSize, as an automatic domain grows with the points.
 *
 * Otherwise, and where it cannot be, all is fitted again, and NumberOfPointsAdded is 0: where
 * domain, grid size or a parameter of the fit are not those of the last fit; points of it are
 * missing, not in front, or have other positions, normals, weights or local fairing weights, bit
 * for bit; with offset rows; where extra rows have changed. The smoothing length stays that of the
 * last fit; where it is not 0, or points were too sparse to tell, all is fitted again once there
 * are twice as many points, and where it is 0, once added points are noisy. So it is where added
 * points have outliers or flipped normals, and where they are so much denser that a lattice finer
 * than the points would be faired as for half as much again. In the plane as in space.
 *
 * After an addition Energy, NumberOfIterationsUsed and ResidualHistory are of the rows near the
 * added points, and NoiseFound is made of the last one and that of the added points.
 *
 * ### Output
 * Port 0: vtkImageData with point scalars `f`, on request `Gradient` and `Support`, and the point
 * arrays of the input; the results below as field data. Origin and last point are the ends of the
 * domain. Any sub-extent can be asked for. Port 1: the points that were fitted, with all their
 * arrays, `Residual` (f), `Distance` (f / |grad f|), `NormalAgreement` (n . grad f / |grad f|,
 * negative where the normal points against f, 0 where there is none), `Outlier` (1 where the point
 * was left out as one, else 0) and, of overlapping scans, `Feathering` (the factor of its weight).
 * Port 2: the control lattice, a vtkImageData with point array `Coefficient`, with UniformRational
 * also `Weight`, origin lo - h, spacing h and dimensions N, on domain [lo, hi], and the far field
 * as field data: `FarField`, one signed char for each of the (2 (N_x - 3) + 1) (2 (N_y - 3) + 1) (2
 * (N_z - 3) + 1) boxes (no third factor in 2-D), x fastest, -1 or 1 where f is that sign times
 * `FarFieldMagnitude` (one double), 0 where the spline counts. vtkIPIAImplicitFunction takes it;
 * vtkImageBSplineInterpolator of degree 3 interpolates a spline without weights.
 *
 * ### Two dimensions
 * If all points lie in a plane and their normals in that plane, f is a bicubic spline in that plane
 * and the image has one slice. Otherwise the fit is tricubic. vtkContourFilter contours any slice
 * along axes; vtkFlyingEdges2D of VTK 9.1 takes each for one across z.
 *
 * A plane that is tilted, perpendicular to no axis (within 1e-6 of the longest side), is turned by
 * the smallest angle that brings an axis across it; there it is fitted, and placed back in space.
 * The image and the control lattice then have a direction matrix, GridSize, SampleDimensions and
 * ModelBoundsUsed are along its axes, ModelBounds must be unset, and f does not change across the
 * plane. vtkFlyingEdges2D and vtkFlyingEdges3D draw in such an image, filters that do not know
 * direction matrices draw in a wrong place.
 *
 * ### Faulty input
 * The hierarchy compares all points with the fit of its finest level that they overdetermine, of at
 * least 3 points per occupied cell. Points that are far from what the others agree on are outliers;
 * normals that point against the gradient and against those around them are flipped. Where these
 * are more than a few (0.05 and 0.5 %) the fit starts again without the outliers and without the
 * rows of the flipped normals. This is for up to about 5 % of outliers and up to a quarter of
 * normals that are flipped here and there. Outliers do not count for what follows a fit either,
 * such as point arrays and where a surface is trimmed. Normals that are flipped together on a whole
 * patch of the surface agree with their neighbours and are not found, nor are faults of points that
 * are too sparse for such a level. OutliersFound and FlippedNormalsFound are the shares; one
 * warning tells of outliers from 0.5 % on, of flipped normals from 1 % on, and of a closed surface
 * that is inside out: f is negative at the whole border of the domain. Scans from within, such as
 * of rooms, get that too, and are right.
 *
 * ### Errors
 * Refused with one error and empty outputs: no points, one point, all points equal or (in 3-D) on a
 * line, no or only zero normals, grid sizes below 4, sample dimensions below 2, bounds that are
 * empty or hold no point, parameters that exclude each other, a step size that diverges, and sizes
 * that the machine's memory would not hold. Left out with one warning that counts them: non-finite
 * points, weights or extra rows, zero or non-finite normals (their rows), points outside
 * ModelBounds. An abort leaves empty outputs.
 *
 * ### Threads and reproducibility
 * The fit runs on OpenMP threads (OMP_NUM_THREADS). Results do not depend on their number, bit for
 * bit.
 *
 * Y. F. Hamza, H. Lin, Z. Li: Implicit progressive-iterative approximation for curve and surface
 * reconstruction. Computer Aided Geometric Design 77, 2020.
 * S. Huang: Implicit uniform rational spline reconstruction method with regularization term. 2024.
 *
 * @sa vtkIPIASurfaceReconstruction vtkIPIAImplicitFunction vtkFlyingEdges3D vtkFlyingEdges2D
 * vtkContourFilter vtkPCANormalEstimation vtkSignedDistance
 */
#ifndef vtkIPIAImplicitFitter_h
#define vtkIPIAImplicitFitter_h

#include "vtkFiltersIPIAModule.h" // for the export macro
#include "vtkImageAlgorithm.h"

#include <array>      // for std::array
#include <functional> // for std::function
#include <memory>     // for std::unique_ptr
#include <vector>     // for std::vector

class vtkDataArraySelection;
class vtkFieldData;
class vtkIPIAImplicitFunction;
class vtkPolyData;

namespace ipia
{
class Frame;
class PointCloud;
struct FitParameters;
}

class VTKFILTERSIPIA_EXPORT vtkIPIAImplicitFitter : public vtkImageAlgorithm
{
public:
  static vtkIPIAImplicitFitter* New();
  vtkTypeMacro(vtkIPIAImplicitFitter, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * More rows (port 1, optional): points with target values of f.
   */
  void SetExtraRowsConnection(vtkAlgorithmOutput* output);
  void SetExtraRowsData(vtkPolyData* rows);
  ///@}

  ///@{
  /**
   * The domain, world units: (xmin, xmax, ymin, ymax, zmin, zmax). Invalid bounds (max < min, the
   * default) mean the bounds of the points, enlarged by Padding. Points outside are left out.
   */
  vtkSetVector6Macro(ModelBounds, double);
  vtkGetVector6Macro(ModelBounds, double);
  ///@}

  ///@{
  /**
   * Margin around the points of an automatic domain, as a multiple of their longest side; at least
   * two knot spacings are taken. >= 0, default 0.05.
   */
  vtkSetClampMacro(Padding, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Padding, double);
  ///@}

  ///@{
  /**
   * Control coefficients N per axis ("grid size" in the papers), each >= 4, or 0: derived. If all
   * are 0 (the default) the knot spacing is 0.85 times the point spacing, 1.6 times on a single
   * level with offset rows, with at most 256 spacings along the longest side. In an automatic
   * domain the spacing is the same on all axes and the upper end grows to a whole number of them;
   * ModelBounds are kept exactly.
   */
  vtkSetVector3Macro(GridSize, int);
  vtkGetVector3Macro(GridSize, int);
  ///@}

  ///@{
  /**
   * Sample points of output 0 per axis, each >= 2, or 0 (the default): 2 (N - 3) + 1, half the knot
   * spacing, but no more than 2^28 points in all.
   */
  vtkSetVector3Macro(SampleDimensions, int);
  vtkGetVector3Macro(SampleDimensions, int);
  ///@}

  ///@{
  /**
   * 2 or 3, or 0 (the default): 2 where points and normals lie in a plane.
   */
  vtkSetClampMacro(Dimension, int, 0, 3);
  vtkGetMacro(Dimension, int);
  ///@}

  /// How the normals enter.
  enum NormalConstraints
  {
    OutwardOffset = 0,  ///< f(p + sigma n) = epsilon, as in the 2019 paper
    TwoSidedOffset = 1, ///< and f(p - sigma n) = -epsilon
    Gradient = 2        ///< grad f(p) = n (default)
  };

  ///@{
  /**
   * The rows that a normal gives. Default Gradient.
   */
  vtkSetClampMacro(NormalConstraint, int, OutwardOffset, Gradient);
  vtkGetMacro(NormalConstraint, int);
  void SetNormalConstraintToOutwardOffset() { this->SetNormalConstraint(OutwardOffset); }
  void SetNormalConstraintToTwoSidedOffset() { this->SetNormalConstraint(TwoSidedOffset); }
  void SetNormalConstraintToGradient() { this->SetNormalConstraint(Gradient); }
  ///@}

  ///@{
  /**
   * Distance sigma of the offset rows from their point, world units. 0 (the default): 1.5 times the
   * largest knot spacing, less where that position would lie nearer to another data point.
   */
  vtkSetClampMacro(OffsetDistance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(OffsetDistance, double);
  ///@}

  ///@{
  /**
   * Value epsilon of f at the offset rows. 0 (the default): equal to their distance, so that f
   * approximates signed distance.
   */
  vtkSetClampMacro(OffsetValue, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(OffsetValue, double);
  ///@}

  ///@{
  /**
   * Distance and (absolute) value of the inward rows; 0 (the default): as outward.
   */
  vtkSetClampMacro(InwardOffsetDistance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(InwardOffsetDistance, double);
  vtkSetClampMacro(InwardOffsetValue, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(InwardOffsetValue, double);
  ///@}

  /// The functions that f is a combination of.
  enum BasisTypes
  {
    BSpline = 0,        ///< f = sum_i C_i B_i (default)
    UniformRational = 1 ///< f = sum_i C_i w_i B_i / sum_i w_i B_i; a single level with offset rows
  };

  ///@{
  /**
   * The basis. UniformRational has a weight w_i >= 0 for each coefficient, found with it by
   * ProgressiveIteration on a single level with offset rows; see "Rational splines" above. It is
   * refused with levels, gradient rows, conjugate gradients or fairing. Default BSpline.
   */
  vtkSetClampMacro(BasisType, int, BSpline, UniformRational);
  vtkGetMacro(BasisType, int);
  void SetBasisTypeToBSpline() { this->SetBasisType(BSpline); }
  void SetBasisTypeToUniformRational() { this->SetBasisType(UniformRational); }
  ///@}

  ///@{
  /**
   * Step size tau of the weights of UniformRational, in 1 / (units of f)^2, finite, >= 0; default
   * 0.01. 0 leaves them 1. A step that would make a denominator 0 or the energy grow is taken with
   * the first of tau / 2, tau / 4 ... that does not; WeightStepSizeUsed tells. Not used by BSpline.
   */
  vtkSetClampMacro(WeightStepSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(WeightStepSize, double);
  ///@}

  ///@{
  /**
   * Weight lambda of the oscillation R(C), the sum over coefficients of the squared differences to
   * their axis neighbours, which is then kept small together with E; finite, >= 0, without unit. 0
   * (the default): none. On a single level with offset rows, with either basis; refused with levels
   * or fairing.
   */
  vtkSetClampMacro(OscillationWeight, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(OscillationWeight, double);
  ///@}

  /// How OscillationWeight enters an iteration.
  enum OscillationSteps
  {
    Energy = 0,   ///< the minimiser of E + lambda R, for any lambda (default)
    AsPrinted = 1 ///< eq. 33 of the 2024 paper, for lambda < 1 / (8 Dimension)
  };

  ///@{
  /**
   * The step. With L C the sums of the differences to the neighbours (grad R = 4 L C) Energy takes
   * C <- C + mu [B^T W (b - B C) - 2 lambda L C], mu = 2 / (max_i sum_k w_k B_i(x_k) + 8 Dimension
   * lambda); conjugate gradients have the same limit. AsPrinted takes C <- C + mu B^T W (b - B C) -
   * 4 lambda L C with the mu of lambda 0, whose limit minimises E + (2 lambda / mu) R; a fit is
   * refused where lambda is not less than 1 / (8 Dimension) or that energy grows, and with
   * ConjugateGradient. Default Energy.
   */
  vtkSetClampMacro(OscillationStep, int, Energy, AsPrinted);
  vtkGetMacro(OscillationStep, int);
  void SetOscillationStepToEnergy() { this->SetOscillationStep(Energy); }
  void SetOscillationStepToAsPrinted() { this->SetOscillationStep(AsPrinted); }
  ///@}

  ///@{
  /**
   * Weight tau of the fairing energy of levels finer than 32 cells, tau sum |D^r c|^2 over
   * differences of neighbouring coefficients, where the rows of an occupied cell weigh about 1 in
   * all: the energy tau h^(2 r - dimension) integral |D^r f|^2. 0: none; -1 (the default):
   * automatic, 5e-5, on levels finer than the automatic lattice of the points times the fourth
   * power of the ratio of their spacings (up to 4), and more on noisy data, by cross-validation.
   * Less than 1e30.
   */
  vtkSetClampMacro(FairingWeight, double, -1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(FairingWeight, double);
  ///@}

  ///@{
  /**
   * Order r of the derivatives in a given FairingWeight's energy: 1 (membrane) or 2 (thin plate,
   * the default).
   */
  vtkSetClampMacro(FairingOrder, int, 1, 2);
  vtkGetMacro(FairingOrder, int);
  ///@}

  /// The iteration.
  enum Solvers
  {
    ProgressiveIteration = 0, ///< C <- C + mu B^T W (b - B C); a single level with offset rows only
    ConjugateGradient = 1     ///< the same limit in fewer iterations (default)
  };

  ///@{
  /**
   * The solver. Default ConjugateGradient.
   */
  vtkSetClampMacro(Solver, int, ProgressiveIteration, ConjugateGradient);
  vtkGetMacro(Solver, int);
  void SetSolverToProgressiveIteration() { this->SetSolver(ProgressiveIteration); }
  void SetSolverToConjugateGradient() { this->SetSolver(ConjugateGradient); }
  ///@}

  ///@{
  /**
   * Number of lattice levels. 0 (the default): as many as halve the lattice down to 16 cells. 1: a
   * single one, with offset rows exactly the method of the 2019 paper. With fewer than 0 gives, the
   * coarsest lattice does not carry the sides of the surface into the whole domain, and false
   * sheets appear far from the data.
   */
  vtkSetClampMacro(NumberOfLevels, int, 0, 20);
  vtkGetMacro(NumberOfLevels, int);
  ///@}

  ///@{
  /**
   * Iterations at most, of the finest level. 0 (the default): 12; on a single level with offset
   * rows 100 progressive iterations or 15 of conjugate gradients.
   */
  vtkSetClampMacro(MaximumNumberOfIterations, int, 0, VTK_INT_MAX);
  vtkGetMacro(MaximumNumberOfIterations, int);
  ///@}

  ///@{
  /**
   * The iteration ends when the measure of StoppingRule falls below this. 0 (the default): all
   * given iterations are done; where their number is automatic, the hierarchy stops at 1e-3. Below
   * 1 for RelativeResidual.
   */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}

  /// What Tolerance is compared with.
  enum StoppingRules
  {
    RelativeResidual = 0, ///< ||B^T W r|| / ||B^T W r0|| (default)
    EnergyChange = 1      ///< |E_new - E_old|, the rule of the 2024 paper
  };

  ///@{
  /**
   * The measure that Tolerance bounds. Default RelativeResidual.
   */
  vtkSetClampMacro(StoppingRule, int, RelativeResidual, EnergyChange);
  vtkGetMacro(StoppingRule, int);
  void SetStoppingRuleToRelativeResidual() { this->SetStoppingRule(RelativeResidual); }
  void SetStoppingRuleToEnergyChange() { this->SetStoppingRule(EnergyChange); }
  ///@}

  ///@{
  /**
   * Step size mu of ProgressiveIteration; it converges for 0 < mu < 2 / lambda_max(B^T W B), beyond
   * that the fit is refused as soon as the energy rises. 0 (the default): 2 / max_i sum_k w_k
   * B_i(x_k), with UniformRational the same of its own basis in each iteration, and see
   * OscillationStep.
   */
  vtkSetClampMacro(StepSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(StepSize, double);
  ///@}

  ///@{
  /**
   * Add new points to the last fit where that is possible; see "Adding points" above. What that
   * needs of the last fit (a copy of the points in two orders, and clusters of them) is kept only
   * while this is on, from the first fit with it. Default off.
   */
  vtkSetMacro(Incremental, bool);
  vtkGetMacro(Incremental, bool);
  vtkBooleanMacro(Incremental, bool);
  ///@}

  ///@{
  /**
   * Multiply each point's row weight by the length of its normal over the median of these lengths:
   * its confidence, as some scanners and normal estimators give it. A point without a normal then
   * has none. Default off: lengths do not count.
   */
  vtkSetMacro(UseNormalLengths, bool);
  vtkGetMacro(UseNormalLengths, bool);
  vtkBooleanMacro(UseNormalLengths, bool);
  ///@}

  ///@{
  /**
   * The blocks of a composite input are scans, whose borders are less certain than their middles:
   * points near the border of their own scan count less where another scan has seen the same place
   * better. See "Overlapping scans" above; of the hierarchy, not with Incremental. Default on.
   */
  vtkSetMacro(FeatherScans, bool);
  vtkGetMacro(FeatherScans, bool);
  vtkBooleanMacro(FeatherScans, bool);
  ///@}

  ///@{
  /**
   * Add the exact gradient of f to output 0 as `Gradient`. Default off.
   */
  vtkSetMacro(GenerateGradient, bool);
  vtkGetMacro(GenerateGradient, bool);
  vtkBooleanMacro(GenerateGradient, bool);
  ///@}

  ///@{
  /**
   * Add the support of f to output 0 as `Support`: the density of rows sum_i B_i(x) sum_k B_i(x_k)
   * over its median at the points: without unit, 1 where data are typical, 0 far from them, of a
   * hierarchy by its finest lattice. Default off.
   */
  vtkSetMacro(GenerateSupport, bool);
  vtkGetMacro(GenerateSupport, bool);
  vtkBooleanMacro(GenerateSupport, bool);
  ///@}

  ///@{
  /**
   * Type of the arrays of output 0: VTK_FLOAT (the default) or VTK_DOUBLE.
   */
  vtkSetClampMacro(OutputScalarType, int, VTK_FLOAT, VTK_DOUBLE);
  vtkGetMacro(OutputScalarType, int);
  void SetOutputScalarTypeToFloat() { this->SetOutputScalarType(VTK_FLOAT); }
  void SetOutputScalarTypeToDouble() { this->SetOutputScalarType(VTK_DOUBLE); }
  ///@}

  /**
   * The point arrays of the input that are fitted beside f, by name. Arrays that it does not know
   * are (its UnknownArraySetting is 1): disable those that are not wanted, or set that to 0 and
   * enable those that are. Changes modify this filter and do not fit f again.
   */
  vtkDataArraySelection* GetPointDataArraySelection();

  ///@{
  /**
   * Whether point arrays are fitted at all. Default on.
   */
  vtkSetMacro(FitPointArrays, bool);
  vtkGetMacro(FitPointArrays, bool);
  vtkBooleanMacro(FitPointArrays, bool);
  ///@}

  ///@{
  /**
   * Results of the last fit, also in the field data of output 0, there under their names without
   * "Get", with the array `ResidualHistory` of ||B^T W r|| / ||B^T W r0|| before the first and
   * after every iteration. All are 0 after a refused fit.
   *
   * StepSizeUsed is 0 with ConjugateGradient and that of the last iteration with UniformRational.
   * Energy is E = sum_k w_k r_k^2 over all rows + OscillationWeight R(C), in the hierarchy with the
   * weights that it gives them on the finest level, of which ResidualHistory is; AverageError and
   * MaximumError are the mean of f^2 and the maximum of |f| at the points; Oscillation is R(C), the
   * sum over coefficients of the squared differences to their axis neighbours, of a single level
   * with offset rows; 0 otherwise. WeightStepSizeUsed is the smallest step size that the weights of
   * UniformRational were changed with, WeightStepSize unless that was too large; 0 otherwise.
   * OffsetDistanceUsed is the distance that was aimed at, before rows were drawn nearer to their
   * points. NoiseFound is the distance (world units) that 68 % of the points keep from f = 0 on
   * the finest level that they alone determine, the standard deviation of normally distributed
   * noise, 0 if they are too sparse for any or FairingWeight is set; SmoothingLengthUsed (world
   * units) the length below which noise is smoothed away, 0 on clean data. FlippedNormalsFound is
   * the share of the normals, OutliersFound that of the points, that the hierarchy left out, see
   * "Faulty input"; AverageError and MaximumError count these. NumberOfPointsAdded is the number of
   * points that were added to an earlier fit, 0 if all points were fitted;
   * NumberOfCoefficientsSolved that of coefficients solved for, on all levels.
   */
  vtkGetMacro(NumberOfIterationsUsed, int);
  vtkGetMacro(StepSizeUsed, double);
  double GetEnergy() { return this->EnergyReached; }
  vtkGetMacro(AverageError, double);
  vtkGetMacro(MaximumError, double);
  vtkGetMacro(Oscillation, double);
  vtkGetMacro(WeightStepSizeUsed, double);
  vtkGetMacro(OffsetDistanceUsed, double);
  vtkGetMacro(NumberOfLevelsUsed, int);
  vtkGetMacro(NoiseFound, double);
  vtkGetMacro(SmoothingLengthUsed, double);
  vtkGetMacro(FlippedNormalsFound, double);
  vtkGetMacro(OutliersFound, double);
  vtkGetMacro(NumberOfPointsAdded, vtkIdType);
  vtkGetMacro(NumberOfCoefficientsSolved, vtkIdType);
  vtkGetVector3Macro(GridSizeUsed, int);
  vtkGetVector6Macro(ModelBoundsUsed, double);
  ///@}

  /**
   * The fit as a function, exact anywhere; brought up to date by Update(). It belongs to the filter
   * and is without a lattice before the first and after a refused fit.
   */
  vtkIPIAImplicitFunction* GetImplicitFunction();

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

protected:
  vtkIPIAImplicitFitter();
  ~vtkIPIAImplicitFitter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

  /// Updates the input, at the time step that outInfo asks for, since bounds and sizes follow from
  /// the points. Subclasses on several processes ask for their own part of it.
  virtual void BringInputUpToDate(vtkInformation* outInfo);

  /// The extents, origins and spacings of the images that the points of these inputs will give.
  void AnnounceOutputs(vtkInformationVector** input, vtkInformationVector* output);

  double ModelBounds[6];
  double Padding;
  int GridSize[3];
  int SampleDimensions[3];
  int Dimension;
  int NormalConstraint;
  double OffsetDistance;
  double OffsetValue;
  double InwardOffsetDistance;
  double InwardOffsetValue;
  int BasisType;
  double WeightStepSize;
  double OscillationWeight;
  int OscillationStep;
  double FairingWeight;
  int FairingOrder;
  int Solver;
  int NumberOfLevels;
  int MaximumNumberOfIterations;
  double Tolerance;
  int StoppingRule;
  double StepSize;
  bool UseNormalLengths;
  bool FeatherScans;
  bool GenerateGradient;
  bool GenerateSupport;
  int OutputScalarType;
  bool FitPointArrays;

  int NumberOfIterationsUsed;
  double StepSizeUsed;
  double EnergyReached;
  double AverageError;
  double MaximumError;
  double Oscillation;
  double WeightStepSizeUsed;
  double OffsetDistanceUsed;
  int NumberOfLevelsUsed;
  double NoiseFound;
  double SmoothingLengthUsed;
  double FlippedNormalsFound;
  double OutliersFound;
  vtkIdType NumberOfPointsAdded;
  vtkIdType NumberOfCoefficientsSolved;
  int GridSizeUsed[3];
  double ModelBoundsUsed[6];
  bool Incremental;
  bool FunctionOnly;

private:
  vtkIPIAImplicitFitter(const vtkIPIAImplicitFitter&) = delete;
  void operator=(const vtkIPIAImplicitFitter&) = delete;

  class Internals;

  // These ask for the function alone; the surface is contoured in bricks if that is.
  friend class vtkIPIAScanRegistration;
  friend class vtkIPIASurfaceReconstruction;
  void UpdateFunctionOnly();
  bool IsInBricks() const;
  bool ContourBricks(int pointType, const std::function<bool(double)>& progress,
    vtkPolyData* surface, std::vector<vtkIdType>& component) const;
  const ipia::PointCloud& FittedCloud() const;
  const ipia::Frame& FittedFrame() const;
  /// The smallest of the axes.
  double KnotSpacing() const;
  void EvaluateAttributes(vtkPolyData* surface);

  ipia::FitParameters Parameters() const;

  void FeatherScansOf(ipia::PointCloud& cloud, std::vector<vtkMTimeType> identity);
  void PrepareProblem(vtkInformationVector** input);
  bool Fit();
  template <int Dim>
  bool FitInDimension();
  bool FitAttributes();
  void WarnOfAttributes();
  void DiscardFit();
  void ResetResults();
  bool SampleImage(vtkImageData* image);
  void WriteResults(vtkFieldData* field) const;

  std::unique_ptr<Internals> State;
};

#endif
