// The estimator compares the sensors: the turn of wheels and gyro, and the motion of wheels and accelerometer.

#include <cmath>

#include "estimation/common/values.h"
#include "estimation/wheeled/estimator.h"

namespace robot_control {

/// Returns the step in the axes of the slip watch: those of odom without the corrections of the yaw, which would bend
/// the integrated path. `path` (m) is in base axes at the end of the step.
MotionDifference::Sample Estimator::slip_sample(double dt, double turned, const Planar& path) const noexcept {
  const State& s = state_;
  const double left = s.wheels.left();
  const double right = s.wheels.right();
  return {.dt = dt,
          .acceleration = s.tilt.acceleration(*s.imu.accelerometer),
          .up = s.tilt.up(),
          .turned = turned,
          .yaw = s.slip_yaw,
          .path = rotated(path, s.slip_yaw),
          .right_minus_left = (right - left + s.core.ratio() * (left + right) / 2) / (1 + s.core.base()),
          .distance = (std::abs(left) + std::abs(right)) / 2,
          .both_sides_read = s.wheels.both_received(),
          .yaw_rate = s.yaw_rate};
}

void Estimator::watch_slip(double dt, double turned, const Planar& path) noexcept {
  State& s = state_;
  const bool resolved = s.wheels.gap <= Tuning::kSlowWheels && !s.wheels.batch && !s.slip.difference().interrupted();
  if (!s.imu.gyro || !s.imu.accelerometer || s.wheels.any_lost() || !resolved) return restart_slip();
  s.slip_yaw += turned;
  if (!s.slip.step(slip_sample(dt, turned, path))) return;
  const bool slides = s.slide.active();
  if (slides)
    s.tilt.age();
  else
    s.slip.set_clock_offset(s.core.offset());
  s.slip.evaluate({.acceleration_variance = {s.tilt.acceleration_variance(0), s.tilt.acceleration_variance(1)},
                   .wheel_base = s.core.deviation(PlanarCore::kBase),
                   .clock_offset = std::hypot(s.core.deviation(PlanarCore::kOffset), s.wheels.gap / std::sqrt(12.0)),
                   .speed_step = s.wheels.speed_step},
                  !slides);
  smooth_nis(kAccelerometer, s.slip.nis(SlipResidual::kAlong), Tuning::kPointInterval);
  smooth_nis(kLateralContact, s.slip.nis(SlipResidual::kAcross), Tuning::kPointInterval);
  smooth_nis(kGyro, s.slip.nis(SlipResidual::kTurn), Tuning::kPointInterval);
  const bool proven = s.slip.shortest_proven_span() > 0;
  WheelSlide::Correction correction;
  if (slides) {
    correction = s.slide.step(s.slip, s.wheels.speed);
    if (!s.slide.active()) s.slip.restart_on_line(s.slide.rolling_slope(s.slip.difference()));
  } else if (proven && s.rest.bias_measured()) {
    if (s.slip.proven(SlipResidual::kAcross)) ++s.rejected[kLateralContact];
    correction = s.slide.begin(s.slip, s.wheels.speed);
  } else if (const SlipDetector::GravityError& gravity = s.slip.gravity_error(); gravity.known && !proven) {
    s.tilt.correct(gravity.along, gravity.across, gravity.interval, gravity.deviation);
  }
  const Planar shift = rotated(correction.shift, s.core.pose().yaw - s.slip_yaw);
  s.core.shift(shift.x, shift.y, correction.variance);
}

void Estimator::restart_slip() noexcept {
  state_.slide.end();
  state_.slip.restart();
}

void Estimator::compare_turns(double dt, bool by_gyro) noexcept {
  State& s = state_;
  s.comparison.add({.time = dt,
                    .left = s.wheels.left(),
                    .right = s.wheels.right(),
                    .slid = s.slide.active(),
                    .stuck = s.imu.gyro_unchanged > Tuning::kMaxHoldTime});
  if (!s.wheels.both_received() || !by_gyro || !s.comparison.at_border()) return;
  const double rate = s.rate.rate().z();
  if (s.comparison.open()) {
    PlanarCore::Block block = s.comparison.block();
    block.rate = rate;
    const auto [nis, used] = s.core.end_block(block);
    for (const SensorIndex sensor : {kLeftEncoder, kRightEncoder}) {
      smooth_nis(sensor, nis, block.time);
      if (!used) ++s.rejected[sensor];
    }
  }
  s.comparison.begin();
  s.core.begin_block(rate);
}

}  // namespace robot_control
