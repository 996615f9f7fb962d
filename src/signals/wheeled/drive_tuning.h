#pragma once
/// A DriveTuning is the LiveTuning (signals/live_tuning.h) of a robot on wheels; values that the user left out are
/// derived.

#include <array>
#include <cstdint>

#include "signals/wheeled/wheel_count.h"

namespace robot_control {

/// The limits of one axis in m/s or rad/s and their derivatives; the parameters are named max_linear_speed, …
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

/// The parameters of one wheel: those of its loop, and those of its feed-forward.
struct WheelTuning {
  double kp = 0;             ///< N·m·s/rad
  double ki = 0;             ///< N·m/rad
  double kd = 0;             ///< N·m·s²/rad
  double model_inertia = 0;  ///< kg·m², in the tracking loop (control/wheeled/wheel_loops/wheel_loop.h)
  double inertia = 0;        ///< kg·m², about its axle
  double damping = 0;        ///< N·m·s/rad
  double friction = 0;       ///< N·m
};

struct DriveTuning {
  std::uint64_t count = 0;  ///< number of sets accepted since the process began; each set has another count
  AxisTuning linear;
  AxisTuning angular;
  std::uint64_t keep_curvature = 0;              ///< 1: the curvature is kept
  double cmd_vel_timeout = 0;                    ///< s; 0: never
  double tracking_bandwidth = 0;                 ///< Hz
  double mass = 0;                               ///< kg, for feed-forward
  double yaw_inertia = 0;                        ///< kg·m²
  std::array<WheelTuning, kMaxWheels> wheels{};  ///< in the order of DriveTrain::wheels, which is that of the joints
};

}  // namespace robot_control
