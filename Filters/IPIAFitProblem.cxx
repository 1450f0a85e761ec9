// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAFitProblem.h"

#include "Core/AutomaticLattice.h"
#include "Core/LonePoints.h"
#include "Core/Parallel.h"
#include "IPIAControlLattice.h"
#include "IPIAMemory.h"
#include "IPIAText.h"
#include "vtkIPIAImplicitFitter.h"

#include "vtkDataArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ipia
{
namespace
{
/// The automatic knot spacing in units of the point spacing: somewhat less than the spacing for the
/// hierarchy, about 2.5 where one level must hold together by itself.
constexpr double HierarchicalSpacing = 0.85, ClassicSpacing = 1.6;
/// Limits of an automatic lattice: knot spacings along the longest side of the points.
constexpr double FewestSpacings = 8, MostSpacings = 256;
/// No more samples than this unless the user asks for them.
constexpr double MostAutomaticSamples = 268435456; // 2^28
/// Bytes that the fit needs per coefficient and per row, all its arrays together.
constexpr double BytesPerCoefficient = 96, BytesPerRow = 160;
/// And what is kept of a point that others may be added to: twice the point, and clusters of it.
constexpr double BytesPerKeptPoint = 300;
/// And where the spline is rational: of its iteration per coefficient, and per sample of the slices
/// that are sampled at a time.
constexpr double BytesPerWeight = 64, BytesPerRationalSample = 16, RationalSlices = 16;
/// And in bricks: per brick that is stored, and per brick of the whole lattice.
constexpr double BytesPerBrick = 2048, BytesPerAbsentBrick = 16;
/// And of point arrays: per point, per point and component, and per brick and component; per sample
/// and coefficient while a component is sampled.
constexpr double BytesPerArrayPoint = 320, BytesPerArrayValue = 16, BytesPerBrickOfArray = 1024;
constexpr double BytesPerArraySample = 8, BytesPerArrayCoefficient = 16;
/// Of the surface that is contoured in bricks: triangles per cell of three sides of the lattice,
/// most of them per brick, and bytes per triangle at the peak.
constexpr double TrianglesPerSideCell = 8, TrianglesPerBrick = 128, BytesPerTriangle = 115;
/// Bricks around a brick with data, and layers of them on both sides of a surface that crosses the
/// lattice twice along every axis.
constexpr double BricksAroundOne = 27, LayersOfBricks = 6;
/// The rows of the hierarchy are of single precision, whose range a fairing beyond this leaves.
constexpr double LargestFairingWeight = 1e30;
/// Steps of weights beyond this, in 1 / square of the longest side, are halved in vain.
constexpr double LargestWeightStep = 1e100;
}

bool FitParameters::isClassic() const
{
  return this->NumberOfLevels == 1 && this->NormalConstraint != vtkIPIAImplicitFitter::Gradient;
}

bool FitParameters::isRational() const
{
  return this->BasisType == vtkIPIAImplicitFitter::UniformRational;
}

void FitProblem::Prepare(const FitParameters& parameters)
{
  this->Refusal = this->Cloud.Refusal;
  const auto step = [this](auto&& action)
  {
    if (this->Refusal.empty())
    {
      action();
    }
  };
  step([&] { this->CheckNumbers(parameters); });
  step([&] { this->CheckBasisAndOscillation(parameters); });
  step([&] { this->CheckCombination(parameters); });
  step([&] { this->ChooseDimension(parameters); });
  step([&] { this->CheckPrintedStep(parameters); });
  step(
    [&]
    {
      if (this->Dimension == 2)
      {
        this->ChooseLattice<2>(parameters);
      }
      else
      {
        this->ChooseLattice<3>(parameters);
      }
    });
  step([&] { this->ChooseSamples(parameters); });
  step([&] { this->CheckMemory(parameters); });
  step([&] { this->DropPointsOutside(); });
  if (!this->Refusal.empty())
  {
    const int none[6] = { 0, -1, 0, -1, 0, -1 };
    std::copy_n(none, 6, this->WholeExtent);
  }
}

bool FitProblem::staysInBricks(const FitParameters& parameters) const
{
  const auto& samples = parameters.SampleDimensions;
  return parameters.FunctionOnly && !parameters.isClassic() && this->Dimension == 3 &&
    std::all_of(samples.begin(), samples.end(), [](int n) { return n == 0; });
}

void FitProblem::CheckNumbers(const FitParameters& parameters)
{
  const std::pair<const char*, double> numbers[] = {
    { "OffsetDistance", parameters.OffsetDistance },
    { "OffsetValue", parameters.OffsetValue },
    { "InwardOffsetDistance", parameters.InwardOffsetDistance },
    { "InwardOffsetValue", parameters.InwardOffsetValue },
    { "FairingWeight", parameters.FairingWeight },
    { "WeightStepSize", parameters.WeightStepSize },
    { "OscillationWeight", parameters.OscillationWeight },
    { "Tolerance", parameters.Tolerance },
    { "StepSize", parameters.StepSize },
  };
  for (const auto& [name, value] : numbers)
  {
    if (!std::isfinite(value))
    {
      this->Refusal = text(name, " is ", value, "; it must be a finite number. Set one.");
      return;
    }
  }
  if (parameters.FairingWeight >= LargestFairingWeight)
  {
    this->Refusal = text("FairingWeight is ", parameters.FairingWeight, "; it must be less than ",
      LargestFairingWeight, ", beside which data count for nothing. Reduce it.");
  }
  else if (parameters.Tolerance >= 1 &&
    parameters.StoppingRule == vtkIPIAImplicitFitter::RelativeResidual)
  {
    this->Refusal = text("Tolerance is ", parameters.Tolerance,
      "; with StoppingRule RelativeResidual it is a share of the residual at the start, and from 1 "
      "on nothing is iterated. Set one below 1, or 0.");
  }
}

double FitProblem::totalWeight() const
{
  const auto& weights = this->Cloud.Weights;
  return static_cast<double>(this->Cloud.ExtraValues.size()) +
    (weights.empty() ? static_cast<double>(this->Cloud.Positions.size())
                     : std::accumulate(weights.begin(), weights.end(), 0.0));
}

void FitProblem::CheckBasisAndOscillation(const FitParameters& parameters)
{
  using Fitter = vtkIPIAImplicitFitter;
  const bool rational = parameters.isRational();
  if (!rational && parameters.OscillationWeight == 0)
  {
    return;
  }
  const char* what = rational ? "BasisType UniformRational" : "OscillationWeight";
  const char* without = rational ? "set BasisType to BSpline" : "leave OscillationWeight 0";
  const bool progressive = parameters.Solver == Fitter::ProgressiveIteration;
  if (!parameters.isClassic())
  {
    this->Refusal = text(what,
      " belongs to a single level with offset rows; the hierarchy fits a B-spline and smooths it "
      "by "
      "FairingWeight. Set NumberOfLevels to 1 and NormalConstraint to an offset, or ",
      without, ".");
  }
  else if (parameters.FairingWeight > 0 || !this->Cloud.LocalFairing.empty())
  {
    this->Refusal = text("FairingWeight and local fairing weights belong to the hierarchy, ", what,
      " to a single level with offset rows. Leave the fairing unset, or ", without,
      " and set NumberOfLevels to 0.");
  }
  else if (rational && !progressive)
  {
    this->Refusal =
      "BasisType UniformRational is fitted by ProgressiveIteration; ConjugateGradient "
      "solves linear problems, and f is not linear in the weights. Set Solver to "
      "ProgressiveIteration, or BasisType to BSpline.";
  }
  else if (parameters.OscillationWeight > 0 && parameters.OscillationStep == Fitter::AsPrinted &&
    !progressive)
  {
    this->Refusal = "OscillationStep AsPrinted is a step of ProgressiveIteration. Set Solver to "
                    "ProgressiveIteration, or OscillationStep to Energy.";
  }
  else if (parameters.OscillationWeight * std::numeric_limits<double>::epsilon() >
    this->totalWeight())
  {
    this->Refusal = text("OscillationWeight is ", parameters.OscillationWeight,
      " and the points weigh ", this->totalWeight(),
      " together, which counts for nothing beside it. Reduce OscillationWeight.");
  }
  else if (const double side = this->Cloud.longestSide();
           rational && parameters.WeightStepSize * side * side > LargestWeightStep)
  {
    this->Refusal =
      text("WeightStepSize is ", parameters.WeightStepSize, " for points of an extent of ", side,
        ", far too long a step to be halved until it is one. "
        "Reduce WeightStepSize.");
  }
}

void FitProblem::CheckPrintedStep(const FitParameters& parameters)
{
  const double limit = 1. / (8 * this->Dimension);
  if (parameters.OscillationStep == vtkIPIAImplicitFitter::AsPrinted &&
    parameters.OscillationWeight >= limit)
  {
    this->Refusal = text("OscillationWeight is ", parameters.OscillationWeight,
      "; with OscillationStep AsPrinted ", "it must be less than 1 / (8 Dimension) = ", limit,
      ", or the iteration diverges. Reduce OscillationWeight, or set OscillationStep to Energy.");
  }
}

void FitProblem::CheckCombination(const FitParameters& parameters)
{
  if (!parameters.isClassic() && parameters.Solver == vtkIPIAImplicitFitter::ProgressiveIteration)
  {
    this->Refusal =
      "ProgressiveIteration solves a single level with offset rows. Set NumberOfLevels to "
      "1 and NormalConstraint to an offset, or Solver to ConjugateGradient.";
  }
  else if (!parameters.isClassic() && parameters.StepSize > 0)
  {
    this->Refusal =
      "StepSize belongs to ProgressiveIteration on a single level with offset rows; the "
      "hierarchy has none. Leave it 0.";
  }
  else if (parameters.isClassic() &&
    (parameters.FairingWeight > 0 || !this->Cloud.LocalFairing.empty()))
  {
    this->Refusal = "FairingWeight and local fairing weights belong to the hierarchy; a single "
                    "level with offset rows has no "
                    "fairing. Leave them unset, or set NumberOfLevels to 0.";
  }
}

void FitProblem::ChooseDimension(const FitParameters& parameters)
{
  int flat = parameters.Dimension == 3 ? -1 : this->Cloud.flatAxis();
  if (parameters.Dimension != 3 && flat < 0 && this->Cloud.tiltedPlane(this->Frame, flat))
  {
    const auto& bounds = parameters.ModelBounds;
    if (bounds[0] <= bounds[1] || bounds[2] <= bounds[3] || bounds[4] <= bounds[5])
    {
      this->Refusal = "ModelBounds are a box along the axes, but points and normals lie in a plane "
                      "that is tilted. Leave them unset, or set Dimension to 3.";
      return;
    }
  }
  this->PointBounds = this->Cloud.boundsIn(this->Frame);
  if (parameters.Dimension == 2 && flat < 0)
  {
    const int thin = this->Cloud.axisWithoutExtent();
    this->Refusal = thin < 0
      ? "Dimension is 2, but points and normals do not lie in a plane."
      : text("Dimension is 2, but normals point out of the plane of the points (along axis ", thin,
          ").");
    return;
  }
  this->Dimension = flat < 0 ? 3 : 2;
  this->FlatAxis = flat;
  if (this->Dimension == 3 && this->Cloud.isLine())
  {
    this->Refusal = text("All ", this->Cloud.Positions.size(),
      " points lie on a line; a surface needs points off it.");
  }
}

template <int Dim>
void FitProblem::ChooseLattice(const FitParameters& parameters)
{
  auto place = Placement<Dim>::withFlatAxis(this->FlatAxis);
  place.Turn = this->Frame;
  const double* bounds = parameters.ModelBounds.data();
  bool automatic = true;
  Box<Dim> box, model;
  Index<Dim> size;
  for (int a = 0; a < Dim; ++a)
  {
    const auto i = static_cast<std::size_t>(a);
    const auto axis = static_cast<std::size_t>(place.Axis[i]);
    box.Lower[a] = this->PointBounds[2 * axis];
    box.Upper[a] = this->PointBounds[2 * axis + 1];
    model.Lower[a] = bounds[2 * axis];
    model.Upper[a] = bounds[2 * axis + 1];
    automatic = automatic && !(bounds[2 * axis] <= bounds[2 * axis + 1]);
    size[i] = parameters.GridSize[axis];
    if (size[i] != 0 && size[i] < Order)
    {
      this->Refusal = text("GridSize is ", size[i], " along axis ", axis,
        "; a cubic lattice needs at least 4 coefficients (0: automatic).");
      return;
    }
  }

  const double longest = (box.Upper - box.Lower).maxCoeff();
  // Sizes say the spacing, all of them or, on an automatic domain, any.
  const bool anyGiven = std::any_of(size.begin(), size.end(), [](auto n) { return n > 0; });
  const bool allGiven = std::all_of(size.begin(), size.end(), [](auto n) { return n > 0; });
  const bool sizesSay = allGiven || (automatic && anyGiven);
  const bool chooseFairing = anyGiven && !parameters.isClassic() && parameters.FairingWeight < 0;
  double wanted = 0;
  if (!sizesSay || chooseFairing)
  {
    Points<Dim> positions(Dim, this->Cloud.Positions.size());
    parallelChunks(positions.cols(), resolveThreads(0),
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t k = begin; k < end; ++k)
        {
          positions.col(k) =
            place.toLocal(this->Cloud.Positions[static_cast<std::size_t>(k)].data());
        }
      });
    wanted = parameters.isClassic() ? ClassicSpacing * pointSpacing(positions, box, 0)
                                    : HierarchicalSpacing * robustPointSpacing(positions, box, 0);
    // An automatic lattice suits the points.
    this->DataSpacing = chooseFairing ? std::min(wanted, longest / FewestSpacings) : 0;
  }
  const double h = std::min(std::max(wanted, longest / MostSpacings), longest / FewestSpacings);

  PlacedLattice<Dim> placed;
  if (automatic)
  {
    const double spacings = longest * (1 + 2 * parameters.Padding) / h;
    if (!(spacings < VTK_INT_MAX))
    {
      this->Refusal = text("Padding is ", parameters.Padding, ", which would take ", spacings,
        " knot spacings along an axis. Reduce Padding.");
      return;
    }
    placed = latticeAround<Dim>(box, parameters.Padding, size, h);
  }
  else
  {
    for (int a = 0; a < Dim; ++a)
    {
      if (!(model.Lower[a] < model.Upper[a] && std::isfinite(model.sides()[a])))
      {
        this->Refusal = text("ModelBounds are empty or not finite along axis ",
          place.Axis[static_cast<std::size_t>(a)], ": [", model.Lower[a], ", ", model.Upper[a],
          "]. Give all axes a positive length, or leave all unset.");
        return;
      }
    }
    if (!(model.sides().maxCoeff() < VTK_INT_MAX * longest))
    {
      this->Refusal = text("ModelBounds are ", model.sides().maxCoeff() / longest,
        " times as long as the points, which then lie in one knot cell. Give smaller bounds.");
      return;
    }
    // A box much larger than its points does not get more than MostSpacings of its own.
    placed = latticeOn<Dim>(model, size, std::max(h, model.sides().maxCoeff() / MostSpacings));
  }

  for (int axis = 0; axis < 3; ++axis)
  {
    this->Origin[axis] = this->Upper[axis] = this->PointBounds[static_cast<std::size_t>(2 * axis)];
    this->Spacing[axis] = placed.Grid.Spacing[0];
    this->GridSize[axis] = 1;
  }
  for (int a = 0; a < Dim; ++a)
  {
    const int axis = place.Axis[static_cast<std::size_t>(a)];
    this->Origin[axis] = placed.Lower[a];
    this->Spacing[axis] = placed.Grid.Spacing[a];
    this->Upper[axis] = automatic ? placed.Lower[a] + placed.Grid.extent(a) : model.Upper[a];
    this->GridSize[axis] = static_cast<int>(placed.Grid.Size[static_cast<std::size_t>(a)]);
  }
}

