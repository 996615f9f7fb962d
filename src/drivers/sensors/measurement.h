#pragma once
/// What the sensors of the plant read.

#include <array>
#include <cstdint>

#include "drivers/motors/battery.h"
#include "signals/joint.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// Everything that a sensor of the plant reports of one instant.
struct Measurement {
  std::array<JointSample, kMaxJoints> joints{};
  ImuSample imu;
  std::array<Vector3, kMaxContacts> contact_forces{};
  BatterySample battery;
  std::uint64_t digital_inputs = 0;  ///< DigitalInput bits
};

}  // namespace robot_control
