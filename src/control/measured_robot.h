#pragma once
/// The robot as its controller believes it: the URDF's, and over it what was measured (identify.py).
///
/// From it follow feed-forward, derived gains and the stability check. Plant, estimator and monitor keep the robot that
/// they read: what drives better with 13 kg need not weigh them. Geometry, limits and hash stay.

#include "control/drive_controller_parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// What is absent in `measured` stays as it is. Wheel inertia, damping and friction are of every drive wheel alike.
RobotModel measured_robot(RobotModel robot, const FeedForwardParameters& measured);

}  // namespace robot_control
