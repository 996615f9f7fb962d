#pragma once
/// Computes how strongly a robot may brake before its wheels lift.

#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Returns the deceleration in m/s² at which the first wheel lifts. A value of g or more practically never occurs; 0
/// means that there is no support before or behind the centre of gravity. A support lies at the horizontal distance d
/// from the centre of gravity, whose height is c. About it, inertia m a c outweighs m g d from a = g d / c on, where d
/// belongs to the nearer one of the foremost and rearmost supports. Supports are the ground points (ground_points.h)
/// that touch the ground when the robot tilts by at most 3° about the centre of gravity's foot.
double lifting_deceleration(const DriveTrain& robot);

}  // namespace robot_control
