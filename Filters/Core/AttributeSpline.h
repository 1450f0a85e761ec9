// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * An array of values in space: one spline per component, on the levels of a hierarchy.
 */
#ifndef ipia_AttributeSpline_h
#define ipia_AttributeSpline_h

#include "BrickLattice.h"
#include "ImplicitSpline.h"

#include <memory>
#include <vector>

namespace ipia
{
/**
 * v_c(x) = min(max(a_c + b_c x + s sum_i C_ci B_i(x), low_c), high_c) of the components c: a linear
 * function and what is left to a spline, kept in the range of the values that it was fitted to.
 *
 * The spline is, as that of BrickSpline, in each knot cell that of the finest level that stores all
 * of the cell's coefficients. The components share the levels. Beyond the domain v is that of the
 * nearest point of it.
 */
template <int Dim>
class AttributeSpline
{
public:
  using Levels = std::vector<BrickLattice<Dim>>;

  struct Component
  {
    double Constant = 0;                   ///< a
    Point<Dim> Slope = Point<Dim>::Zero(); ///< b
    double Low = 0, High = 0;              ///< the range
    std::vector<BrickValues> Splines;      ///< C: of each level, in the order of its bricks
  };

  /// @param levels      coarse to fine; their own coefficients do not count
  /// @param scale       s
  /// @param components  with the same number of levels, not more than there are; none: s = 0
  AttributeSpline(
    std::shared_ptr<const Levels> levels, double scale, std::vector<Component> components);

  int numberOfComponents() const { return static_cast<int>(this->Components.size()); }
  const Component& component(int c) const { return this->Components[static_cast<std::size_t>(c)]; }

  /// All components at a position.
  void evaluate(const Point<Dim>& position, double* values) const;

  /**
   * One component on a grid inside the domain, x fastest.
   *
   * @param values  room for the product of the numbers of positions
   * @return false if the callback aborted
   */
  bool sample(const AxisPositions<Dim>& positions, int component, double* values, int threads = 0,
    const ProgressCallback& progress = {}) const;

private:
  std::shared_ptr<const Levels> Grids;
  double Scale;
  std::vector<Component> Components;
};
}

#endif
