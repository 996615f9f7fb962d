#pragma once
/// Returns the points where a drive train may touch level ground at the zero pose, in base axes
/// (machine/bodies/shape_points.h). Its wheels and rolling casters roll.

#include <Eigen/Core>
#include <vector>

#include "machine/bodies/shape_points.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

std::vector<Eigen::Vector3d> ground_points(const DriveTrain& robot);

/// Returns the points of one body.
std::vector<Eigen::Vector3d> ground_points(const DriveTrain& robot, const RigidBody& body);

/// Returns the height of the root frame above the plane that the lowest point touches, m.
double standing_height(const DriveTrain& robot);

/// Returns the wheel or caster that `body` is; null for all others.
const WheelModel* rolling_body(const DriveTrain& robot, const RigidBody& body);

RollingEllipsoid ellipsoid_of(const WheelModel& wheel);

}  // namespace robot_control
