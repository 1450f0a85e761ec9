// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAPointCloud.h"

#include "Core/Parallel.h"
#include "IPIARowWeights.h"
#include "IPIAText.h"

#include "vtkAlgorithm.h"
#include "vtkAppendPolyData.h"
#include "vtkBoundingBox.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSMPTools.h"
#include "vtkStaticPointLocator.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace ipia
{
namespace
{
/// Extents and normal components below this share of the longest side (of 1) count as none.
constexpr double FlatTolerance = 1e-7;

/// The same for planes that are perpendicular to no axis, whose points are rounded on all.
constexpr double TiltedTolerance = 1e-6;

/// Lines and tilted planes are looked for with about so many points.
constexpr std::size_t PointsOfPlane = 1000;

/// Width of a line of points relative to its length, squared.
constexpr double LineTolerance = 1e-12;

/// A position may be nearer to another point by this factor than to its own.
constexpr double OffsetSlack = 0.9;

bool isFinite(const double* x, int n = 3)
{
  return std::all_of(x, x + n, [](double v) { return std::isfinite(v); });
}

using Vector3 = Eigen::Map<const Eigen::Vector3d>;

/// Optional arrays of one value per point.
constexpr struct
{
  int Index;
  const char* Name;
} PointScalars[] = { { PointCloud::WeightsIndex, "row weights" },
  { PointCloud::LocalFairingIndex, "local fairing weights" } };
}

/// What a part of the points shows.
struct PointCloud::Found
{
  LeftOutCounts LeftOut;
  std::array<double, 6> Bounds = { VTK_DOUBLE_MAX, -VTK_DOUBLE_MAX, VTK_DOUBLE_MAX, -VTK_DOUBLE_MAX,
    VTK_DOUBLE_MAX, -VTK_DOUBLE_MAX };
  bool AnyNormal = false, AnyWeight = false;

  void include(const std::array<double, 3>& low, const std::array<double, 3>& high)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      this->Bounds[2 * a] = std::min(this->Bounds[2 * a], low[a]);
      this->Bounds[2 * a + 1] = std::max(this->Bounds[2 * a + 1], high[a]);
    }
  }

  Found& operator+=(const Found& other)
  {
    this->LeftOut.NonFinitePoints += other.LeftOut.NonFinitePoints;
    this->LeftOut.InvalidNormals += other.LeftOut.InvalidNormals;
    this->LeftOut.InvalidWeights += other.LeftOut.InvalidWeights;
    this->include({ other.Bounds[0], other.Bounds[2], other.Bounds[4] },
      { other.Bounds[1], other.Bounds[3], other.Bounds[5] });
    this->AnyNormal = this->AnyNormal || other.AnyNormal;
    this->AnyWeight = this->AnyWeight || other.AnyWeight;
    return *this;
  }
};

