// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A function of the core, of either dimension, placed in space.
 */
#ifndef IPIAPlacedSpline_h
#define IPIAPlacedSpline_h

#include "IPIAControlLattice.h"

#include <memory>

namespace ipia
{
class PlacedSpline
{
public:
  virtual ~PlacedSpline() = default;
  virtual double Value(const double x[3]) const = 0;
  virtual double ValueAndGradient(const double x[3], double g[3]) const = 0;
};

/// @param Function  ImplicitSpline or BrickSpline
template <int Dim, typename Function>
class PlacedSplineOf : public PlacedSpline
{
public:
  PlacedSplineOf(std::shared_ptr<const Function> function, const Placement<Dim>& place)
    : Spline(std::move(function))
    , Place(place)
  {
  }

  double Value(const double x[3]) const override
  {
    return this->Spline->value(this->Place.toLocal(x));
  }

  double ValueAndGradient(const double x[3], double g[3]) const override
  {
    Point<Dim> gradient;
    const double f = this->Spline->valueAndGradient(this->Place.toLocal(x), gradient);
    this->Place.toWorldVector(gradient, g);
    return f;
  }

private:
  std::shared_ptr<const Function> Spline;
  Placement<Dim> Place;
};

template <int Dim, typename Function>
std::shared_ptr<const PlacedSpline> placedSpline(
  std::shared_ptr<const Function> function, const Placement<Dim>& place)
{
  return std::make_shared<const PlacedSplineOf<Dim, Function>>(std::move(function), place);
}
}

#endif
