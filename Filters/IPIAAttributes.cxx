// SPDX-License-Identifier: BSD-3-Clause
#include "IPIAAttributes.h"

#include "Core/Parallel.h"
#include "IPIAFitSolution.h"
#include "IPIAText.h"

#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPoints.h"

#include <algorithm>
#include <cmath>

namespace ipia
{
namespace
{
/// Sums of squares of larger values would leave the range of double.
constexpr double LargestValue = 1e100;

/// Arrays with a value at the same points.
struct Group
{
  std::vector<char> Has; ///< of each point of the cloud
  std::vector<std::size_t> Arrays;
  std::vector<Eigen::MatrixXd> Values; ///< components x points of the cloud
};

/// The values of an array at the points of the cloud, and where it has any.
/// @return the number of tuples that are not finite or too large
vtkIdType readArray(
  const PointCloud& cloud, const PointArray& array, Eigen::MatrixXd& values, std::vector<char>& has)
{
  const auto n = static_cast<Eigen::Index>(cloud.Ids.size());
  values.resize(array.NumberOfComponents(), n);
  has.assign(cloud.Ids.size(), 0);
  vtkIdType notFinite = 0, blockBegin = 0;
  std::size_t block = 0;
  for (Eigen::Index k = 0; k < n; ++k)
  {
    const auto i = static_cast<std::size_t>(k);
    while (cloud.Ids[i] - blockBegin >= cloud.Blocks[block]->GetNumberOfPoints())
    {
      blockBegin += cloud.Blocks[block++]->GetNumberOfPoints();
    }
    if (vtkDataArray* from = array.OfBlocks[block])
    {
      from->GetTuple(cloud.Ids[i] - blockBegin, values.col(k).data());
      has[i] = values.col(k).cwiseAbs().maxCoeff() <= LargestValue && values.col(k).allFinite();
      notFinite += has[i] == 0;
    }
  }
  return notFinite;
}
}

void AttributeFields::warn(const std::string& message)
{
  this->Warning += (this->Warning.empty() ? "" : " ") + message;
}

std::string AttributeFields::takeWarning()
{
  std::string warning;
  warning.swap(this->Warning);
  return warning;
}

void AttributeFields::clear()
{
  this->Planar.clear();
  this->Spatial.clear();
  this->FittedIdentity.clear();
  this->FittedLattice.clear();
}

double AttributeFields::numberOfComponents() const
{
  double components = 0;
  const auto add = [&](const auto& functions)
  {
    for (const auto& function : functions)
    {
      components += function.Spline.numberOfComponents();
    }
  };
  add(this->Planar);
  add(this->Spatial);
  return components;
}

bool AttributeFields::fit(const FitProblem& problem, const PointCloud& cloud, Identity identity,
  const ProgressCallback& progress)
{
  for (const PointArray& array : problem.Arrays)
  {
    for (vtkDataArray* block : array.OfBlocks)
    {
      appendArrayIdentity(block, identity);
    }
  }
  std::vector<double> lattice{ static_cast<double>(problem.FlatAxis) };
  for (int axis = 0; axis < 3; ++axis)
  {
    lattice.push_back(problem.Origin[axis]);
    lattice.push_back(problem.Spacing[axis]);
    lattice.push_back(problem.GridSize[axis]);
  }
  if (identity == this->FittedIdentity && lattice == this->FittedLattice)
  {
    return true;
  }
  this->clear();
  const bool done = problem.Dimension == 2 ? this->fitInDimension<2>(problem, cloud, progress)
                                           : this->fitInDimension<3>(problem, cloud, progress);
  if (!done)
  {
    this->clear();
    return false;
  }
  this->FittedIdentity = std::move(identity);
  this->FittedLattice = std::move(lattice);
  return true;
}

template <int Dim>
bool AttributeFields::fitInDimension(
  const FitProblem& problem, const PointCloud& cloud, const ProgressCallback& progress)
{
  const auto place = placementOf<Dim>(problem);
  if constexpr (Dim == 2)
  {
    this->PlanarPlace = place;
  }
  else
  {
    this->SpatialPlace = place;
  }
  std::vector<Group> groups;
  std::string left;
  for (std::size_t a = 0; a < problem.Arrays.size(); ++a)
  {
    const PointArray& array = problem.Arrays[a];
    Eigen::MatrixXd values;
    std::vector<char> has;
    const vtkIdType notFinite = readArray(cloud, array, values, has);
    bool anyWeight = false;
    for (std::size_t k = 0; k < has.size() && !anyWeight; ++k)
    {
      anyWeight = has[k] && (cloud.Weights.empty() || cloud.Weights[k] > 0);
    }
    if (!anyWeight)
    {
      this->warn(text("The point array \"", array.Prototype->GetName(),
        "\" has no value that could be fitted; results do not have it."));
      continue;
    }
    if (notFinite > 0)
    {
      left += text(left.empty() ? "" : ", ", notFinite, " of \"", array.Prototype->GetName(), "\"");
    }
    auto group = std::find_if(
      groups.begin(), groups.end(), [&has](const Group& other) { return other.Has == has; });
    if (group == groups.end())
    {
      group = groups.insert(groups.end(), Group{ std::move(has), {}, {} });
    }
    group->Arrays.push_back(a);
    group->Values.push_back(std::move(values));
  }
  if (!left.empty())
  {
    this->warn(
      "Left out of the fit of the point arrays: values that are not finite or beyond 1e100, " +
      left + ".");
  }

  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    Group& group = groups[g];
    AttributeInput<Dim> input;
    const auto count = static_cast<Eigen::Index>(std::count(group.Has.begin(), group.Has.end(), 1));
    input.Positions.resize(Dim, count);
    input.Weights.resize(cloud.Weights.empty() ? 0 : count);
    Eigen::Index next = 0;
    for (std::size_t k = 0; k < group.Has.size(); ++k)
    {
      if (group.Has[k])
      {
        input.Positions.col(next) = place.toLocal(cloud.Positions[k].data());
        if (!cloud.Weights.empty())
        {
          input.Weights[next] = cloud.Weights[k];
        }
        for (Eigen::MatrixXd& values : group.Values)
        {
          values.col(next) = values.col(static_cast<Eigen::Index>(k));
        }
        ++next;
      }
    }
    for (Eigen::MatrixXd& values : group.Values)
    {
      values.conservativeResize(Eigen::NoChange, count);
    }
    input.Arrays = std::move(group.Values);
    const auto share = [&](double ofGroup)
    {
      return !progress ||
        progress((static_cast<double>(g) + ofGroup) / static_cast<double>(groups.size()));
    };
    AttributeResult<Dim> fitted =
      fitAttributes(latticeOf<Dim>(problem, place), std::move(input), 0, share);
    if (fitted.Aborted)
    {
      return false;
    }
    for (std::size_t k = 0; k < group.Arrays.size(); ++k)
    {
      PointArray array = problem.Arrays[group.Arrays[k]];
      array.OfBlocks.clear();
      this->functions<Dim>().push_back({ std::move(array), std::move(fitted.Arrays[k]) });
    }
  }
  return true;
}

