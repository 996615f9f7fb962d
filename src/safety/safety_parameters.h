#pragma once
/// The user's parameters of the safety monitor.
///
/// A condition is active when a quantity measured from raw sensors and the command is beyond `limit` without
/// interruption for `persistence`. An active condition is a cause, and `reaction` says what the monitor does. The
/// quantities are defined in wheel_limits.h, wheel_following.h, yaw_agreement.h, torque_oscillation.h,
/// body_conditions.h, sensor_presence.h and machine_conditions.h.

#include <array>
#include <cstdint>
#include <optional>

#include "robot/robot_model.h"

namespace robot_control {

/// From mild to severe; the severest reaction of all active conditions wins.
enum class Reaction : std::uint8_t {
  kOff,    ///< the condition is not evaluated
  kWarn,   ///< reported
  kSlow,   ///< reported; rim speeds limited to slow_speed while the condition is active and for kWarningHold after it
  kRamp,   ///< latched, stop category 1 of IEC 60204-1: ramp under supervision, then brake
  kBrake,  ///< latched, stop category 0: brake at once
};

struct Condition {
  std::optional<double>
      limit;               ///< absent: derived from the robot where it can be (derived_limits.h), else no condition
  double persistence = 0;  ///< s; 0: the first cycle counts
  Reaction reaction = Reaction::kBrake;
};

struct SafetyParameters {
  std::uint64_t loss_cycles = 20;  ///< cycles without a command or a state after which the stop latches
  double heartbeat_timeout = 0;    ///< s; 0 = no operator heartbeat is required
  double ramp_time = 2.0;          ///< s, longest category-1 ramp before the brake
  double standstill_speed = 0.05;  ///< rad/s, wheels slower than this are standing

  double slow_speed = 0.3;         ///< m/s, of the rims, under Reaction::kSlow
  double clearance = 0;            ///< m, free distance ahead until the first message on the topic; 0: unlimited
  double stop_delay = 0.03;        ///< s, from the event to the brake torque
  double stop_deceleration = 0.5;  ///< m/s², which braking and ramping reach on every ground the robot drives on

  Condition wheel_speed{{}, 0.15, Reaction::kBrake};         ///< rad/s; derived
  Condition wheel_acceleration{{}, 0.01, Reaction::kBrake};  ///< rad/s²; derived
  Condition wheel_effort{1.05, 0.02, Reaction::kBrake};      ///< of the joint's effort limit
  Condition power{{}, 0.1, Reaction::kBrake};                ///< W, mechanical, all wheels; derived
  Condition torque_oscillation{0.3, 1.0, Reaction::kBrake};  ///< of the joint's effort limit, RMS; warns before
  Condition stall{{}, 0, Reaction::kBrake};                  ///< rad that a standing wheel should have turned; derived
  Condition runaway{{}, 0.15, Reaction::kBrake};             ///< rad/s beyond the target; derived
  Condition wrong_direction{4.5, 0.05, Reaction::kBrake};    ///< rad/s against the target
  Condition not_stopping{{}, 0, Reaction::kBrake};           ///< s of motion after the target became zero; derived
  Condition yaw_rate{1.0, 0.2, Reaction::kSlow};             ///< rad/s between gyro and wheels
  Condition tilt{0.42, 0.05, Reaction::kBrake};              ///< rad from the vertical
  Condition tip_over{1.5, 0.02, Reaction::kBrake};           ///< rad/s, outwards, when tilted by half the tilt limit
  Condition free_fall{1.5, 0.15, Reaction::kBrake};          ///< m/s², specific force below it
  Condition lift{0.2, 0.8, Reaction::kBrake};                ///< of the weight on the wheels; contact sensors only
  Condition impact{80, 0, Reaction::kBrake};                 ///< m/s² along the ground, mean over 10 ms
  Condition encoders_lost{0, 0.01, Reaction::kBrake};        ///< limit unused
  Condition imu_lost{0, 0.1, Reaction::kSlow};               ///< limit unused
  Condition imu_stuck{0, 0.25, Reaction::kSlow};             ///< limit unused
  Condition overruns{50, 1.0, Reaction::kWarn};              ///< per second
  Condition battery_low{{}, 1.0, Reaction::kSlow};           ///< V
  Condition battery_empty{{}, 1.0, Reaction::kRamp};         ///< V

  /// N·m/rad, of each wheel: RMS of the torque that the derived gains produce from encoder quantisation, divided by the
  /// size of a count. Not a user parameter: it follows from robot and rate (runtime/safety_limits.h).
  std::array<double, kMaxWheels> count_ripple{};
};

}  // namespace robot_control
