#pragma once
/// wheel_loops returns the wheel loops of a set of parameters as plain Python values, with which identify.py checks its
/// proposals.

#include <pybind11/pybind11.h>

#include "configuration/parameters.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Returns one dict per drive wheel, in the order of the robot's wheels:
///   joint  side "left" | "right"  sign  radius m  wheels_beside (h of feed_forward.h)
///   effort_limit N·m  velocity_limit rad/s, 0: none
///   damping N·m·s/rad  friction N·m  lifted turning straight kg·m²      as the controller assumes them
///   kp ki kd model_inertia  bandwidth Hz  period s                      of its loop
pybind11::list wheel_loops(const Parameters& parameters, const DriveTrain& robot);

}  // namespace robot_control