void PointCloud::gather(const ArrayChooser& choose, const ArrayNamer& nameOf, vtkDataObject* input,
  vtkPolyData* extraRows)
{
  // All blocks as one data set. Each must have what is asked of it: appending drops arrays that
  // only some blocks have.
  std::vector<vtkPolyData*> blocks;
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(input))
  {
    auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      auto* block = vtkPolyData::SafeDownCast(iterator->GetCurrentDataObject());
      if (block && block->GetNumberOfPoints() > 0)
      {
        blocks.push_back(block);
      }
    }
  }
  else if (auto* single = vtkPolyData::SafeDownCast(input))
  {
    blocks.push_back(single);
  }
  vtkIdType total = 0;
  for (vtkPolyData* block : blocks)
  {
    total += block->GetNumberOfPoints();
  }
  if (total == 0)
  {
    this->Refusal = "The input has no points. Oriented points (vtkPolyData with point normals) are "
                    "needed; its cells are not used.";
    return;
  }
  std::vector<vtkDataArray*> ofBlocks; // weights, one for each block
  for (std::size_t b = 0; b < blocks.size(); ++b)
  {
    vtkDataArray* normals = choose(NormalsIndex, blocks[b]);
    this->ChosenArrays.push_back(normals);
    if (!normals || normals->GetNumberOfComponents() != 3 ||
      normals->GetNumberOfTuples() != blocks[b]->GetNumberOfPoints())
    {
      this->Refusal = blocks.size() > 1
        ? "Block " + std::to_string(b) + " of the input has no point normals"
        : std::string("The input has no point normals");
      this->Refusal += normals
        ? " (the array chosen has " + std::to_string(normals->GetNumberOfComponents()) +
          " components and " + std::to_string(normals->GetNumberOfTuples()) + " tuples for " +
          std::to_string(blocks[b]->GetNumberOfPoints()) + " points)."
        : std::string(".");
      this->Refusal +=
        " Choose a point array of 3 components with SetInputArrayToProcess(0, ...) or "
        "compute normals with vtkPCANormalEstimation, in ParaView with IPIA Oriented Point Cloud.";
      return;
    }
    for (const auto& scalar : PointScalars)
    {
      vtkDataArray* values = choose(scalar.Index, blocks[b]);
      this->ChosenArrays.push_back(values);
      const std::size_t inFirst = this->ChosenArrays.size() - 1 - b * (1 + std::size(PointScalars));
      const bool ofBlock = scalar.Index == WeightsIndex && isOfBlock(blocks[b], values);
      if (ofBlock && (values->GetNumberOfComponents() != 1 || values->GetNumberOfTuples() != 1))
      {
        this->Refusal = text("The field data array of ", scalar.Name, " has ",
          values->GetNumberOfComponents(), " components and ", values->GetNumberOfTuples(),
          " tuples; it must have one of each, the weight of all points of its block.");
        return;
      }
      if (ofBlock)
      {
        ofBlocks.push_back(values);
      }
      else if (values &&
        (values->GetNumberOfComponents() != 1 ||
          values->GetNumberOfTuples() != blocks[b]->GetNumberOfPoints()))
      {
        this->Refusal = text("The array of ", scalar.Name, " has ", values->GetNumberOfComponents(),
          " components and ", values->GetNumberOfTuples(), " tuples for ",
          blocks[b]->GetNumberOfPoints(),
          " points; it must have one component and one tuple per point.");
        return;
      }
      if ((values == nullptr) != (this->ChosenArrays[inFirst] == nullptr))
      {
        this->Refusal = text("Some blocks of the input have ", scalar.Name,
          " and others not. Give all of them the array.");
        return;
      }
    }
  }
  for (std::size_t k = 0; k < std::size(PointScalars); ++k)
  {
    const auto& scalar = PointScalars[k];
    const std::string name = nameOf(scalar.Index);
    if (!name.empty() && !this->ChosenArrays[1 + k])
    {
      this->Refusal = text("The input has no array named \"", name, "\" for the ", scalar.Name,
        ". Choose a point array of 1 component with SetInputArrayToProcess(", scalar.Index,
        ", ...), or none by \"None\".");
      return;
    }
  }
  this->Blocks.assign(blocks.begin(), blocks.end());
  if (blocks.size() == 1)
  {
    this->Source = blocks.front();
  }
  else
  {
    vtkNew<vtkAppendPolyData> append;
    append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    for (vtkPolyData* block : blocks)
    {
      append->AddInputData(block);
    }
    append->Update();
    this->Source = append->GetOutput();
  }
  vtkDataArray* normals = choose(NormalsIndex, this->Source);
  vtkSmartPointer<vtkDataArray> weights = choose(WeightsIndex, this->Source);
  if (!ofBlocks.empty())
  {
    weights = weightsOfBlocks(blocks, ofBlocks);
  }
  vtkDataArray* fairing = choose(LocalFairingIndex, this->Source);
  if (!normals)
  {
    this->Refusal =
      "The blocks of the input have no array of normals in common. Give it the same name "
      "in all of them.";
    return;
  }
  const vtkIdType n = this->Source->GetNumberOfPoints();
  Found found = this->takePoints(normals, weights, fairing);
  this->LeftOut = found.LeftOut;
  this->Bounds = found.Bounds;
  if (this->UseNormalLengths && found.AnyNormal)
  {
    found.AnyWeight = weighByLength(normals, this->Ids.data(), this->Ids.size(), this->Weights);
  }
  if (this->Ids.empty())
  {
    this->Refusal =
      "None of the " + std::to_string(n) + " points has finite coordinates and a valid weight.";
  }
  else if (this->Ids.size() == 1)
  {
    this->Refusal = "The input has one usable point; at least two are needed.";
  }
  else if (!found.AnyWeight)
  {
    this->Refusal = "All " + std::to_string(this->Ids.size()) + " row weights are zero.";
  }
  else if (this->longestSide() == 0)
  {
    this->Refusal = "All " + std::to_string(this->Ids.size()) + " points are equal.";
  }
  else if (!found.AnyNormal)
  {
    this->Refusal = "All " + std::to_string(this->Ids.size()) +
      " normals are zero or not finite. Compute normals with vtkPCANormalEstimation, in ParaView "
      "with IPIA Oriented Point Cloud.";
  }
  else if (extraRows)
  {
    this->gatherExtraRows(choose, extraRows);
  }
}

