// SPDX-License-Identifier: BSD-3-Clause
/**
 * Motions of scans: known ones are found, undetermined ones are 0, and what does not fit does not
 * count.
 */
#include "ScanMotions.h"

#include "TestSupport.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace ipia;
using Twist = Eigen::Matrix<double, 6, 1>;

const Eigen::Vector3d Centre(3, -2, 1);
constexpr double Radius = 2, CubeSide = 0.2;

/// A point of a scan that was moved by a twist from an ellipsoid about Centre, to first order.
ScanPoint pointOn(const Eigen::Vector3d& axes, test::Random& random, const Twist& twist, int scan)
{
  ScanPoint point;
  Eigen::Vector3d direction;
  do
  {
    direction =
      Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  } while (direction.norm() > 1 || direction.norm() < 0.1);
  direction.normalize();
  point.Position = Centre + axes.cwiseProduct(direction);
  point.Normal = direction.cwiseQuotient(axes).normalized();
  point.Distance =
    (twist.head<3>().cross(point.Position - Centre) + twist.tail<3>()).dot(point.Normal);
  point.Scan = scan;
  return point;
}

std::vector<ScanPoint> scansOf(const Eigen::Vector3d& axes, const std::vector<Twist>& twists, int n)
{
  test::Random random(1);
  std::vector<ScanPoint> points;
  for (std::size_t scan = 0; scan < twists.size(); ++scan)
  {
    for (int k = 0; k < n; ++k)
    {
      points.push_back(pointOn(axes, random, twists[scan], static_cast<int>(scan)));
    }
  }
  return points;
}

std::vector<Twist> someTwists(int n, double size)
{
  test::Random random(7);
  std::vector<Twist> twists;
  for (int scan = 0; scan < n; ++scan)
  {
    Twist twist;
    for (double& v : twist)
    {
      v = size * random.uniform(-1, 1);
    }
    twists.push_back(twist);
  }
  return twists;
}

Twist mean(const std::vector<Twist>& twists, std::size_t begin, std::size_t end)
{
  Twist sum = Twist::Zero();
  for (std::size_t scan = begin; scan < end; ++scan)
  {
    sum += twists[scan];
  }
  return sum / static_cast<double>(end - begin);
}

TEST(ScanMotions, FindsWhatScansWereMovedBy)
{
  const std::vector<Twist> moved = someTwists(5, 0.01);
  const ScanMotions found = findScanMotions(
    scansOf(Eigen::Vector3d(1.5, 1, 0.7), moved, 20000), 5, Centre, Radius, CubeSide);
  EXPECT_GT(found.Overlaps, 1000);
  EXPECT_GT(found.Misfit, 0.003);
  const Twist datum = mean(moved, 0, 5);
  for (std::size_t scan = 0; scan < 5; ++scan)
  {
    // The points of a scan are not spread in a cube as those of others are.
    EXPECT_LT((found.Twists[scan] + moved[scan] - datum).norm(), 5e-4) << scan;
  }
  EXPECT_LT(mean(found.Twists, 0, 5).norm(), 1e-12);
  EXPECT_LT(found.Predicted, 0.1 * found.Misfit);
}

TEST(ScanMotions, ScansThatAgreeStay)
{
  const std::vector<Twist> none(4, Twist::Zero());
  const ScanMotions found =
    findScanMotions(scansOf(Eigen::Vector3d(1.5, 1, 0.7), none, 5000), 4, Centre, Radius, CubeSide);
  EXPECT_EQ(found.Misfit, 0);
  for (const Twist& twist : found.Twists)
  {
    EXPECT_EQ(twist.norm(), 0);
  }
}

TEST(ScanMotions, NothingTurnsASphere)
{
  const ScanMotions found = findScanMotions(
    scansOf(Eigen::Vector3d::Ones(), someTwists(3, 0.01), 20000), 3, Centre, Radius, CubeSide);
  for (const Twist& twist : found.Twists)
  {
    EXPECT_LT(twist.head<3>().norm(), 1e-4);
    EXPECT_GT(twist.tail<3>().norm(), 1e-3);
  }
}

