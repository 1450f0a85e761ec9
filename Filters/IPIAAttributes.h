// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The point arrays of the input as functions in space: fitted, sampled and evaluated.
 */
#ifndef IPIAAttributes_h
#define IPIAAttributes_h

#include "Core/AttributeFit.h"
#include "IPIAControlLattice.h"
#include "IPIAFitProblem.h"
#include "IPIAIdentity.h"

class vtkPointData;
class vtkPoints;

namespace ipia
{
class AttributeFields
{
public:
  /**
   * Fits the chosen arrays of a problem on its lattice, unless those are fitted already.
   *
   * @param cloud     points of the problem, with the values to fit
   * @param identity  of these and their weights
   * @return false if the callback aborted; there are no arrays then
   */
  bool fit(const FitProblem& problem, const PointCloud& cloud, Identity identity,
    const ProgressCallback& progress);

  void clear();

  /// What the last call of fit() left out; empty if nothing, or if it fitted nothing anew.
  std::string takeWarning();

  double numberOfComponents() const;

  /// The arrays at points, and what they were among the attributes of the input. Arrays of a name
  /// that @a data has are left out, as takeWarning() then tells.
  void evaluate(vtkPoints* points, vtkPointData* data);

  /**
   * The arrays on a grid. As evaluate(), without active attributes.
   *
   * @param progress  called with the number of components that are done, and parts of one
   */
  template <int Dim>
  bool sample(
    const AxisPositions<Dim>& positions, vtkPointData* data, const ProgressCallback& progress);

private:
  template <int Dim>
  struct Function
  {
    PointArray Array; ///< OfBlocks is empty
    AttributeSpline<Dim> Spline;
  };

  template <int Dim>
  std::vector<Function<Dim>>& functions()
  {
    if constexpr (Dim == 2)
    {
      return this->Planar;
    }
    else
    {
      return this->Spatial;
    }
  }

  template <int Dim>
  bool fitInDimension(
    const FitProblem& problem, const PointCloud& cloud, const ProgressCallback& progress);
  template <int Dim>
  void evaluateInDimension(const Placement<Dim>& place, vtkPoints* points, vtkPointData* data);
  bool isFree(const PointArray& array, vtkPointData* data);
  void warn(const std::string& message);

  std::vector<Function<2>> Planar;
  std::vector<Function<3>> Spatial;
  Placement<2> PlanarPlace;
  Placement<3> SpatialPlace;
  Identity FittedIdentity;
  std::vector<double> FittedLattice;
  std::string Warning;
};
}

#endif