void FitProblem::ChooseSamples(const FitParameters& parameters)
{
  double total = 1;
  double dimensions[3];
  bool anyAutomatic = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool automatic = parameters.SampleDimensions[axis] == 0;
    dimensions[axis] = axis == this->FlatAxis ? 1
      : automatic                             ? 2. * (this->GridSize[axis] - 3) + 1
                                              : parameters.SampleDimensions[axis];
    if (axis != this->FlatAxis && dimensions[axis] < 2)
    {
      this->Refusal = text("SampleDimensions is ", parameters.SampleDimensions[axis],
        " along axis ", axis, "; at least 2 sample points are needed (0: automatic).");
      return;
    }
    anyAutomatic = anyAutomatic || (automatic && axis != this->FlatAxis);
    total *= dimensions[axis];
  }
  const double shrink = anyAutomatic
    ? std::min(1.0, std::pow(MostAutomaticSamples / total, 1. / this->Dimension))
    : 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (parameters.SampleDimensions[axis] == 0 && axis != this->FlatAxis)
    {
      dimensions[axis] = std::max(2.0, std::floor(dimensions[axis] * shrink));
    }
    this->WholeExtent[2 * axis] = 0;
    this->WholeExtent[2 * axis + 1] = static_cast<int>(dimensions[axis]) - 1;
    this->SampleSpacing[axis] = axis == this->FlatAxis
      ? this->Spacing[axis]
      : (this->Upper[axis] - this->Origin[axis]) / (dimensions[axis] - 1);
  }
}

