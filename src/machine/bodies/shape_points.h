#pragma once
/// Returns the points where a machine may touch level ground: the corners of its collision shapes, in base axes.

#include <Eigen/Core>
#include <vector>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// A body that rolls touches the ground as one ellipsoid (radius, radius, width/2) about its axle, whatever its shapes.
struct RollingEllipsoid {
  Vector3 centre_base{};  ///< m
  double radius = 0;      ///< m
  double width = 0;       ///< m
};

/// Returns the points of one body. A rolling one is its lowest point alone, and `rolling` is not null. A rim of a
/// cylinder is 16 points, with the lowest among them; a sphere is its lowest point.
std::vector<Eigen::Vector3d> shape_points(const RigidBody& body, const RollingEllipsoid* rolling);

/// Returns the height of the root frame above the plane that the lowest of `points` touches, m. There is one at least.
double height_above(const std::vector<Eigen::Vector3d>& points);

}  // namespace robot_control
