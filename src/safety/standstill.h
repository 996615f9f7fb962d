#pragma once
/// Does the robot stand, by its wheels' joints alone (the monitor trusts no estimate)? A caster may still turn.
///
///   moving    |q̇_i| ≥ standstill_speed for a wheel i, or the joint samples are missing or not finite
///   standing  not moving for kStandingCycles in a row: differenced encoders read zero between two counts

#include <cstdint>

#include "signals/sensor_frame.h"

namespace robot_control {

class JointStandstill {
 public:
  static constexpr std::uint64_t kStandingCycles = 10;

  /// `standstill_speed` rad/s, > 0. The first `wheels` joints are judged.
  JointStandstill(double standstill_speed, std::size_t wheels) noexcept
      : standstill_speed_(standstill_speed), wheels_(wheels) {}

  void step(const SensorFrame& sensors) noexcept;
  void reset() noexcept { slow_cycles_ = 0; }

  bool moving() const noexcept { return slow_cycles_ == 0; }
  bool standing() const noexcept { return slow_cycles_ >= kStandingCycles; }

 private:
  double standstill_speed_;
  std::size_t wheels_;
  std::uint64_t slow_cycles_ = 0;
};

}  // namespace robot_control