void FitProblem::CheckMemory(const FitParameters& parameters)
{
  double coefficients = 1, samples = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    coefficients *= this->GridSize[axis];
    samples *= this->WholeExtent[2 * axis + 1] + 1.;
  }
  const double scalar = parameters.OutputScalarType == VTK_DOUBLE ? 8 : 4;
  const double arrays =
    1 + (parameters.GenerateGradient ? 4 : 0) + (parameters.GenerateSupport ? 1 : 0);
  const double rows = 3. * static_cast<double>(this->Cloud.Positions.size());
  double needed = rows * BytesPerRow;
  const double bricks[3] = { this->GridSize[0] / 4. + 1, this->GridSize[1] / 4. + 1,
    this->GridSize[2] / 4. + 1 };
  const double allBricks = bricks[0] * bricks[1] * bricks[2];
  const double sides = bricks[0] * bricks[1] + bricks[1] * bricks[2] + bricks[2] * bricks[0];
  const double stored = std::min({ allBricks, BricksAroundOne * rows, LayersOfBricks * sides });
  if (!this->Arrays.empty())
  {
    double components = 0, bytes = BytesPerArraySample;
    for (const PointArray& array : this->Arrays)
    {
      components += array.NumberOfComponents();
      bytes += array.NumberOfComponents() * array.Prototype->GetDataTypeSize();
    }
    const auto points = static_cast<double>(this->Cloud.Positions.size());
    needed += points * (BytesPerArrayPoint + BytesPerArrayValue * components) +
      allBricks * BytesPerAbsentBrick +
      stored * (BytesPerBrick + BytesPerBrickOfArray * components);
    if (!parameters.FunctionOnly)
    {
      needed += samples * bytes + coefficients * BytesPerArrayCoefficient;
    }
  }
  if (parameters.Incremental && !parameters.isClassic())
  {
    needed += static_cast<double>(this->Cloud.Positions.size()) * BytesPerKeptPoint;
  }
  if (this->staysInBricks(parameters))
  {
    const double triangles =
      std::min(TrianglesPerSideCell * 16 * sides, TrianglesPerBrick * BricksAroundOne * rows);
    needed +=
      allBricks * BytesPerAbsentBrick + stored * BytesPerBrick + triangles * BytesPerTriangle;
  }
  else
  {
    needed += coefficients * BytesPerCoefficient + samples * arrays * scalar;
    if (parameters.isRational())
    {
      const int last = this->FlatAxis == 2 ? 1 : 2;
      const double slices = this->WholeExtent[2 * last + 1] + 1.;
      needed += coefficients * BytesPerWeight +
        samples * std::min(1.0, RationalSlices / slices) * BytesPerRationalSample *
          (parameters.GenerateGradient ? 2 : 1);
    }
  }
  const double available = memoryOfMachine();
  if (needed > MemoryShare * available)
  {
    this->Refusal = text("The fit would take about ", needed / Gibibyte,
      " GiB of memory (GridSize ", this->GridSize[0], " x ", this->GridSize[1], " x ",
      this->GridSize[2], ", ", this->WholeExtent[1] + 1, " x ", this->WholeExtent[3] + 1, " x ",
      this->WholeExtent[5] + 1, " samples); the machine has ", available / Gibibyte,
      " GiB. Reduce GridSize or SampleDimensions",
      this->Arrays.empty() ? "." : ", or choose fewer point arrays.");
  }
}

