#pragma once
/// Does the robot stand, by its joints alone (the monitor trusts no estimate)?
///
///   moving    |q̇_i| ≥ standstill_speed for a joint i, or the joint samples are missing or not finite
///   standing  not moving for kStandingCycles in a row: differenced encoders read zero between two counts

#include <cstdint>

#include "signals/sensor_frame.h"

namespace robot_control {

class JointStandstill {
 public:
  static constexpr std::uint64_t kStandingCycles = 10;

  /// rad/s, > 0.
  explicit JointStandstill(double standstill_speed) noexcept : standstill_speed_(standstill_speed) {}

  void step(const SensorFrame& sensors) noexcept;
  void reset() noexcept { *this = JointStandstill(standstill_speed_); }

  bool moving() const noexcept { return slow_cycles_ == 0; }
  bool standing() const noexcept { return slow_cycles_ >= kStandingCycles; }

 private:
  double standstill_speed_;
  std::uint64_t slow_cycles_ = 0;
};

}  // namespace robot_control
