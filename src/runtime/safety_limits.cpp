#include "runtime/safety_limits.h"

#include <algorithm>

#include "safety/derived_limits.h"

namespace robot_control {

double commanded_wheel_speed(const DriveControllerParameters& controller, const RobotModel& robot) {
  const double rim = controller.max_linear_speed + controller.max_angular_speed * robot.effective_wheel_base() / 2;
  double fastest = 0;
  for (const WheelModel& wheel : robot.wheels) fastest = std::max(fastest, rim / wheel.radius);
  for (const WheelModel& wheel : robot.wheels) {
    const double limit = robot.joints[wheel.joint].velocity_limit;
    if (limit > 0) fastest = std::min(fastest, limit);
  }
  return fastest;
}

SafetyParameters safety_limits(const Parameters& parameters, const RobotModel& robot) {
  return derived_limits(parameters.safety, robot, commanded_wheel_speed(parameters.controller, robot),
                        parameters.loop.period());
}

}  // namespace robot_control
