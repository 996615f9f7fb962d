#pragma once
/// Does the robot stand, by its wheels' angles alone (the monitor trusts no estimate)? A caster may still turn.
///
///   inside    every wheel within ±w of where it was when the window began;  w = max(v·T, 1.5 quanta), T =
///             kStandingTime, v standstill_speed; a wheel that stands already may use twice that, so that nothing
///             flickers
///   standing  inside for T; then the window begins anew, so that a creep slower than v never ends it
///   moving    a wheel left its window, or its angle is not known; until the robot stands again
///
/// One count of a wheel at rest at the edge of a count is no motion, and a wheel that swings beyond the window does not
/// stand, however slow it is on average. At first, and in the first T of a run, it is neither.

#include <array>
#include <cstddef>
#include <cstdint>

#include "robot/robot_model.h"
#include "safety/measurements/wheel_motion.h"

namespace robot_control {

class JointStandstill {
 public:
  static constexpr double kStandingTime = 0.1;  ///< s; the robot's own swinging is over by then

  /// `standstill_speed` rad/s, `period` s, both > 0.
  JointStandstill(double standstill_speed, double period) noexcept;

  /// A new run.
  void enter_run() noexcept;

  void step(const WheelMotion& motion, std::uint64_t cycle) noexcept;

  bool moving() const noexcept { return moving_; }
  bool standing() const noexcept { return standing_; }

 private:
  bool inside(const WheelMotion& motion) const noexcept;
  void begin_window(const WheelMotion& motion, std::uint64_t cycle) noexcept;

  double window_;         ///< rad, v·T
  std::uint64_t cycles_;  ///< T
  bool anchored_ = false;
  bool moving_ = false;
  bool standing_ = false;
  std::uint64_t since_ = 0;
  std::array<double, kMaxWheels> anchor_{};
};

}  // namespace robot_control
