#pragma once
/// Estimates how fast each wheel turns, for joint_states. It runs the tracking loop of the wheel loops
/// (machine/encoders/tracking_loop.h) on each wheel's own angle, without a torque that explains its acceleration.
///
/// The speed that an encoder reports is a difference over one period, which jumps by a count per period: 1.5 rad/s with
/// 4096 counts at 1 kHz. Samples that are missing, not finite, used before or too far (kFastestWheel) are left out.
/// After kMaxHoldTime without a sample, the next one restarts the loop.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "estimation/tuning.h"
#include "machine/encoders/sample_time.h"
#include "machine/encoders/tracking_loop.h"
#include "machine/wheeled/drive_train.h"
#include "signals/fixed_vector.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class WheelVelocities {
 public:
  /// `bandwidth` is in Hz and `period` in s.
  WheelVelocities(const DriveTrain& robot, double bandwidth, double period)
      : period_(period),
        wheels_(std::min(robot.wheels.size(), kMaxWheels), Wheel{.tracking = TrackingLoop(bandwidth, period)}) {}

  /// `dt` is the time in s since the last call; 0 in the first one and for a repeated frame.
  void step(const SensorFrame& sensors, double dt) noexcept {
    for (std::size_t i = 0; i < wheels_.size(); ++i) wheels_[i].step(sensors, i, dt, period_);
    for (std::size_t i = 0; i < wheels_.size(); ++i)
      wheels_[i].tracking.assume_encoder_of(wheels_[(i + 1) % wheels_.size()].tracking);
  }

  /// Writes rad/s of the wheels in the joint's own sign; wheels without a sample get 0.
  void write(std::array<double, kMaxJoints>& out) const noexcept {
    for (std::size_t i = 0; i < wheels_.size(); ++i) out[i] = wheels_[i].known ? wheels_[i].tracking.velocity() : 0;
  }

 private:
  struct Wheel {
    TrackingLoop tracking;
    double angle = 0;    ///< rad, last good sample
    SampleTime taken{};  ///< of that sample
    double since = 0;    ///< s
    bool known = false;

    void step(const SensorFrame& sensors, std::size_t joint, double dt, double period) noexcept {
      const JointSample& sample = sensors.joints[joint];
      since += dt;
      if (joint >= sensors.joint_count || !has_position(sample) || !taken.precedes(sensors, sample)) return;
      const double travel = sample.position - angle;
      if (!known || since > Tuning::kMaxHoldTime) {
        tracking.restart_from(sample.position, 0);
        known = true;
      } else if (since > 0 && std::abs(travel) <= Tuning::kFastestWheel * since) {
        tracking.step(sample.position, 0, since / period);
      } else {
        return;
      }
      angle = sample.position;
      taken.accept(sensors, sample);
      since = 0;
    }
  };

  double period_;
  FixedVector<Wheel, kMaxWheels> wheels_;
};

}  // namespace robot_control
