#include "robots/wheeled/safety_limits.h"

#include <algorithm>
#include <numbers>

#include "control/wheeled/wheel_loops/wheel_loop_gains.h"
#include "drivers/table/drive_table.h"
#include "safety/derived_limits.h"

namespace robot_control {

double commanded_wheel_speed(const DriveControllerParameters& controller, const DriveTrain& robot) {
  const double rim = controller.max_linear_speed + controller.max_angular_speed * robot.effective_wheel_base() / 2;
  double fastest = 0;
  for (const WheelModel& wheel : robot.wheels) fastest = std::max(fastest, rim / wheel.radius);
  for (const WheelModel& wheel : robot.wheels) {
    const double limit = robot.joints[wheel.joint].velocity_limit;
    if (limit > 0) fastest = std::min(fastest, limit);
  }
  return fastest;
}

double count_ripple(const DriveTrain& robot, const WheelModel& wheel, double period) {
  constexpr double kRipple = 0.5;
  const DriveControllerParameters derived;
  const double kp = wheel_loop_gains(derived, robot, wheel, period).kp;
  return kRipple * kp * 2 * std::numbers::pi * tracking_bandwidth(derived, period);
}

SafetyParameters safety_limits(const Parameters& parameters, const DriveTrain& robot) {
  const double period = parameters.loop.period();
  SafetyParameters limits =
      derived_limits(parameters.safety, robot, commanded_wheel_speed(parameters.controller, robot), period);
  if (robot.wheel_command == WheelCommand::kVelocity) limits.joint_numbers = kValidKinematics;
  for (const WheelModel& wheel : robot.wheels) limits.count_ripple[wheel.joint] = count_ripple(robot, wheel, period);
  double& silence = limits.encoders_lost.persistence;
  silence = std::max(silence, tolerated_silence(parameters, false));
  return limits;
}

}  // namespace robot_control
