#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "machine/description/mesh.h"

namespace robot_control::tests {

const Points kCube{{-1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, 1, 1}, {1, -1, -1}, {1, -1, 1}, {1, 1, -1}, {1, 1, 1}};

Eigen::Vector3d direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

double reach(const Points& points, const Eigen::Vector3d& direction) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : points) farthest = std::max(farthest, point.dot(direction));
  return farthest;
}

TEST(HullCorners, AreThoseOfACubeAmongWhatItHolds) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> inside(-0.99, 0.99);
  Points points = kCube;
  for (int i = 0; i < 1000; ++i) points.emplace_back(inside(random), inside(random), inside(random));
  std::shuffle(points.begin(), points.end(), random);
  EXPECT_EQ(hull_corners(points), kCube);
}

TEST(HullCorners, AreFoundAtAnySizeAndPlace) {
  for (const double size : {1e-9, 1e-3, 1e6}) {
    Points points;
    for (const Eigen::Vector3d& corner : kCube) points.push_back(size * (corner + Eigen::Vector3d(7, -8, 9)));
    EXPECT_EQ(hull_corners(points), points) << size;
  }
}

TEST(HullCorners, AreThoseOfThePolygonOfAFlatCloud) {
  const Eigen::AngleAxisd tilt(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  Points points;
  for (const double x : {-1.0, -0.3, 0.4, 1.0}) {
    for (const double y : {-2.0, 0.1, 2.0}) points.push_back(tilt * Eigen::Vector3d(x * (1 - 0.1 * std::abs(y)), y, 0));
  }
  const Points corners = hull_corners(points);
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d any = direction(random);
    EXPECT_NEAR(reach(corners, any), reach(points, any), 1e-12);
  }
  EXPECT_LE(corners.size(), 8U);
}

TEST(HullCorners, AreTheEndsOfAStraightCloud) {
  Points points;
  for (int i = 0; i <= 10; ++i) points.emplace_back(0.1 * i, 0.2 * i, -0.3 * i);
  EXPECT_EQ(hull_corners(points), (Points{points.front(), points.back()}));
}

TEST(HullCorners, AreThePointIfThereIsOne) {
  EXPECT_EQ(hull_corners(Points(5, {1, 2, 3})), (Points{{1, 2, 3}}));
  EXPECT_EQ(hull_corners({}), Points{});
}

TEST(HullCorners, AreStillTheOutlineOfTheThinnestSheet) {
  for (double thickness = 1e-3; thickness > 1e-12; thickness /= 3) {
    Points points = kCube;
    for (Eigen::Vector3d& point : points) point.z() *= thickness;
    const Points corners = hull_corners(points);
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(-1, 1, 0)}) {
      EXPECT_EQ(reach(corners, axis), 2) << thickness;
    }
  }
}

// h(u) of the ball is its radius everywhere.
TEST(HullCorners, AreFewAndLoseLittleOfTheFinestBall) {
  std::mt19937 random(3);
  Points points;
  for (int i = 0; i < 20'000; ++i) points.push_back(direction(random));
  const Points corners = hull_corners(points);
  EXPECT_EQ(corners.size(), kMaxHullCorners);
  double least = 1;
  for (int i = 0; i < 2000; ++i) least = std::min(least, reach(corners, direction(random)));
  EXPECT_GT(least, 1 - 0.005);
}

TEST(HullCorners, KeepTheBoundingBox) {
  std::mt19937 random(4);
  Points points;
  for (int i = 0; i < 5000; ++i) points.push_back(direction(random));
  const Points corners = hull_corners(points);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d along = sign * Eigen::Vector3d::Unit(axis);
      EXPECT_EQ(reach(corners, along), reach(points, along));
    }
  }
}

// A wheel of 4000 facets: its radius is what the corners are measured for.
TEST(HullCorners, KeepTheRadiusOfAWheel) {
  Points points;
  for (int i = 0; i < 4000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 4000;
    for (const double y : {-0.02, 0.02}) points.emplace_back(0.1 * std::cos(angle), y, 0.1 * std::sin(angle));
  }
  const Points corners = hull_corners(points);
  for (int i = 0; i < 1000; ++i) {
    const double angle = 0.001 + 2 * std::numbers::pi * i / 1000;
    EXPECT_NEAR(reach(corners, {std::cos(angle), 0, std::sin(angle)}), 0.1, 0.1 * 1e-4);
  }
}

// Σ v₀·(v₁ × v₂)/6 over outward triangles is the volume.
TEST(HullTriangles, FaceOutwardAndClose) {
  for (const double mirror : {-1.0, 1.0}) {
    Points points;
    for (const Eigen::Vector3d& corner : kCube)
      points.emplace_back(mirror * corner.x(), 2 * corner.y(), 3 * corner.z());
    points.emplace_back(0, 0, 0);
    double volume = 0;
    for (const auto& [a, b, c] : hull_triangles(points)) volume += points[a].dot(points[b].cross(points[c])) / 6;
    EXPECT_NEAR(volume, 2 * 4 * 6, 1e-9);
  }
}

TEST(HullTriangles, AreNoneOfAFlatCloud) {
  EXPECT_TRUE(hull_triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}).empty());
  EXPECT_TRUE(hull_triangles({}).empty());
}

}  // namespace robot_control::tests
