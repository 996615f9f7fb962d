#pragma once
/// The limits and gains with which a drive controller runs, as numbers: what the user left out is derived. Handed to it
/// between two cycles (~set_parameter_map), and in every row of its trace, so that a log shows which values were in
/// force when.

#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_control {

inline constexpr std::size_t kTunedWheels = 8;  ///< kMaxWheels of robot/, which this folder does not see

/// Of one axis, m/s or rad/s and its derivatives; the names of the parameters are max_linear_speed, …
struct AxisTuning {
  double speed = 0;
  double acceleration = 0;
  double deceleration = 0;
  double emergency_deceleration = 0;
  double jerk = 0;  ///< 0: no limit
  double reverse_speed = 0;
  double reverse_acceleration = 0;
  double reverse_deceleration = 0;
};

/// Of one wheel: the parameters of its loop, and those of feed-forward.
struct WheelTuning {
  double kp = 0;             ///< N·m·s/rad
  double ki = 0;             ///< N·m/rad
  double kd = 0;             ///< N·m·s²/rad
  double model_inertia = 0;  ///< kg·m², of the tracking loop (control/wheel_loops/wheel_loop.h)
  double inertia = 0;        ///< kg·m², about its axle
  double damping = 0;        ///< N·m·s/rad
  double friction = 0;       ///< N·m
};

struct DriveTuning {
  std::uint64_t count = 0;  ///< sets accepted since the process began; another count is another set
  AxisTuning linear;
  AxisTuning angular;
  std::uint64_t keep_curvature = 0;                ///< 1: kept
  double cmd_vel_timeout = 0;                      ///< s; 0: never
  double tracking_bandwidth = 0;                   ///< Hz
  double mass = 0;                                 ///< kg, of feed-forward
  double yaw_inertia = 0;                          ///< kg·m²
  std::array<WheelTuning, kTunedWheels> wheels{};  ///< in the order of RobotModel::wheels, which is that of the joints
};

}  // namespace robot_control
