#pragma once
/// describe returns a robot as plain Python values, for reports and pictures.

#include <pybind11/pybind11.h>

#include "machine/machine_model.h"

namespace robot_control {

/// The values are in SI units and base axes unless another is named:
///   kind      "wheels" | "legs"
///   name source base_link mass centre_of_gravity [x y z]
///   imu       {link, position, orientation [x y z w]}
///   joints    [{name, link, role "wheel" | "leg" | "passive" | "held", type "continuous" | "revolute" | "prismatic",
///             driven, effort_limit, velocity_limit, lower, upper, mimicked}]
///   shapes    [{link, joint (that moves it; "" for the base), type "sphere" | "cylinder" | "box" | "mesh", in_base
///             (4 × 4), radius, length, size, points, triangles}], points and triangles in the shape's own axes
///   notes     [{kind "assumed" | "repaired" | "ignored" | "overridden" | "suspicious", element, text}]
/// A robot on wheels also has
///   yaw_inertia wheel_base wheel_base_multiplier effective_wheel_base
///   wheels    [{joint, side "left" | "right", centre, radius, width, sign, inertia, rotor_inertia}]
///   casters   the same without side and sign
/// A robot on legs, whose bodies are shown lying (machine/legs/lying_posture.h), also has
///   belly     m, height of the body's lowest point; rotor_inertia kg·m²
///   upright   {floor m, centre_of_gravity, in_base (of each shape)}: the robot as it stands, if its legs reach that far
///   legs      [{place "front_left" | …, joints [3], hip, knee, foot (m, at the zero pose), foot_radius, length,
///             bends "forward" | "backward", lying [3] rad, lying_foot}]
pybind11::dict describe(const MachineModel& robot);

}  // namespace robot_control
