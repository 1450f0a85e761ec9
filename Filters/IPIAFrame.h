// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The frame that a fit is made in: the axes of space, or these turned to a tilted plane.
 */
#ifndef IPIAFrame_h
#define IPIAFrame_h

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>

namespace ipia
{
/// Turns space about a pivot: x = pivot + direction (x' - pivot), x' in the frame.
class Frame
{
public:
  /// The axes of space.
  Frame() = default;

  /// @param direction  the axes of the frame as columns, orthonormal
  Frame(const Eigen::Vector3d& pivot, const Eigen::Matrix3d& direction)
    : Turned(!direction.isIdentity(0))
    , Pivot(pivot)
    , Axes(direction)
  {
  }

  /// Turns by the smallest angle that brings an axis of space across a plane: the axis is that
  /// nearest to the plane's unit normal.
  static Frame acrossPlane(const Eigen::Vector3d& pivot, Eigen::Vector3d normal, int& axis)
  {
    normal.cwiseAbs().maxCoeff(&axis);
    normal *= normal[axis] < 0 ? -1 : 1;
    return { pivot,
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::Unit(axis), normal).toRotationMatrix() };
  }

  bool isTurned() const { return this->Turned; }
  const Eigen::Matrix3d& direction() const { return this->Axes; }

  std::array<double, 3> toFrame(const double x[3]) const
  {
    return this->turned(x,
      [this](const Eigen::Vector3d& d) -> Eigen::Vector3d
      { return this->Pivot + this->Axes.transpose() * (d - this->Pivot); });
  }

  std::array<double, 3> toWorld(const double x[3]) const
  {
    return this->turned(x,
      [this](const Eigen::Vector3d& d) -> Eigen::Vector3d
      { return this->Pivot + this->Axes * (d - this->Pivot); });
  }

  std::array<double, 3> vectorToFrame(const double v[3]) const
  {
    return this->turned(v,
      [this](const Eigen::Vector3d& d) -> Eigen::Vector3d { return this->Axes.transpose() * d; });
  }

  std::array<double, 3> vectorToWorld(const double v[3]) const
  {
    return this->turned(
      v, [this](const Eigen::Vector3d& d) -> Eigen::Vector3d { return this->Axes * d; });
  }

private:
  template <typename Map>
  std::array<double, 3> turned(const double x[3], const Map& map) const
  {
    std::array<double, 3> y{ x[0], x[1], x[2] };
    if (this->Turned)
    {
      Eigen::Map<Eigen::Vector3d>(y.data()) = map(Eigen::Vector3d(x[0], x[1], x[2]));
    }
    return y;
  }

  bool Turned = false;
  Eigen::Vector3d Pivot = Eigen::Vector3d::Zero();
  Eigen::Matrix3d Axes = Eigen::Matrix3d::Identity();
};
}

#endif
