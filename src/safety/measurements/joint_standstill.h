#pragma once
/// Whether the robot stands is judged by its wheel angles alone: the monitor does not trust the estimate. A caster may
/// still turn.
///
///   inside    every wheel within ±w of its angle at the beginning of the window;  w = max(v·T, 1.5 quanta), T =
///             kStandingTime, v standstill_speed; doubled while standing, as hysteresis
///   standing  inside for T; then the window restarts, so that creeping slower than v does not end standing
///   moving    a wheel left its window, or its angle is not known; until the robot stands again
///
/// A change of one count, of a wheel at rest at the edge of a count, is not motion. A wheel that oscillates beyond the
/// window does not stand, however slow it is on average. In the first T of a run the robot is neither standing nor
/// moving.

#include <array>
#include <cstdint>

#include "safety/measurements/wheel_motion.h"
#include "signals/wheeled/wheel_count.h"

namespace robot_control {

class JointStandstill {
 public:
  static constexpr double kStandingTime = 0.1;  ///< s; longer than the robot's own oscillation after a stop

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
