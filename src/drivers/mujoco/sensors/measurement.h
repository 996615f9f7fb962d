#pragma once
/// A Measurement holds the readings of the plant's sensors.

#include <array>
#include <cstdint>

#include "drivers/mujoco/motors/battery.h"
#include "signals/joint.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// All readings of the plant's sensors at one time.
struct Measurement {
  std::array<JointSample, kMaxJoints> joints{};
  ImuSample imu;
  std::array<ContactSample, kMaxContacts> contacts{};
  BatterySample battery;
  std::uint64_t digital_inputs = 0;  ///< DigitalInput bits
};

}  // namespace robot_control
