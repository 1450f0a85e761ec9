// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAFairingRound.h"

#include "Core/AutomaticFairing.h"
#include "Core/Parametrization.h"
#include "IPIAMemory.h"
#include "IPIAText.h"
#include "vtkFairingPIAFilter.h"

#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ipia
{
namespace
{
/// Of SetInputArrayToProcess; the array that has a default.
constexpr int ControlWeightsIndex = 1;

/// Bytes that a fit needs per data point, and per control point with all that its iteration keeps.
constexpr double BytesPerDataPoint = 200, BytesPerControlPoint = 800;
/// And per entry of a matrix that is factorised, with its share of the factors for each doubling of
/// the number of control points.
constexpr double BytesPerEntry = 56, BytesPerFactorEntry = 12;

bool isWeight(double value)
{
  return value >= 0 && value <= 1;
}

template <typename Array, typename Value>
void addArray(vtkFieldData* field, const char* name, const std::vector<Value>& values)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  for (std::size_t k = 0; k < values.size(); ++k)
  {
    array->SetValue(static_cast<vtkIdType>(k), values[k]);
  }
  field->AddArray(array);
}

/// Fills control points without data from neighbours that have some, one ring after the other.
void fillFromNeighbours(
  const BSplineBasis& u, const BSplineBasis& v, std::vector<char> known, Eigen::MatrixXd& points)
{
  const std::int64_t columns = u.size(), rows = v.size();
  bool any = std::find(known.begin(), known.end(), 1) != known.end();
  while (any && std::find(known.begin(), known.end(), 0) != known.end())
  {
    const std::vector<char> before = known;
    for (std::int64_t j = 0; j < columns * rows; ++j)
    {
      if (before[static_cast<std::size_t>(j)])
      {
        continue;
      }
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      double count = 0;
      const std::int64_t i = j % columns, row = j / columns;
      for (const auto& [di, dr] : { std::pair(-1, 0), { 1, 0 }, { 0, -1 }, { 0, 1 } })
      {
        const std::int64_t ni = i + di, nr = row + dr;
        if (ni >= 0 && ni < columns && nr >= 0 && nr < rows &&
          before[static_cast<std::size_t>(ni + columns * nr)])
        {
          sum += points.row(ni + columns * nr);
          count += 1;
        }
      }
      if (count > 0)
      {
        points.row(j) = sum / count;
        known[static_cast<std::size_t>(j)] = 1;
      }
    }
  }
}
}

std::string FairingParameters::refusal() const
{
  const auto notWeight = [](const char* name, double value)
  {
    return text(name, " is ", value,
      "; a weight lies in [0, 1], 0 for fitting alone and 1 for fairing alone.");
  };
  if (!isWeight(this->FairingWeight))
  {
    return notWeight("FairingWeight", this->FairingWeight);
  }
  if (!isWeight(this->AutomaticFairingWeight))
  {
    return notWeight("AutomaticFairingWeight", this->AutomaticFairingWeight);
  }
  if (!isWeight(this->AutomaticShare))
  {
    return text("AutomaticShare is ", this->AutomaticShare, "; a share lies in [0, 1].");
  }
  if (!(this->Options.Tolerance >= 0) || !(this->Options.StepSize >= 0))
  {
    return text("Tolerance is ", this->Options.Tolerance, " and StepSize is ",
      this->Options.StepSize, "; both must be 0 or more.");
  }
  if (this->DerivativeOrder > this->Degree)
  {
    return text("DerivativeOrder is ", this->DerivativeOrder, " and Degree is ", this->Degree,
      ": that derivative is 0 and fairs nothing. Set a higher Degree or a lower DerivativeOrder.");
  }
  return {};
}

void FairingRound::setPoints(const Eigen::MatrixXd& points)
{
  this->Centre = (points.colwise().minCoeff() + points.colwise().maxCoeff()) / 2;
  this->Data.Points = points.rowwise() - this->Centre;
}

