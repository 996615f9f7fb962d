#pragma once
/// A robot in 64 bits: of its text and of everything the `robot:` block says.

#include <cstdint>
#include <string>

#include "robot/robot_model.h"

namespace robot_control {

std::uint64_t model_hash(const std::string& urdf, const RobotParameters& parameters);

}  // namespace robot_control
