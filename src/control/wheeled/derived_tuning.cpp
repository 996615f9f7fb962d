#include "control/wheeled/derived_tuning.h"

#include <cmath>

#include "control/wheeled/limits/drive_limits.h"
#include "control/wheeled/measured_robot.h"
#include "control/wheeled/wheel_loops/wheel_loop_gains.h"

namespace robot_control {
namespace {

AxisTuning axis_tuning(const MotionLimits& limits) noexcept {
  return {.speed = limits.speed,
          .acceleration = limits.acceleration,
          .deceleration = limits.deceleration,
          .emergency_deceleration = limits.emergency_deceleration,
          .jerk = std::isinf(limits.jerk) ? 0 : limits.jerk,
          .reverse_speed = limits.speed_towards(-1),
          .reverse_acceleration = limits.acceleration_towards(-1),
          .reverse_deceleration = limits.deceleration_from(-1)};
}

MotionLimits motion_limits(const AxisTuning& tuning) noexcept {
  return {.speed = tuning.speed,
          .acceleration = tuning.acceleration,
          .deceleration = tuning.deceleration,
          .emergency_deceleration = tuning.emergency_deceleration,
          .jerk = jerk_limit(tuning.jerk),
          .reverse_speed = tuning.reverse_speed,
          .reverse_acceleration = tuning.reverse_acceleration,
          .reverse_deceleration = tuning.reverse_deceleration};
}

}  // namespace

DriveTuning drive_tuning(const DriveControllerParameters& parameters, const DriveTrain& robot, double period) {
  const DriveTrain measured = measured_robot(robot, parameters.feed_forward);
  const SpeedLimits limits = speed_limits(parameters);
  DriveTuning tuning{.linear = axis_tuning(limits.linear),
                     .angular = axis_tuning(limits.angular),
                     .keep_curvature = limits.keep_curvature ? 1u : 0u,
                     .cmd_vel_timeout = parameters.cmd_vel_timeout,
                     .tracking_bandwidth = tracking_bandwidth(parameters, period),
                     .mass = measured.mass,
                     .yaw_inertia = measured.yaw_inertia};
  for (std::size_t i = 0; i < measured.wheels.size(); ++i) {
    const WheelModel& wheel = measured.wheels[i];
    const JointModel& joint = measured.joints[wheel.joint];
    const WheelLoopGains gains = wheel_loop_gains(parameters, measured, wheel, period);
    tuning.wheels[i] = {.kp = gains.kp,
                        .ki = gains.ki,
                        .kd = gains.kd,
                        .model_inertia = gains.model_inertia,
                        .inertia = wheel.inertia,
                        .damping = joint.damping,
                        .friction = joint.friction};
  }
  return tuning;
}

SpeedLimits speed_limits(const DriveTuning& tuning) noexcept {
  return {.linear = motion_limits(tuning.linear),
          .angular = motion_limits(tuning.angular),
          .keep_curvature = tuning.keep_curvature != 0};
}

WheelLoopGains wheel_loop_gains(const WheelTuning& tuning) noexcept {
  return {.kp = tuning.kp, .ki = tuning.ki, .kd = tuning.kd, .model_inertia = tuning.model_inertia};
}

}  // namespace robot_control