void FairingRound::startFromGrid()
{
  const auto& axes = this->Spline.Axes;
  const auto rowOf = [&](std::size_t axis)
  { return initialPoints(axes[axis], this->GridSize[axis]); };
  const std::vector<std::int64_t> u = rowOf(0);
  const std::vector<std::int64_t> v =
    axes[1].degree() == 0 ? std::vector<std::int64_t>{ 0 } : rowOf(1);
  this->Spline.ControlPoints.resize(this->Spline.size(), 3);
  for (std::size_t l = 0; l < v.size(); ++l)
  {
    for (std::size_t j = 0; j < u.size(); ++j)
    {
      this->Spline.ControlPoints.row(static_cast<Eigen::Index>(j + u.size() * l)) =
        this->Data.Points.row(u[j] + this->GridSize[0] * v[l]);
    }
  }
}

void FairingRound::startFromScatteredData()
{
  const auto& axes = this->Spline.Axes;
  Eigen::MatrixXd& points = this->Spline.ControlPoints;
  points.resize(this->Spline.size(), 3);
  for (Eigen::Index c = 0; c < 3; ++c)
  {
    points.col(c) = carryToControlPoints(axes, this->Data, this->Data.Points.col(c), 0);
  }
  const Vector ones = Vector::Ones(this->Data.Points.rows());
  const Vector touched = carryToControlPoints(axes, this->Data, ones, 0);
  std::vector<char> known(static_cast<std::size_t>(touched.size()));
  std::transform(
    touched.begin(), touched.end(), known.begin(), [](double x) { return x > 0 ? 1 : 0; });
  fillFromNeighbours(axes[0], axes[1], std::move(known), points);
}

double excessKnot(const std::vector<double>& interior, int degree)
{
  const auto p = static_cast<std::size_t>(degree);
  for (std::size_t k = 0; k < interior.size(); ++k)
  {
    if (!(interior[k] > 0 && interior[k] < 1) ||
      (k + p < interior.size() && interior[k] == interior[k + p]))
    {
      return std::abs(interior[k]);
    }
  }
  return -1;
}

std::string checkSpans(const std::vector<double>& interior)
{
  for (std::size_t k = 0; k <= interior.size(); ++k)
  {
    const double from = k > 0 ? interior[k - 1] : 0.0;
    const double to = k < interior.size() ? interior[k] : 1.0;
    if (to != from && !(to - from >= BSplineBasis::SmallestSpan))
    {
      return text("The knots ", from, " and ", to, " are ", to - from,
        " apart; they must be equal "
        "or ",
        BSplineBasis::SmallestSpan,
        " apart at least. Insert knots farther apart, leave out data points "
        "whose parameters are all but equal, or set fewer control points.");
    }
  }
  return {};
}

std::string FairingRound::insertKnots()
{
  for (std::size_t axis = 0; axis < 2; ++axis)
  {
    std::vector<double> inserted = this->InsertedKnots[axis];
    if (inserted.empty())
    {
      continue;
    }
    const BSplineBasis& basis = this->Spline.Axes[axis];
    std::vector<double> all = basis.interiorKnots();
    for (double& knot : inserted)
    {
      if (!(knot > 0 && knot < 1))
      {
        return text("The knot ", knot, " cannot be inserted; give knots between 0 and 1.");
      }
      // What rounding makes of a knot is that knot.
      const auto same = std::find_if(all.begin(), all.end(),
        [&](double other) { return std::abs(other - knot) < BSplineBasis::SmallestSpan; });
      knot = same != all.end() ? *same : knot;
      all.push_back(knot);
    }
    std::sort(all.begin(), all.end());
    const double excess = excessKnot(all, basis.degree());
    if (excess >= 0)
    {
      return text("The knot ", excess, " would be there more than ", basis.degree(),
        " times, the Degree, with those inserted. Insert it fewer times.");
    }
    const std::string refusal = checkSpans(all);
    if (!refusal.empty())
    {
      return refusal;
    }
    const bool weights = this->ControlWeights.size() > 0, movable = this->Movable.size() > 0;
    Eigen::MatrixXd attached = Eigen::MatrixXd::Zero(this->Spline.size(), 2);
    if (weights)
    {
      attached.col(0) = this->ControlWeights;
    }
    if (movable)
    {
      attached.col(1) = this->Movable.cwiseAbs();
    }
    this->Spline.insertKnots(static_cast<int>(axis), inserted, attached);
    if (weights)
    {
      // Rounding must not leave the range of weights.
      this->ControlWeights = attached.col(0).cwiseMax(0.0).cwiseMin(1.0);
    }
    if (movable)
    {
      this->Movable = attached.col(1);
    }
  }
  return {};
}