PointCloud::Found PointCloud::takePoints(
  vtkDataArray* normals, vtkDataArray* weights, vtkDataArray* fairing)
{
  const vtkIdType n = this->Source->GetNumberOfPoints();
  const auto size = static_cast<std::size_t>(n);
  this->Ids.resize(size);
  this->Positions.resize(size);
  this->Normals.resize(size);
  this->Weights.resize(weights ? size : 0);
  this->LocalFairing.resize(fairing ? size : 0);
  constexpr vtkIdType notTaken = -1;
  // Each point has its place; those left out leave gaps.
  auto found = parallelSum<Found>(n, resolveThreads(0),
    [&](vtkIdType begin, vtkIdType end)
    {
      Found part;
      for (vtkIdType id = begin; id < end; ++id)
      {
        const auto k = static_cast<std::size_t>(id);
        this->Ids[k] = notTaken;
        std::array<double, 3>& x = this->Positions[k];
        this->Source->GetPoint(id, x.data());
        if (!isFinite(x.data()))
        {
          ++part.LeftOut.NonFinitePoints;
          continue;
        }
        const double w = weights ? weights->GetComponent(id, 0) : 1.0;
        const double local = fairing ? fairing->GetComponent(id, 0) : 1.0;
        if (!(w >= 0 && std::isfinite(w) && local > 0 && std::isfinite(local)))
        {
          ++part.LeftOut.InvalidWeights;
          continue;
        }
        part.AnyWeight = part.AnyWeight || w > 0;
        if (weights)
        {
          this->Weights[k] = w;
        }
        if (fairing)
        {
          this->LocalFairing[k] = local;
        }
        std::array<double, 3>& normal = this->Normals[k];
        normals->GetTuple(id, normal.data());
        // Scaled first, so that neither tiny nor huge normals under- or overflow.
        const double largest =
          std::max({ std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2]) });
        if (isFinite(normal.data()) && largest > 0)
        {
          for (double& v : normal)
          {
            v /= largest;
          }
          vtkMath::Normalize(normal.data());
          part.AnyNormal = true;
        }
        else
        {
          normal = { 0, 0, 0 };
          ++part.LeftOut.InvalidNormals;
        }
        this->Ids[k] = id;
        part.include(x, x);
      }
      return part;
    });
  if (found.LeftOut.Total() > found.LeftOut.InvalidNormals)
  {
    this->keepIf([this](std::size_t k) { return this->Ids[k] != notTaken; });
  }
  return found;
}

void PointCloud::feather(const std::vector<double>& factors)
{
  this->Feathering = factors;
  this->Weights.resize(this->Weights.empty() ? factors.size() : this->Weights.size(), 1.0);
  for (std::size_t k = 0; k < factors.size(); ++k)
  {
    this->Weights[k] *= factors[k];
  }
}