void FitProblem::DropPointsOutside()
{
  const auto inside = [this](const std::array<double, 3>& position)
  {
    const std::array<double, 3> x = this->Frame.toFrame(position.data());
    for (int axis = 0; axis < 3; ++axis)
    {
      const double value = x[static_cast<std::size_t>(axis)];
      const double slack = 1e-12 * (this->Upper[axis] - this->Origin[axis]);
      if (axis != this->FlatAxis &&
        !(value >= this->Origin[axis] - slack && value <= this->Upper[axis] + slack))
      {
        return false;
      }
    }
    return true;
  };
  PointCloud& cloud = this->Cloud;
  const auto before = static_cast<vtkIdType>(cloud.Positions.size());
  const auto staysInside = [&](std::size_t k) { return inside(cloud.Positions[k]); };
  this->OutsideBounds = parallelSum<vtkIdType>(before, resolveThreads(0),
    [&](vtkIdType begin, vtkIdType end)
    {
      vtkIdType outside = 0;
      for (vtkIdType k = begin; k < end; ++k)
      {
        outside += !staysInside(static_cast<std::size_t>(k));
      }
      return outside;
    });
  if (this->OutsideBounds > 0)
  {
    cloud.keepIf(staysInside);
  }
  const std::size_t kept = cloud.Positions.size();
  std::size_t keptRows = 0;
  for (std::size_t k = 0; k < cloud.ExtraPositions.size(); ++k)
  {
    if (inside(cloud.ExtraPositions[k]))
    {
      cloud.ExtraPositions[keptRows] = cloud.ExtraPositions[k];
      cloud.ExtraValues[keptRows] = cloud.ExtraValues[k];
      ++keptRows;
    }
  }
  this->OutsideBounds += static_cast<vtkIdType>(cloud.ExtraPositions.size() - keptRows);
  cloud.ExtraPositions.resize(keptRows);
  cloud.ExtraValues.resize(keptRows);
  const auto none = [](const auto& values, auto isUsable)
  { return std::none_of(values.begin(), values.end(), isUsable); };
  const std::string where =
    text("the ModelBounds from ", triple(this->Origin), " to ", triple(this->Upper), ".");
  if (kept == 0)
  {
    this->Refusal = "None of the points lies in " + where;
  }
  else if (kept == 1)
  {
    this->Refusal = "Only one point lies in " + where + " At least two are needed.";
  }
  else if (none(cloud.Normals, [](const auto& n) { return n[0] != 0 || n[1] != 0 || n[2] != 0; }))
  {
    this->Refusal = "All normals are zero or not finite in " + where;
  }
  else if (!cloud.Weights.empty() && none(cloud.Weights, [](double w) { return w > 0; }))
  {
    this->Refusal = "All row weights are zero in " + where;
  }
}
}