std::string FairingRound::chooseWeights(
  const FairingParameters& p, const ProgressCallback& progress)
{
  if (this->DataWeights.size() > 0)
  {
    this->Weights =
      carryToControlPoints(this->Spline.Axes, this->Data, this->DataWeights, p.FairingWeight);
    return {};
  }
  if (this->ControlWeights.size() > 0)
  {
    this->Weights = this->ControlWeights;
    return {};
  }
  this->Weights = Vector::Constant(this->Spline.size(), p.FairingWeight);
  Vector measure;
  if (p.AutomaticFairing == vtkFairingPIAFilter::CurvatureVariation ||
    (p.AutomaticFairing == vtkFairingPIAFilter::SecondDifference && !this->Data.Gridded))
  {
    // Of the curve or surface without a choice.
    TensorSpline plain = this->Spline;
    const FairingSystem system(plain.Axes, this->Data, this->Weights, p.DerivativeOrder, 0);
    FairingOptions options = p.Options;
    if (options.Solver == FairingSolver::ProgressiveIteration)
    {
      options.Solver = FairingSolver::BiconjugateGradient; // to the same limit, sooner
      options.StepSize = 0;
    }
    const FairingResult result = iterateFairing(system, fittingResiduals(plain, this->Data, 0),
      options, plain, [&](double) { return !progress || progress(0); });
    this->ChoiceUnfinished = result.Status == FairingStatus::NotConverged;
    if (result.Status == FairingStatus::Singular || result.Status == FairingStatus::Diverged ||
      result.Status == FairingStatus::NotFinite)
    {
      return "The curve or surface by which AutomaticFairing chooses cannot be computed: with "
             "FairingWeight alone its equations have no unique solution. Set a larger "
             "FairingWeight "
             "or fewer control points.";
    }
    if (result.Status == FairingStatus::Aborted)
    {
      return {};
    }
    measure = p.AutomaticFairing == vtkFairingPIAFilter::CurvatureVariation
      ? curvatureVariation(plain)
      : secondDifferences(plain.ControlPoints, { plain.Axes[0].size(), plain.Axes[1].size() },
          { plain.Axes[0].isPeriodic(), plain.Axes[1].isPeriodic() });
  }
  else if (p.AutomaticFairing == vtkFairingPIAFilter::SecondDifference)
  {
    measure = carryToControlPoints(this->Spline.Axes, this->Data,
      secondDifferences(
        this->Data.Points, this->GridSize, { this->Spline.Axes[0].isPeriodic(), false }),
      0);
  }
  if (measure.size() > 0)
  {
    this->Weights =
      raiseLargest(measure, p.AutomaticShare, p.FairingWeight, p.AutomaticFairingWeight);
  }
  return {};
}

std::string FairingRound::run(const FairingParameters& p, const ProgressCallback& progress)
{
  std::string refusal;
  for (const BSplineBasis& basis : this->Spline.Axes)
  {
    if (refusal.empty() && basis.degree() > 0)
    {
      refusal = checkSpans(basis.interiorKnots());
    }
  }
  refusal = refusal.empty() ? this->insertKnots() : refusal;
  refusal = refusal.empty() ? this->chooseWeights(p, progress) : refusal;
  if (!refusal.empty())
  {
    return refusal;
  }
  FairingOptions options = p.Options;
  if (this->Movable.size() > 0)
  {
    options.Movable.resize(static_cast<std::size_t>(this->Movable.size()));
    std::transform(this->Movable.begin(), this->Movable.end(), options.Movable.begin(),
      [](double x) { return x != 0 ? 1 : 0; });
  }
  const FairingSystem system(this->Spline.Axes, this->Data, this->Weights, p.DerivativeOrder, 0);
  this->Residuals = fittingResiduals(this->Spline, this->Data, 0);
  this->Result = iterateFairing(system, this->Residuals, options, this->Spline, progress);
  if (this->Result.Status == FairingStatus::Diverged)
  {
    return text("The iteration diverged: after ", this->Result.NumberOfIterations,
      " iterations its error is ", this->Result.History.IterationError.back(),
      " times that at the beginning. Weights that differ by orders of magnitude between neighbours "
      "can do that; let them differ less, set a smaller StepSize, or take Solver SparseDirect.");
  }
  if (this->Result.Status == FairingStatus::Singular)
  {
    return text("The equations have no unique solution, for ", this->Weights.size(),
      " control points, ", this->Data.Points.rows(), " data points and fairing weights from ",
      this->Weights.minCoeff(), " to ", this->Weights.maxCoeff(),
      ": control points have neither enough data nor fairing, or fairing alone. Set a "
      "FairingWeight "
      "above 0 and below 1 or fewer control points, or take Solver ProgressiveIteration.");
  }
  if (this->Result.Status == FairingStatus::NotFinite)
  {
    return text("The equations have values that are not finite, for an extent of the points of ",
      this->Data.Points.cwiseAbs().maxCoeff(), ", control points up to ",
      this->Spline.ControlPoints.cwiseAbs().maxCoeff(), " and ", this->Weights.size(),
      " fairing weights. Scale the points, or insert knots farther apart.");
  }
  this->Residuals = fittingResiduals(this->Spline, this->Data, 0);
  this->FittingError = rootMeanSquare(this->Residuals);
  this->FairingEnergy = fairingEnergy(this->Spline, p.DerivativeOrder);
  if (this->Result.Status != FairingStatus::Aborted &&
    !(std::isfinite(this->FittingError) && std::isfinite(this->FairingEnergy)))
  {
    return text("The result is not finite: FittingError is ", this->FittingError,
      " and FairingEnergy ", this->FairingEnergy,
      ". Scale the points, set fewer control points, or a lower DerivativeOrder.");
  }
  return {};
}