void PointCloud::gatherExtraRows(const ArrayChooser& choose, vtkPolyData* extraRows)
{
  const vtkIdType n = extraRows->GetNumberOfPoints();
  if (n == 0)
  {
    return;
  }
  vtkDataArray* values = choose(ExtraValuesIndex, extraRows);
  this->ChosenArrays.push_back(values);
  if (!values || values->GetNumberOfComponents() != 1 || values->GetNumberOfTuples() != n)
  {
    this->Refusal =
      "The extra rows (input port 1) have no target values. Choose a point array of one "
      "component with SetInputArrayToProcess(2, 1, ...).";
    return;
  }
  for (vtkIdType id = 0; id < n; ++id)
  {
    std::array<double, 3> x;
    extraRows->GetPoint(id, x.data());
    const double value = values->GetComponent(id, 0);
    if (isFinite(x.data()) && std::isfinite(value))
    {
      this->ExtraPositions.push_back(x);
      this->ExtraValues.push_back(value);
    }
    else
    {
      ++this->LeftOut.NonFiniteExtraRows;
    }
  }
}

void PointCloud::keepIf(const std::function<bool(std::size_t)>& stays)
{
  std::size_t kept = 0;
  for (std::size_t k = 0; k < this->Positions.size(); ++k)
  {
    if (stays(k))
    {
      this->Positions[kept] = this->Positions[k];
      this->Normals[kept] = this->Normals[k];
      this->Ids[kept] = this->Ids[k];
      for (std::vector<double>* scalars :
        { &this->Weights, &this->LocalFairing, &this->Feathering })
      {
        if (!scalars->empty())
        {
          (*scalars)[kept] = (*scalars)[k];
        }
      }
      ++kept;
    }
  }
  this->Positions.resize(kept);
  this->Normals.resize(kept);
  this->Ids.resize(kept);
  this->Weights.resize(this->Weights.empty() ? 0 : kept);
  this->LocalFairing.resize(this->LocalFairing.empty() ? 0 : kept);
  this->Feathering.resize(this->Feathering.empty() ? 0 : kept);
}

std::unique_ptr<PointCloud> withoutPoints(
  const PointCloud& cloud, const std::vector<std::int64_t>& points)
{
  if (points.empty())
  {
    return nullptr;
  }
  auto others = std::make_unique<PointCloud>(cloud);
  auto next = points.begin();
  others->keepIf(
    [&](std::size_t k)
    {
      const bool goes = next != points.end() && static_cast<std::size_t>(*next) == k;
      next += goes;
      return !goes;
    });
  return others;
}

double PointCloud::longestSide() const
{
  return std::max({ this->Bounds[1] - this->Bounds[0], this->Bounds[3] - this->Bounds[2],
    this->Bounds[5] - this->Bounds[4] });
}

namespace
{
/// The second moments of every step'th point about their centre, which is given back; the unit of
/// length is the longest side of the cloud.
Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> momentsOf(
  const PointCloud& cloud, std::size_t step, Eigen::Vector3d& centre)
{
  const Vector3 first(cloud.Positions.front().data());
  const auto stride = static_cast<std::int64_t>(step);
  const std::int64_t n = (static_cast<std::int64_t>(cloud.Positions.size()) + stride - 1) / stride;
  const auto at = [&](std::int64_t k)
  { return Vector3(cloud.Positions[static_cast<std::size_t>(k * stride)].data()); };
  centre = parallelSum<Eigen::Vector3d>(
    n, resolveThreads(0),
    [&](std::int64_t begin, std::int64_t end)
    {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::int64_t k = begin; k < end; ++k)
      {
        sum += at(k) - first;
      }
      return sum;
    },
    Eigen::Vector3d::Zero());
  centre = first + centre / static_cast<double>(n);
  const double side = cloud.longestSide();
  const auto scatter = parallelSum<Eigen::Matrix3d>(
    n, resolveThreads(0),
    [&](std::int64_t begin, std::int64_t end)
    {
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      for (std::int64_t k = begin; k < end; ++k)
      {
        const Eigen::Vector3d d = (at(k) - centre) / side;
        sum += d * d.transpose();
      }
      return sum;
    },
    Eigen::Matrix3d::Zero());
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter);
}
}

bool PointCloud::isLine() const
{
  const auto areOnLine = [this](std::size_t step)
  {
    Eigen::Vector3d centre;
    const Eigen::Vector3d moments = momentsOf(*this, step, centre).eigenvalues();
    return moments[1] <= LineTolerance * moments[2];
  };
  // Some points tell that all are not on one.
  return areOnLine(1 + this->Positions.size() / PointsOfPlane) && areOnLine(1);
}

