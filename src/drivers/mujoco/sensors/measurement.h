#pragma once
/// A Measurement holds the readings of the plant's sensors.

#include <algorithm>
#include <array>
#include <cstddef>
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

/// Copies the first `count` elements of a list; those behind are the same in both.
template <class Value, std::size_t N>
void copy_first(std::size_t count, const std::array<Value, N>& from, std::array<Value, N>& to) noexcept {
  std::copy_n(from.begin(), std::min(count, N), to.begin());
}

/// Copies all readings of a machine with so many joints and contacts.
inline void copy_readings(std::size_t joints, std::size_t contacts, const Measurement& from, Measurement& to) noexcept {
  copy_first(joints, from.joints, to.joints);
  to.imu = from.imu;
  copy_first(contacts, from.contacts, to.contacts);
  to.battery = from.battery;
  to.digital_inputs = from.digital_inputs;
}

}  // namespace robot_control
