#pragma once
/// These are the user's parameters of the drive controller.

#include <optional>

#include "parameters/block.h"

namespace robot_control {

/// Only the controller uses these measured values of the robot in place of the URDF's (measured_robot.h).
struct FeedForwardParameters {
  std::optional<double> mass;            ///< kg
  std::optional<double> yaw_inertia;     ///< kg·m² about the vertical through the middle of the wheels
  std::optional<double> wheel_inertia;   ///< kg·m² of every wheel about its axle, its drive included
  std::optional<double> wheel_damping;   ///< N·m·s/rad, of every wheel's joint
  std::optional<double> wheel_friction;  ///< N·m, dry friction
};

/// Gains that are left out are derived from the robot, wheel by wheel (wheel_loop_gains.h).
struct DriveControllerParameters {
  double max_linear_speed = 1.0;           ///< m/s
  double max_angular_speed = 2.0;          ///< rad/s
  double max_linear_acceleration = 1.0;    ///< m/s²
  double max_angular_acceleration = 4.0;   ///< rad/s²
  std::optional<double> min_linear_speed;  ///< m/s ≤ 0, fastest in reverse; absent: −max_linear_speed
  std::optional<double> max_linear_acceleration_reverse;     ///< m/s²; absent: as forwards
  std::optional<double> max_linear_deceleration_reverse;     ///< m/s²; absent: as forwards
  std::optional<double> max_linear_deceleration;             ///< m/s²; absent: as the acceleration
  std::optional<double> max_angular_deceleration;            ///< rad/s²
  std::optional<double> max_linear_emergency_deceleration;   ///< m/s², ≥ the deceleration; absent: drive_limits.h
  std::optional<double> max_angular_emergency_deceleration;  ///< rad/s²
  std::optional<double> max_linear_jerk;                     ///< m/s³; 0: no limit; absent: drive_limits.h
  std::optional<double> max_angular_jerk;                    ///< rad/s³; 0: no limit
  bool keep_curvature = true;                                ///< Both axes reach a new command in the same step.
  double cmd_vel_timeout = 1.25;                             ///< s; 0 = never
  bool one_sender = false;                   ///< While several send and one requests motion, none is taken.
  std::optional<double> pid_kp;              ///< N·m·s/rad
  std::optional<double> pid_ki;              ///< N·m/rad
  double pid_kd = 0.0;                       ///< N·m·s²/rad
  std::optional<double> tracking_bandwidth;  ///< Hz, of the tracking loops of the wheel speeds
  FeedForwardParameters feed_forward;
};

inline Keys keys(DriveControllerParameters& drive) {
  constexpr unsigned kDerived = kOptional | kLive;
  return {
      {"max_linear_speed", &drive.max_linear_speed, "m/s", 0.001, 50, kLive},
      {"max_angular_speed", &drive.max_angular_speed, "rad/s", 0.001, 50, kLive},
      {"max_linear_acceleration", &drive.max_linear_acceleration, "m/s²", 0.001, 100, kLive},
      {"max_angular_acceleration", &drive.max_angular_acceleration, "rad/s²", 0.001, 1000, kLive},
      {"max_linear_deceleration", &drive.max_linear_deceleration, "m/s²", 0.001, 100, kDerived},
      {"max_angular_deceleration", &drive.max_angular_deceleration, "rad/s²", 0.001, 1000, kDerived},
      {"min_linear_speed", &drive.min_linear_speed, "m/s", -50, 0, kDerived},
      {"max_linear_acceleration_reverse", &drive.max_linear_acceleration_reverse, "m/s²", 0.001, 100, kDerived},
      {"max_linear_deceleration_reverse", &drive.max_linear_deceleration_reverse, "m/s²", 0.001, 100, kDerived},
      {"max_linear_emergency_deceleration", &drive.max_linear_emergency_deceleration, "m/s²", 0.001, 100, kDerived},
      {"max_angular_emergency_deceleration", &drive.max_angular_emergency_deceleration, "rad/s²", 0.001, 1000,
       kDerived},
      {"max_linear_jerk", &drive.max_linear_jerk, "m/s³", 0.001, 1.0e6, kZeroIsOff | kDerived},
      {"max_angular_jerk", &drive.max_angular_jerk, "rad/s³", 0.001, 1.0e6, kZeroIsOff | kDerived},
      {"keep_curvature", &drive.keep_curvature, {}, 0, 0, kLive},
      {"cmd_vel_timeout", &drive.cmd_vel_timeout, "s", 0, 60, kLoopTimeout | kZeroIsOff | kLive},
      {"one_sender", &drive.one_sender},
      {"pid_kp", &drive.pid_kp, "N·m·s/rad", 0, 10000, kDerived},
      {"pid_ki", &drive.pid_ki, "N·m/rad", 0, 1.0e6, kDerived},
      {"pid_kd", &drive.pid_kd, "N·m·s²/rad", 0, 1000, kLive},
      {"tracking_bandwidth", &drive.tracking_bandwidth, "Hz", 0.1, 500, kDerived},
      {"mass", &drive.feed_forward.mass, "kg", 0.01, 100000, kDerived, {}, "feed_forward"},
      {"yaw_inertia", &drive.feed_forward.yaw_inertia, "kg·m²", 1.0e-6, 1.0e6, kDerived, {}, "feed_forward"},
      {"wheel_inertia", &drive.feed_forward.wheel_inertia, "kg·m²", 1.0e-9, 1000, kDerived, {}, "feed_forward"},
      {"wheel_damping", &drive.feed_forward.wheel_damping, "N·m·s/rad", 0, 1000, kDerived, {}, "feed_forward"},
      {"wheel_friction", &drive.feed_forward.wheel_friction, "N·m", 0, 10000, kDerived, {}, "feed_forward"},
  };
}

/// Checks emergency decelerations against the usual ones, and jerk limits against both. `block` is the name of the
/// block that has these keys.
void check(const DriveControllerParameters& parameters, const std::string& block, GivenValues& given);

}  // namespace robot_control
