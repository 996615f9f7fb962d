#pragma once
/// Computes a 64-bit hash of a robot's text and of everything in the `robot:` block.

#include <cstdint>
#include <string>

#include "machine/robot_model.h"

namespace robot_control {

std::uint64_t model_hash(const std::string& urdf, const RobotParameters& parameters);

}  // namespace robot_control