bool PointCloud::tiltedPlane(Frame& frame, int& axis) const
{
  Eigen::Vector3d centre;
  // Some points suggest a plane, which all are then held against.
  const auto moments = momentsOf(*this, 1 + this->Positions.size() / PointsOfPlane, centre);
  if (moments.eigenvalues()[1] <= LineTolerance * moments.eigenvalues()[2])
  {
    return false;
  }
  const Eigen::Vector3d across = moments.eigenvectors().col(0);
  const double thickness = TiltedTolerance * this->longestSide();
  for (std::size_t k = 0; k < this->Positions.size(); ++k)
  {
    if (!(std::abs(across.dot(Vector3(this->Positions[k].data()) - centre)) <= thickness) ||
      !(std::abs(across.dot(Vector3(this->Normals[k].data()))) <= TiltedTolerance))
    {
      return false;
    }
  }
  frame = Frame::acrossPlane(centre, across, axis);
  return true;
}

std::array<double, 6> PointCloud::boundsIn(const Frame& frame) const
{
  if (!frame.isTurned())
  {
    return this->Bounds;
  }
  vtkBoundingBox box;
  for (const auto& position : this->Positions)
  {
    box.AddPoint(frame.toFrame(position.data()).data());
  }
  std::array<double, 6> bounds;
  box.GetBounds(bounds.data());
  return bounds;
}

int PointCloud::axisWithoutExtent() const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto a = static_cast<std::size_t>(axis);
    if (this->Bounds[2 * a + 1] - this->Bounds[2 * a] <= FlatTolerance * this->longestSide())
    {
      return axis;
    }
  }
  return -1;
}

int PointCloud::flatAxis() const
{
  for (int axis = 2; axis >= 0; --axis)
  {
    const auto a = static_cast<std::size_t>(axis);
    if (this->Bounds[2 * a + 1] - this->Bounds[2 * a] <= FlatTolerance * this->longestSide() &&
      std::all_of(this->Normals.begin(), this->Normals.end(),
        [a](const std::array<double, 3>& n) { return std::abs(n[a]) <= FlatTolerance; }))
    {
      return axis;
    }
  }
  return -1;
}

std::vector<double> PointCloud::offsetDistances(double distance, double side) const
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(this->Positions.size()));
  for (std::size_t k = 0; k < this->Positions.size(); ++k)
  {
    points->SetPoint(static_cast<vtkIdType>(k), this->Positions[k].data());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(data);
  locator->BuildLocator();

  std::vector<double> distances(this->Positions.size(), 0.0);
  vtkSMPTools::For(0, static_cast<vtkIdType>(this->Positions.size()),
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType id = begin; id < end; ++id)
      {
        const auto k = static_cast<std::size_t>(id);
        const Vector3 p(this->Positions[k].data());
        const Eigen::Vector3d n = side * Vector3(this->Normals[k].data());
        double reach = n.isZero(0) ? 0.0 : distance;
        while (reach > 0)
        {
          const Eigen::Vector3d x = p + reach * n;
          double squared = 0;
          const vtkIdType nearest =
            locator->FindClosestPointWithinRadius(OffsetSlack * reach, x.data(), squared);
          if (nearest < 0)
          {
            break;
          }
          // The distance at which this neighbour is nearer by just the slack:
          // |reach n - e|^2 = (slack reach)^2.
          const Eigen::Vector3d e =
            Vector3(this->Positions[static_cast<std::size_t>(nearest)].data()) - p;
          constexpr double a = 1 - OffsetSlack * OffsetSlack;
          const double along = n.dot(e);
          const double root = std::sqrt(std::max(0.0, along * along - a * e.squaredNorm()));
          const double shorter = (along - root) / a;
          if (!(shorter < reach * (1 - 1e-6)))
          {
            break; // the neighbour that drew it in last, found again by rounding
          }
          reach = shorter;
        }
        distances[k] = reach;
      }
    });
  return distances;
}
}
