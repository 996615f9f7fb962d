#pragma once
/// Are all numbers finite that a frame marks as valid?

#include <cstdint>

#include "signals/command_frame.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// The first joint with a sample that is not finite, if joints are valid; kMaxJoints: none.
std::uint64_t not_finite_joint(const SensorFrame& sensors) noexcept;

/// Joints, gyro, accelerometer, contact forces and battery, as far as `valid` marks them.
bool finite(const SensorFrame& sensors) noexcept;

/// Used joints and both twists.
bool finite(const CommandFrame& command) noexcept;

}  // namespace robot_control
