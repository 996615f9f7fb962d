#pragma once
/// These are the user's parameters of the drive controller.

#include <optional>

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
  bool one_sender = false;                                   ///< No command is accepted while more than one node sends.
  std::optional<double> pid_kp;                              ///< N·m·s/rad
  std::optional<double> pid_ki;                              ///< N·m/rad
  double pid_kd = 0.0;                                       ///< N·m·s²/rad
  std::optional<double> tracking_bandwidth;                  ///< Hz, of the tracking loops of the wheel speeds
  FeedForwardParameters feed_forward;
};

}  // namespace robot_control
