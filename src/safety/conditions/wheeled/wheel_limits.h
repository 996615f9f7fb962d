#pragma once
/// Limits of each wheel that do not depend on the command.
///
///   wheel_speed         |ω| > limit + tolerance. While a speed limit L (m/s) has been in force for longer than
///                       ramp_time, also |ω| > (kSlack·L + kSlackSpeed)/radius + tolerance: the controller does not
///                       slow down
///   wheel_acceleration  |ω̇| > limit + tolerance
///   wheel_effort        |τ|/(the joint's effort limit) > limit, in ticks in which the gate let a command pass: the
///                       driver's own brake may be stronger than the motor
///   power               Σ max(0, τ ω) > limit + Σ |τ|·tolerance: the power that the motors draw; braking draws none
///
/// Without a measured torque wheel_effort and power are not evaluated.
///
/// ω, ω̇ and their tolerances: wheel_motion.h. The measurement is that of the worst wheel.

#include <array>
#include <cstdint>

#include "machine/wheeled/drive_train.h"
#include "safety/latch/active_causes.h"
#include "safety/measurements/wheel_motion.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// The largest speed limit of the last ramp_time to 2·ramp_time: every limit below it has been in force for long
/// enough.
class SpeedLimitInForce {
 public:
  SpeedLimitInForce(double ramp_time, double period) noexcept;
  void enter_run() noexcept;
  /// m/s
  double step(double speed_limit, std::uint64_t elapsed) noexcept;

 private:
  std::uint64_t cycles_;
  std::uint64_t since_ = 0;
  double last_ = kNoSpeedLimit;  ///< the largest of the last full ramp_time
  double now_ = kNoSpeedLimit;   ///< the largest since then
};

class WheelLimits {
 public:
  static constexpr double kSlack = 1.2;        ///< overshoot of a wheel that follows
  static constexpr double kSlackSpeed = 0.05;  ///< m/s

  /// `period` s.
  WheelLimits(const SafetyParameters& parameters, const DriveTrain& robot, double period) noexcept;

  void enter_run() noexcept;

  /// `passed`: tick k−1 let a command pass. `speed_limit` m/s: of the last permit.
  void step(const SensorFrame& sensors, const WheelMotion& motion, bool passed, double speed_limit,
            std::uint64_t elapsed, ActiveCauses& out) noexcept;

 private:
  ConditionMeasurement fastest(const WheelMotion& motion, double speed_limit) const noexcept;
  ConditionMeasurement most_jerked(const WheelMotion& motion) const noexcept;
  ConditionMeasurement strongest(const SensorFrame& sensors) const noexcept;
  ConditionMeasurement drawn(const SensorFrame& sensors, const WheelMotion& motion) const noexcept;

  ConditionWatch speed_;
  ConditionWatch acceleration_;
  ConditionWatch effort_;
  ConditionWatch power_;
  SpeedLimitInForce in_force_;
  std::array<double, kMaxWheels> radius_{};
  std::array<double, kMaxWheels> effort_limit_{};
};

}  // namespace robot_control
