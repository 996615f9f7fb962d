#pragma once
/// Returns the points where a robot may touch level ground: the corners of its collision shapes at the zero pose, in
/// base axes. A wheel or a rolling caster counts with its lowest point alone.

#include <Eigen/Core>
#include <vector>

#include "machine/bodies/rigid_bodies.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Returns the points of all bodies. Rims of cylinders are 16 points each, with the lowest among them; a sphere is its
/// lowest point.
std::vector<Eigen::Vector3d> ground_points(const DriveTrain& robot);

/// Returns the points of one body.
std::vector<Eigen::Vector3d> ground_points(const DriveTrain& robot, const RigidBody& body);

/// Returns the height of the root frame above the plane that the lowest point touches, m.
double standing_height(const DriveTrain& robot);

/// Returns the wheel or caster that `body` is; null for all others.
const WheelModel* rolling_body(const DriveTrain& robot, const RigidBody& body);

}  // namespace robot_control
