#pragma once
/// A frame is finite if all numbers are finite that it marks as valid.

#include <cstdint>

#include "signals/command_frame.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// The first joint with a valid number that is not finite; kMaxJoints: none.
std::uint64_t not_finite_joint(const SensorFrame& sensors) noexcept;

/// Joints, gyro, accelerometer, contact forces and battery, as far as they are marked as valid.
bool finite(const SensorFrame& sensors) noexcept;

/// Used joints, the request and the limited twist.
bool finite(const CommandFrame& command) noexcept;

}  // namespace robot_control
