#pragma once
/// How hard a robot may brake before its wheels lift.

#include "robot/robot_model.h"

namespace robot_control {

/// m/s², at which the first wheel lifts; g or more is as good as never, 0: it leans on nothing before or behind its
/// centre of gravity. About a support at the horizontal distance d from the centre of gravity, which is at the height
/// c, inertia m a c outweighs m g d from a = g d / c on. d is the distance to the foremost or rearmost support,
/// whichever is less. Supports are the ground points (ground_points.h) that are on the ground, or come to it when the
/// robot tilts by 3° about the centre of gravity's foot.
double lifting_deceleration(const RobotModel& robot);

}  // namespace robot_control
