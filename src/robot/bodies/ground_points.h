#pragma once
/// Where a robot may touch level ground: the corners of its collision shapes at the zero pose, in base axes. A wheel
/// or a rolling caster counts with its lowest point alone, whatever its body's shapes.

#include <Eigen/Core>
#include <vector>

#include "robot/bodies/rigid_bodies.h"
#include "robot/robot_model.h"

namespace robot_control {

/// Rims of cylinders as 16 points each, the lowest among them; a sphere as its lowest point.
std::vector<Eigen::Vector3d> ground_points(const RobotModel& robot);

/// Those of one body.
std::vector<Eigen::Vector3d> ground_points(const RobotModel& robot, const RigidBody& body);

/// m, of the root frame above the plane that the lowest of them touches.
double standing_height(const RobotModel& robot);

/// The wheel or caster that `body` is; null for all others.
const WheelModel* rolling_body(const RobotModel& robot, const RigidBody& body);

}  // namespace robot_control
