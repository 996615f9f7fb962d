#pragma once
/// How fast may the body still slide? Wheels that stand do not say that it stands: on ice it slides with its wheels
/// locked, and no sensor of the monitor's tells a steady slide from rest.
///
///   u_k = max(u_k−1 − a·dt, min(rim, u_k−1 + kGrip·dt, limit)),   rim = max |ωᵢ|·rᵢ, 0 while the wheels stand
///
/// A bound (m/s), never a measurement: what the rims ran at, lost no faster than a = stop_deceleration, which is
/// reached on any ground the robot drives on. kGrip: no tyre takes a body along faster, so a wheel that spins or an
/// encoder that lies for a moment does not count much; limit: that of wheel_speed.
///
/// Where the wheels' speeds are not known (wheel_motion.h), u stays what it is.

#include <array>
#include <cstddef>
#include <cstdint>

#include "robot/robot_model.h"
#include "safety/measurements/wheel_motion.h"
#include "safety/safety_parameters.h"

namespace robot_control {

class Slide {
 public:
  static constexpr double kGrip = 10.0;  ///< m/s², friction of 1

  /// `period` s.
  Slide(const SafetyParameters& parameters, const RobotModel& robot, double period) noexcept;

  /// A new run: the machine begins at rest.
  void enter_run() noexcept { speed_ = 0; }

  /// `standing`: the wheels, standstill.h. `elapsed` cycles since the last step.
  void step(const WheelMotion& motion, bool standing, std::uint64_t elapsed) noexcept;

  bool possible() const noexcept { return speed_ > 0; }
  double speed() const noexcept { return speed_; }  ///< m/s, u

 private:
  double fastest_rim(const WheelMotion& motion) const noexcept;

  double period_;
  double deceleration_;
  double limit_;  ///< m/s
  double speed_ = 0;
  std::array<double, kMaxWheels> radius_{};
};

}  // namespace robot_control
