// The estimator compares the sensors: the turn of wheels and gyro, and the motion of wheels and accelerometer.

#include <cmath>

#include "estimation/common/values.h"
#include "estimation/wheeled/estimator.h"

namespace robot_control {

void Estimator::watch_slip(double dt, double travel) noexcept {
  State& s = state_;
  const bool resolved = s.wheels.gap <= Tuning::kSlowWheels && !s.wheels.batch && !s.slip.interrupted();
  if (!s.imu.gyro || !s.imu.accelerometer || s.wheels.any_lost() || !resolved) return s.slip.restart();
  const bool added = s.slip.step({.dt = dt,
                                  .acceleration = s.tilt.acceleration(*s.imu.accelerometer),
                                  .up_x = s.tilt.up()[0],
                                  .yaw_rate = s.yaw_rate,
                                  .travel = travel,
                                  .speed = s.wheels.mean_speed(),
                                  .clock_offset = s.core.offset(),
                                  .both_sides_read = s.wheels.both_received()});
  if (!added) return;
  if (s.slip.slips()) s.tilt.age();
  const double offset = std::hypot(s.core.deviation(PlanarCore::kOffset), s.wheels.gap / std::sqrt(12.0));
  const double variance = s.slip.evaluate({.gravity_variance = s.tilt.acceleration_variance(0),
                                           .clock_offset = offset,
                                           .offset = s.core.offset(),
                                           .speed_step = s.wheels.speed_step},
                                          s.rest.bias_measured());
  smooth_nis(kAccelerometer, s.slip.nis(), Tuning::kPointInterval);
  s.core.shift(0, 0, variance);
  const SlipWatch::GravityError& gravity = s.slip.gravity_error();
  if (gravity.interval > 0) s.tilt.correct(gravity.along, gravity.across, gravity.interval, gravity.deviation);
}

void Estimator::compare_turns(double dt, bool by_gyro) noexcept {
  State& s = state_;
  s.comparison.add({.time = dt,
                    .left = s.wheels.left(),
                    .right = s.wheels.right(),
                    .slid = s.slip.slips(),
                    .stuck = s.imu.gyro_unchanged > Tuning::kMaxHoldTime});
  if (!s.wheels.both_received() || !by_gyro || !s.comparison.at_border()) return;
  const double rate = s.rate.rate().z();
  if (s.comparison.open()) {
    PlanarCore::Block block = s.comparison.block();
    block.rate = rate;
    const auto [nis, used] = s.core.end_block(block);
    for (const SensorIndex sensor : {kLeftEncoder, kRightEncoder, kGyro}) {
      smooth_nis(sensor, nis, block.time);
      if (!used && sensor != kGyro) ++s.rejected[sensor];
    }
  }
  s.comparison.begin();
  s.core.begin_block(rate);
}

}  // namespace robot_control