bool AttributeFields::isFree(const PointArray& array, vtkPointData* data)
{
  const char* name = array.Prototype->GetName();
  if (data->HasArray(name))
  {
    this->warn(text("The point array \"", name,
      "\" is left out: the result has an array of its own with this name. Rename it."));
    return false;
  }
  return true;
}

template <int Dim>
void AttributeFields::evaluateInDimension(
  const Placement<Dim>& place, vtkPoints* points, vtkPointData* data)
{
  const vtkIdType n = points->GetNumberOfPoints();
  for (const Function<Dim>& function : this->functions<Dim>())
  {
    if (!this->isFree(function.Array, data))
    {
      continue;
    }
    auto array = newArray(function.Array.Prototype, n);
    const int components = function.Spline.numberOfComponents();
    std::vector<double> values(static_cast<std::size_t>(n * components));
    parallelChunks(n, resolveThreads(0),
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          double x[3];
          points->GetPoint(i, x);
          function.Spline.evaluate(place.toLocal(x), values.data() + i * components);
        }
      });
    for (int c = 0; c < components; ++c)
    {
      writeComponent(array, c, values.data() + c, components);
    }
    data->AddArray(array);
    if (function.Array.Attribute >= 0 && !data->GetAbstractAttribute(function.Array.Attribute))
    {
      data->SetActiveAttribute(array->GetName(), function.Array.Attribute);
    }
  }
}

void AttributeFields::evaluate(vtkPoints* points, vtkPointData* data)
{
  this->evaluateInDimension<2>(this->PlanarPlace, points, data);
  this->evaluateInDimension<3>(this->SpatialPlace, points, data);
}

template <int Dim>
bool AttributeFields::sample(
  const AxisPositions<Dim>& positions, vtkPointData* data, const ProgressCallback& progress)
{
  vtkIdType n = 1;
  for (const std::vector<double>& axis : positions)
  {
    n *= static_cast<vtkIdType>(axis.size());
  }
  std::vector<double> values(static_cast<std::size_t>(this->functions<Dim>().empty() ? 0 : n));
  double finished = 0;
  for (const Function<Dim>& function : this->functions<Dim>())
  {
    const int components = function.Spline.numberOfComponents();
    if (!this->isFree(function.Array, data))
    {
      finished += components;
      continue;
    }
    auto array = newArray(function.Array.Prototype, n);
    for (int c = 0; c < components; ++c)
    {
      const bool done = function.Spline.sample(positions, c, values.data(), 0,
        [&](double share) { return !progress || progress(finished + share); });
      ++finished;
      if (!done || (progress && !progress(finished)))
      {
        return false;
      }
      writeComponent(array, c, values.data(), 1);
    }
    data->AddArray(array);
  }
  return true;
}

template bool AttributeFields::sample<2>(
  const AxisPositions<2>&, vtkPointData*, const ProgressCallback&);
template bool AttributeFields::sample<3>(
  const AxisPositions<3>&, vtkPointData*, const ProgressCallback&);
}