std::string chooseArray(vtkAlgorithm* filter, int index, vtkDataSet* input, int components,
  const std::string& what, vtkDataArray*& array)
{
  array = nullptr;
  vtkInformation* chosen = filter->GetInputArrayInformation(index);
  vtkPointData* points = input->GetPointData();
  const char* name = chosen->Get(vtkDataObject::FIELD_NAME());
  const bool byAttribute = !name && chosen->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
  vtkAbstractArray* found = name ? points->GetAbstractArray(name)
    : byAttribute ? points->GetAbstractAttribute(chosen->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE()))
                  : nullptr;
  const std::string given = name ? name : "";
  const int association = chosen->Get(vtkDataObject::FIELD_ASSOCIATION());
  const bool ofPoints = association == vtkDataObject::FIELD_ASSOCIATION_POINTS ||
    association == vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS;
  const bool isDefault = index == ControlWeightsIndex && given == "FairingWeight";
  if ((!name && !byAttribute) ||
    (ofPoints && !found && (byAttribute || isDefault || given.empty() || given == "None")))
  {
    return {};
  }
  const std::string remedy =
    text(" Choose a point array of ", components, components == 1 ? " component" : " components",
      " and one tuple per point with SetInputArrayToProcess(", index, ", ...), or none by \"\".");
  if (!ofPoints || !found)
  {
    return text("The array of ", what, ", \"", given, "\", is not ",
      ofPoints ? "there." : "one of points.", remedy);
  }
  array = vtkDataArray::SafeDownCast(found);
  const std::string title = found->GetName() ? found->GetName() : "";
  if (!array)
  {
    return text("The array of ", what, ", \"", title, "\", is a ", found->GetClassName(),
      " and holds no numbers.", remedy);
  }
  if (array->GetNumberOfComponents() != components ||
    array->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    return text("The array of ", what, ", \"", title, "\", has ", array->GetNumberOfComponents(),
      " components and ", array->GetNumberOfTuples(), " tuples for ", input->GetNumberOfPoints(),
      " points.", remedy);
  }
  return {};
}

std::string checkPointArrays(vtkDataSet* input)
{
  vtkPointData* data = input->GetPointData();
  for (int k = 0; k < data->GetNumberOfArrays(); ++k)
  {
    vtkAbstractArray* array = data->GetAbstractArray(k);
    if (array->GetNumberOfTuples() != input->GetNumberOfPoints())
    {
      return text("The point array \"", array->GetName() ? array->GetName() : "", "\" has ",
        array->GetNumberOfTuples(), " tuples for ", input->GetNumberOfPoints(),
        " points. Give it one tuple per point, or remove it.");
    }
  }
  return {};
}

