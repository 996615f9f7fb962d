#pragma once
/// describe returns a DriveTrain as plain Python values, for reports and pictures.

#include <pybind11/pybind11.h>

#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// The values are in SI units and base axes unless another is named:
///   name source base_link mass yaw_inertia centre_of_gravity [x y z]
///   wheel_base wheel_base_multiplier effective_wheel_base
///   imu       {link, position, orientation [x y z w]}
///   wheels    [{joint, side "left" | "right", centre, radius, width, sign, inertia, rotor_inertia}]
///   casters   the same without side and sign
///   joints    [{name, link, role "wheel" | "passive" | "held", type "continuous" | "revolute" | "prismatic", driven,
///             effort_limit, velocity_limit, lower, upper, mimicked}]
///   shapes    [{link, joint (that moves it; "" for the base), type "sphere" | "cylinder" | "box" | "mesh", in_base
///             (4 × 4), radius, length, size, points, triangles}], points and triangles in the shape's own axes
///   notes     [{kind "assumed" | "repaired" | "ignored" | "overridden" | "suspicious", element, text}]
pybind11::dict describe(const DriveTrain& robot);

}  // namespace robot_control
