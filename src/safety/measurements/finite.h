#pragma once
/// Is every number finite that a frame claims to be valid?

#include <cstdint>

#include "signals/command_frame.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// The first joint whose sample is not, where joints are valid; kMaxJoints: none.
std::uint64_t not_finite_joint(const SensorFrame& sensors) noexcept;

/// Joints, gyro, accelerometer, contact forces and battery, as far as `valid` says they were measured.
bool finite(const SensorFrame& sensors) noexcept;

/// Used joints and both twists.
bool finite(const CommandFrame& command) noexcept;

}  // namespace robot_control
