// The estimator compares the sensors: the turn of wheels and gyro, and the motion of wheels and accelerometer.

#include <cmath>
#include <optional>

#include "estimation/estimator.h"
#include "estimation/values.h"

namespace robot_control {

SlipWatch::Input Estimator::slip_input(double dt, double turned, const Planar& path) const noexcept {
  const State& s = state_;
  const double left = s.wheels.left();
  const double right = s.wheels.right();
  return {
      .motion = {.dt = dt,
                 .acceleration = s.tilt.acceleration(*s.imu.accelerometer),
                 .up = s.tilt.up(),
                 .turned = turned,
                 .path = path,
                 .right_minus_left = (right - left + s.core.ratio() * (left + right) / 2) / (1 + s.core.base()),
                 .distance = (std::abs(left) + std::abs(right)) / 2,
                 .both_sides_read = s.wheels.both_received(),
                 .yaw_rate = s.yaw_rate},
      .side_speed = s.wheels.speed,
      .clock_offset = s.core.offset(),
      .uncertainty = {.acceleration_variance = {s.tilt.acceleration_variance(0), s.tilt.acceleration_variance(1)},
                      .wheel_base = s.core.deviation(PlanarCore::kBase),
                      .clock_offset = std::hypot(s.core.deviation(PlanarCore::kOffset), s.wheels.gap / std::sqrt(12.0)),
                      .gyro_bias = std::sqrt(s.core.bias_variance()),
                      .speed_step = s.wheels.speed_step},
      .corrects = s.rest.bias_measured()};
}

void Estimator::watch_slip(double dt, double turned, const Planar& path) noexcept {
  State& s = state_;
  const bool resolved = s.wheels.gap <= Tuning::kSlowWheels && !s.wheels.batch;
  if (!s.imu.gyro || !s.imu.accelerometer || s.wheels.any_lost() || !resolved) return s.slip.restart();
  const SlipWatch::Output slip = s.slip.step(slip_input(dt, turned, path));
  if (!slip.judged) return;
  smooth_nis(kAccelerometer, slip.nis[SlipResidual::kAlong], Tuning::kPointInterval);
  smooth_nis(kLateralContact, slip.nis[SlipResidual::kAcross], Tuning::kPointInterval);
  smooth_nis(kGyro, slip.nis[SlipResidual::kTurn], Tuning::kPointInterval);
  if (slip.sideways_began) ++s.rejected[kLateralContact];
  const Planar shift = rotated(slip.correction.shift, s.core.pose().yaw);
  s.core.shift(shift.x, shift.y, slip.correction.variance);
  if (slip.gravity.known) {
    s.tilt.correct(slip.gravity.along, slip.gravity.across, slip.gravity.interval, slip.gravity.deviation);
  }
}

void Estimator::compare_turns(double dt, bool by_gyro) noexcept {
  State& s = state_;
  const double rate = s.rate.rate().z();
  const auto [begins, ended] = s.comparison.step({.dt = dt,
                                                  .left = s.wheels.left(),
                                                  .right = s.wheels.right(),
                                                  .border = s.wheels.both_received() && by_gyro,
                                                  .slide = s.slip.slide().active(),
                                                  .gyro_unchanged = s.imu.gyro_unchanged});
  if (ended) {
    const auto [nis, used] = s.core.end_block({.time = ended->time,
                                               .left = ended->left,
                                               .right = ended->right,
                                               .rate = rate,
                                               .slid = ended->slid,
                                               .stuck = ended->stuck});
    for (const SensorIndex sensor : {kLeftEncoder, kRightEncoder}) {
      smooth_nis(sensor, nis, ended->time);
      if (!used) ++s.rejected[sensor];
    }
  }
  if (begins) s.core.begin_block(rate);
}

}  // namespace robot_control