TEST(ScanMotions, NothingMovesAPlaneAlongItself)
{
  test::Random random(3);
  std::vector<ScanPoint> points;
  for (int k = 0; k < 4000; ++k)
  {
    const int scan = k % 2;
    points.push_back({ Centre + Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0),
      Eigen::Vector3d::UnitZ(), scan == 0 ? 0.01 : -0.01, scan });
  }
  const ScanMotions found = findScanMotions(points, 2, Centre, Radius, CubeSide);
  for (std::size_t scan = 0; scan < 2; ++scan)
  {
    const Twist& twist = found.Twists[scan];
    EXPECT_EQ(twist[2], 0);
    EXPECT_EQ(twist[3], 0);
    EXPECT_EQ(twist[4], 0);
    // The damping of 1 against the weights of about a hundred cubes.
    EXPECT_NEAR(twist[5], scan == 0 ? -0.01 : 0.01, 1e-4);
  }
  EXPECT_DOUBLE_EQ(found.Misfit, 0.01);
}

TEST(ScanMotions, GroupsThatDoNotOverlapHaveTheirOwnDatum)
{
  const std::vector<Twist> moved = someTwists(4, 0.01);
  std::vector<ScanPoint> points = scansOf(Eigen::Vector3d(1.5, 1, 0.7), moved, 10000);
  for (ScanPoint& point : points)
  {
    point.Position[0] += point.Scan < 2 ? 0 : 100;
  }
  const ScanMotions found = findScanMotions(points, 4, Centre, Radius, CubeSide);
  EXPECT_GT(found.Twists[0].norm(), 1e-3);
  EXPECT_LT(mean(found.Twists, 0, 2).norm(), 1e-12);
  EXPECT_LT(mean(found.Twists, 2, 4).norm(), 1e-12);
}

TEST(ScanMotions, ScansThatOverlapWithNoneStay)
{
  std::vector<ScanPoint> points = scansOf(Eigen::Vector3d(1.5, 1, 0.7), someTwists(3, 0.01), 5000);
  for (ScanPoint& point : points)
  {
    point.Position[1] += 10 * point.Scan;
  }
  const ScanMotions found = findScanMotions(points, 3, Centre, Radius, CubeSide);
  EXPECT_EQ(found.Overlaps, 0);
  EXPECT_EQ(found.Misfit, 0);
  for (const Twist& twist : found.Twists)
  {
    EXPECT_EQ(twist.norm(), 0);
  }
  EXPECT_TRUE(findScanMotions({}, 0, Centre, Radius, CubeSide).Twists.empty());
}

TEST(ScanMotions, WhatOneScanSeesAloneHardlyCounts)
{
  const std::vector<Twist> moved = someTwists(4, 0.001);
  std::vector<ScanPoint> points = scansOf(Eigen::Vector3d(1.5, 1, 0.7), moved, 20000);
  const ScanMotions without = findScanMotions(points, 4, Centre, Radius, CubeSide);
  for (ScanPoint& point : points)
  {
    // Something stood before the object in this scan.
    if (point.Scan == 2 && point.Position[0] > Centre[0] + 1.3)
    {
      point.Distance += 0.1;
    }
  }
  const ScanMotions with = findScanMotions(points, 4, Centre, Radius, CubeSide);
  for (std::size_t scan = 0; scan < 4; ++scan)
  {
    EXPECT_LT((with.Twists[scan] - without.Twists[scan]).norm(), 1e-4) << scan;
  }
}

TEST(ScanMotions, UnitsOfLengthDoNotMatter)
{
  const std::vector<Twist> moved = someTwists(3, 0.01);
  std::vector<ScanPoint> points = scansOf(Eigen::Vector3d(1.5, 1, 0.7), moved, 5000);
  const ScanMotions metres = findScanMotions(points, 3, Centre, Radius, CubeSide);
  for (ScanPoint& point : points)
  {
    point.Position *= 1024;
    point.Distance *= 1024;
  }
  const ScanMotions small =
    findScanMotions(points, 3, 1024 * Centre, 1024 * Radius, 1024 * CubeSide);
  EXPECT_DOUBLE_EQ(small.Misfit, 1024 * metres.Misfit);
  for (std::size_t scan = 0; scan < 3; ++scan)
  {
    EXPECT_LT((small.Twists[scan].head<3>() - metres.Twists[scan].head<3>()).norm(), 1e-12);
    EXPECT_LT((small.Twists[scan].tail<3>() / 1024 - metres.Twists[scan].tail<3>()).norm(), 1e-12);
  }
}
}
