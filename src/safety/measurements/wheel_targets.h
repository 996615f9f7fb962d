#pragma once
/// The wheel targets that reach the motors.
///
///   target      JointCommand::velocity of a wheel whose mode is not brake, of the last command received in this run
///   passed      tick k−1 let a command pass (SensorFrame::gate); otherwise the target did not reach the motors
///   standstill  is commanded if the gate brakes, or if every wheel has mode brake or target 0

#include <array>
#include <cstddef>

#include "machine/wheeled/drive_train.h"
#include "safety/monitor_input.h"

namespace robot_control {

class WheelTargets {
 public:
  explicit WheelTargets(std::size_t wheels) noexcept : wheels_(wheels) {}

  void enter_run() noexcept { *this = WheelTargets(wheels_); }

  void step(const MonitorInput& input) noexcept;

  /// A target reaches the wheel.
  bool has(std::size_t wheel) const noexcept { return passed_ && has_[wheel]; }

  /// rad/s, in the joint's own sign; meaningful where `has`.
  double operator[](std::size_t wheel) const noexcept { return velocity_[wheel]; }

  bool commanded_to_stand() const noexcept { return !passed_ || !motion_; }
  bool passed() const noexcept { return passed_; }

 private:
  std::size_t wheels_;
  bool passed_ = false;
  bool motion_ = false;  ///< a target of the last command is not 0
  std::array<bool, kMaxWheels> has_{};
  std::array<double, kMaxWheels> velocity_{};
};

}  // namespace robot_control