std::string checkExtent(const Eigen::MatrixXd& points)
{
  double extent = 0, largest = 0;
  for (Eigen::Index c = 0; c < points.cols(); ++c)
  {
    extent = std::max(extent, points.col(c).maxCoeff() - points.col(c).minCoeff());
    largest = std::max(largest, points.col(c).cwiseAbs().maxCoeff());
  }
  if (extent > LargestExtent || (extent > 0 && extent < SmallestExtent) ||
    largest > std::numeric_limits<double>::max() / 4)
  {
    return text("The points have an extent of ", extent, " and coordinates up to ", largest,
      "; extents from ", SmallestExtent, " to ", LargestExtent,
      " can be computed with. Scale the points.");
  }
  return {};
}

std::string checkMemory(const std::vector<FairingRound>& rounds,
  const FairingParameters& parameters, double samples, double bytesPerSample, vtkDataSet* input)
{
  double bytesOfArrays = 0;
  vtkPointData* data = input->GetPointData();
  for (int k = 0; k < data->GetNumberOfArrays(); ++k)
  {
    const vtkAbstractArray* array = data->GetAbstractArray(k);
    bytesOfArrays += double(array->GetNumberOfComponents()) * array->GetDataTypeSize();
  }
  double needed = samples * (bytesPerSample + bytesOfArrays), controls = 0, points = 0;
  for (const FairingRound& round : rounds)
  {
    const auto n = static_cast<double>(round.Spline.size());
    const auto m = static_cast<double>(round.Data.Points.rows());
    const double entries =
      (2. * round.Spline.Axes[0].degree() + 1) * (2. * round.Spline.Axes[1].degree() + 1);
    needed += m * (BytesPerDataPoint + bytesOfArrays) + n * BytesPerControlPoint +
      (round.Data.Gridded ? 0 : n * entries * 8);
    if (parameters.Options.Solver == FairingSolver::SparseDirect)
    {
      needed += n * entries * (BytesPerEntry + BytesPerFactorEntry * std::log2(n + 1));
    }
    controls += n;
    points += m;
  }
  const double available = memoryOfMachine();
  if (needed > MemoryShare * available)
  {
    return text("The fit would take about ", needed / Gibibyte, " GiB of memory (", controls,
      " control points, ", points, " data points, ", samples, " samples); the machine has ",
      available / Gibibyte, " GiB. Reduce SampleDimensions or NumberOfControlPoints.");
  }
  return {};
}

std::string checkWeights(const Vector& weights, const std::string& name)
{
  for (Eigen::Index k = 0; k < weights.size(); ++k)
  {
    if (!isWeight(weights[k]))
    {
      return text("Value ", k, " of the fairing weights \"", name, "\" is ", weights[k],
        "; weights lie in [0, 1], 0 for fitting alone and 1 for fairing alone.");
    }
  }
  return {};
}

std::string nameOf(vtkDataArray* array)
{
  return array && array->GetName() ? array->GetName() : "";
}

Vector toVector(vtkDataArray* array)
{
  Vector values(array->GetNumberOfTuples());
  for (vtkIdType k = 0; k < values.size(); ++k)
  {
    values[k] = array->GetComponent(k, 0);
  }
  return values;
}

vtkDoubleArray* addPointArray(vtkPolyData* data, const char* name, int components)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(data->GetNumberOfPoints());
  data->GetPointData()->AddArray(array);
  return array;
}

void addFieldArray(vtkFieldData* field, const char* name, const std::vector<double>& values)
{
  addArray<vtkDoubleArray>(field, name, values);
}

void addFieldArray(vtkFieldData* field, const char* name, const std::vector<std::int64_t>& values)
{
  addArray<vtkIdTypeArray>(field, name, values);
}

void addHistories(vtkFieldData* field, const std::vector<FairingRound>& rounds)
{
  std::vector<double> iteration, fitting, energy;
  std::vector<std::int64_t> offsets = { 0 };
  const auto append = [](std::vector<double>& all, const std::vector<double>& more)
  { all.insert(all.end(), more.begin(), more.end()); };
  for (const FairingRound& round : rounds)
  {
    append(iteration, round.Result.History.IterationError);
    append(fitting, round.Result.History.FittingError);
    append(energy, round.Result.History.Energy);
    offsets.push_back(static_cast<std::int64_t>(iteration.size()));
  }
  addFieldArray(field, "IterationErrorHistory", iteration);
  addFieldArray(field, "FittingErrorHistory", fitting);
  addFieldArray(field, "FairingEnergyHistory", energy);
  addFieldArray(field, "HistoryOffsets", offsets);
}
}
