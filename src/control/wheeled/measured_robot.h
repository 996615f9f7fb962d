#pragma once
/// Replaces values of the URDF by measured ones (identify.py) in the robot model of the controller.
///
/// Feed-forward, derived gains and the stability check use it. Plant, estimator and monitor use the described robot: a
/// mass with which the controller drives better is not necessarily the true mass. Geometry, limits and hash stay.

#include "control/wheeled/drive_controller_parameters.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Values that are absent in `measured` stay as described. Wheel inertia, damping and friction apply to every drive
/// wheel.
DriveTrain measured_robot(DriveTrain robot, const FeedForwardParameters& measured);

}  // namespace robot_control
