#include "robots/wheeled/slow_loop.h"

#include <algorithm>

#include "configuration/rate_notes.h"
#include "control/wheeled/wheel_loops/feed_forward.h"
#include "control/wheeled/wheel_loops/wheel_loop_gains.h"
#include "gate/wheeled/wheel_stop.h"
#include "robots/wheeled/safety_limits.h"
#include "signals/formatted_text.h"

namespace robot_control {

double correction_time(const Parameters& parameters, const DriveTrain& robot) {
  double slowest = 0;
  for (const WheelModel& wheel : robot.wheels) {
    const WheelLoopGains gains = wheel_loop_gains(parameters.controller, robot, wheel, parameters.loop.period());
    if (gains.ki > 0) slowest = std::max(slowest, gains.kp / gains.ki);
  }
  return slowest;
}

double brake_time(const DriveTrain& robot, double period) {
  const std::vector<Brake> brakes = brakes_of_slow_drives(robot, period);
  double slowest = 0;
  for (std::size_t i = 0; i < brakes.size(); ++i)
    slowest = std::max(slowest, straight_inertia(robot, robot.wheels[i]) / brakes[i].damping);
  return slowest;
}

std::vector<std::string> wheeled_rate_notes(const Parameters& parameters, const DriveTrain& robot, Role role) {
  const LoopParameters& loop = parameters.loop;
  if (!is_slow(loop)) return {};
  if (role == Role::kController) {
    return {formatted(
        "at robot.rate = %g Hz, the wheel loops correct friction, load, slopes and pushes that their plan does "
        "not contain with a time constant of %.2g s: describe mass and friction well (feed_forward), or raise "
        "robot.rate",
        loop.rate, correction_time(parameters, robot))};
  }
  if (role == Role::kMonitor) {
    const SafetyParameters limits = safety_limits(parameters, robot);
    return {formatted(
        "at robot.rate = %g Hz, a blocked wheel is recognised after %.2g rad, motion without a command after "
        "%.2g s and a wheel that runs away above %.2g rad/s: set the limits of stall, not_stopping and runaway, "
        "or raise robot.rate",
        loop.rate, *limits.stall.limit, *limits.not_stopping.limit, *limits.runaway.limit)};
  }
  const bool direct = parameters.driver == DriverName::kMujoco && parameters.drives.empty();
  if (role != Role::kDriver || direct) return {};
  const double time = brake_time(robot, loop.period());
  return {formatted(
      "at robot.rate = %g Hz, drives that take torques brake the robot with a time constant of %.2g s: at %.2g "
      "m/s it needs up to %.2g m. Lower the speed limits, or raise robot.rate",
      loop.rate, time, parameters.controller.max_linear_speed, parameters.controller.max_linear_speed * time)};
}

}  // namespace robot_control
