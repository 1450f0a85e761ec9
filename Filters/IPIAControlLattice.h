// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Where a fit lies in space, and a fit as a vtkImageData.
 */
#ifndef IPIAControlLattice_h
#define IPIAControlLattice_h

#include "Core/ImplicitSpline.h"
#include "IPIAFrame.h"

#include "vtkImageData.h"

#include <algorithm>
#include <memory>
#include <string>

class vtkDataArray;

namespace ipia
{
/// The frame of a fit, the axes of it that the Dim axes of the fit lie along, and the lower corner
/// of its domain there. In 2-D the origin's coordinate on the third axis is that of the plane.
template <int Dim>
struct Placement
{
  Frame Turn;
  std::array<int, Dim> Axis{};
  std::array<double, 3> Origin{};

  Point<Dim> toLocal(const double x[3]) const
  {
    const std::array<double, 3> inFrame = this->Turn.toFrame(x);
    Point<Dim> p;
    for (int a = 0; a < Dim; ++a)
    {
      const auto axis = static_cast<std::size_t>(this->Axis[a]);
      p[a] = inFrame[axis] - this->Origin[axis];
    }
    return p;
  }

  Point<Dim> toLocalVector(const double v[3]) const
  {
    const std::array<double, 3> inFrame = this->Turn.vectorToFrame(v);
    Point<Dim> p;
    for (int a = 0; a < Dim; ++a)
    {
      p[a] = inFrame[static_cast<std::size_t>(this->Axis[a])];
    }
    return p;
  }

  void toWorldVector(const Point<Dim>& v, double g[3]) const
  {
    double inFrame[3] = { 0, 0, 0 };
    for (int a = 0; a < Dim; ++a)
    {
      inFrame[this->Axis[a]] = v[a];
    }
    const std::array<double, 3> world = this->Turn.vectorToWorld(inFrame);
    std::copy_n(world.begin(), 3, g);
  }

  /// The placement of a lattice with the axis @a flat (0 to 2) left out in 2-D.
  static Placement withFlatAxis(int flat)
  {
    Placement placement;
    for (int axis = 0, a = 0; axis < 3 && a < Dim; ++axis)
    {
      if (Dim == 3 || axis != flat)
      {
        placement.Axis[static_cast<std::size_t>(a++)] = axis;
      }
    }
    return placement;
  }
};

/// Names of the arrays of a control lattice.
constexpr const char* CoefficientArrayName = "Coefficient";
constexpr const char* WeightArrayName = "Weight";
constexpr const char* FarFieldArrayName = "FarField";
constexpr const char* FarFieldMagnitudeArrayName = "FarFieldMagnitude";

/// Turns an image into a frame that its origin is given in.
void placeImage(const Frame& frame, const double origin[3], vtkImageData* image);

/// Turns the vectors of an array from a frame into space.
void turnVectors(const Frame& frame, vtkDataArray* vectors);

/// Writes a spline as a control lattice: origin lo - h, spacing h, dimensions N.
template <int Dim>
void toControlLattice(
  const ImplicitSpline<Dim>& spline, const Placement<Dim>& placement, vtkImageData* image);

/// The number of axes along which an image extends.
int dimensionOfControlLattice(vtkImageData* image);

/// Reads a spline back. Returns what is wrong, or an empty string.
template <int Dim>
std::string fromControlLattice(
  vtkImageData* image, std::unique_ptr<ImplicitSpline<Dim>>& spline, Placement<Dim>& placement);
}

#endif
