#include "control/wheeled/wheel_loops/wheel_loop_gains.h"

#include <algorithm>
#include <numbers>

#include "control/wheeled/wheel_loops/feed_forward.h"

namespace robot_control {

WheelLoopGains wheel_loop_gains(const DriveControllerParameters& parameters, const DriveTrain& robot,
                                const WheelModel& wheel, double period) noexcept {
  constexpr double kStabilityNumber = 0.2;
  constexpr double kPace = 31;          // 1/s
  constexpr double kIntegralPace = 10;  // 1/s
  const double straight = straight_inertia(robot, wheel);
  const double lifted = kModelInertiaFactor * wheel.inertia;
  const double damped = kModelInertiaFactor * robot.joints[wheel.joint].damping /
                        (2 * std::numbers::pi * tracking_bandwidth(parameters, period));
  WheelLoopGains gains;
  gains.model_inertia = std::max(lifted, damped);
  gains.kp = parameters.pid_kp.value_or(std::min(kStabilityNumber * lifted / period, kPace * straight));
  gains.ki = parameters.pid_ki.value_or(std::min(kIntegralPace * gains.kp, gains.kp * gains.kp / (3 * straight)));
  gains.kd = parameters.pid_kd;
  return gains;
}

double tracking_bandwidth(const DriveControllerParameters& parameters, double period) noexcept {
  constexpr double kBandwidth = 20;        // Hz
  constexpr double kPeriodsPerCycle = 25;  // 2π/25 = 0.25
  return parameters.tracking_bandwidth.value_or(std::min(kBandwidth, 1 / (kPeriodsPerCycle * period)));
}

}  // namespace robot_control
