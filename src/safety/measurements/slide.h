#pragma once
/// An upper bound on how fast the body may still slide. Standing wheels do not prove that the body stands: on ice it
/// slides with locked wheels. No sensor of the monitor distinguishes steady sliding from rest.
///
///   u_k = max(u_k−1 − a·dt, min(rim, u_k−1 + kGrip·dt, limit)),   rim = max |ωᵢ|·rᵢ, 0 while the wheels stand
///
/// u is a bound (m/s), not a measurement: the rim speed, reduced no faster than by a = stop_deceleration, which is
/// reached on every ground the robot drives on. A tyre cannot accelerate the body faster than kGrip: a spinning wheel
/// or a wrong encoder counts little if it is short. `limit` is that of wheel_speed.
///
/// While the wheel speeds are not known (wheel_motion.h), u keeps its value.

#include <array>
#include <cstdint>

#include "machine/wheeled/drive_train.h"
#include "safety/measurements/wheel_motion.h"
#include "safety/safety_parameters.h"

namespace robot_control {

class Slide {
 public:
  static constexpr double kGrip = 10.0;  ///< m/s², friction of 1

  /// `period` s.
  Slide(const SafetyParameters& parameters, const DriveTrain& robot, double period) noexcept;

  /// A new run: the machine begins at rest.
  void enter_run() noexcept { speed_ = 0; }

  /// `standing`: the wheels (joint_standstill.h). `elapsed` cycles since the last step.
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
