#include "estimation/wheeled/slip/slip_residual.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

SlipResidual slip_residual(const MotionDifference& difference, double span) noexcept {
  const MotionDifference::Point end = difference.last();
  const MotionDifference::Point middle = difference.before(end.time - 0.9 * span);
  const double late = end.time - middle.time;
  const MotionDifference::Point first = difference.before(middle.time - 0.9 * late);
  const double early = middle.time - first.time;
  SlipResidual residual;
  residual.known = late > 0.8 * span && late < 1.6 * span && early > 0.8 * late && early < 1.6 * late;
  if (!residual.known) return residual;
  residual.span = late;
  residual.distance = end.distance - first.distance;
  residual.turned = end.yaw - first.yaw;
  residual.yaw_rate_change = end.yaw_rate - middle.yaw_rate;
  const Planar bend =
      end.path_difference - middle.path_difference - (middle.path_difference - first.path_difference) * late / early;
  const Planar inertial_change = end.velocity - first.velocity;
  const Planar wheel_change = inertial_change + bend * 2 / late;
  residual.speed_change = std::min({residual.distance / late, inertial_change.norm(), wheel_change.norm()});
  const Planar in_base = rotated(bend, -middle.yaw);
  residual.value = {in_base.x, in_base.y, end.turn_difference - middle.turn_difference};
  return residual;
}

double residual_deviation(SlipResidual::Channel channel, const SlipResidual& residual,
                          const SlipUncertainty& uncertainty, const SlipParams& params) noexcept {
  const double span = residual.span;
  if (channel == SlipResidual::kTurn) {
    const double base = params.wheel_base;
    return std::sqrt(4 * square(params.encoder) + 2 * square(params.wheel_slip_noise) * residual.distance +
                     square(base * uncertainty.wheel_base * residual.turned) +
                     square(base * Tuning::kWindUp) * std::abs(residual.yaw_rate_change) +
                     square(uncertainty.speed_step * span) / 6);
  }
  const double slow = square(Tuning::kSlowAcceleration) + uncertainty.acceleration_variance[channel];
  return std::sqrt(6 * square(params.encoder) + square(params.accelerometer) * span * span * span * 2 / 3 +
                   slow * square(span * span) + 2 * square(Tuning::kPathSlip) * residual.distance +
                   square(uncertainty.speed_step * span) / 12);
}

}  // namespace robot_control
