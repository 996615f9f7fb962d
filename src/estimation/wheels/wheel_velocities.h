#pragma once
/// How fast each wheel turns, for joint_states: a tracking loop (speed_tracker.h) on every wheel's own angle.
///
/// The speed that an encoder reports is differenced over one period and jumps by a count per period: 1.5 rad/s with
/// 4096 counts at 1 kHz. Samples that are missing, not finite or that jump by more than kFastest are left out; after
/// kForgotten without one, the next restarts.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "estimation/wheels/speed_tracker.h"
#include "robot/robot_model.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

class WheelVelocities {
 public:
  static constexpr double kFastest = 1000;   ///< rad/s, 10⁴ rpm
  static constexpr double kForgotten = 0.1;  ///< s

  /// `bandwidth` Hz, `period` s.
  WheelVelocities(const RobotModel& robot, double bandwidth, double period)
      : wheels_(std::min(robot.wheels.size(), kMaxWheels), Wheel{.speed = SpeedTracker(bandwidth, period)}) {}

  void reset() noexcept {
    for (Wheel& wheel : wheels_) wheel.known = false;
  }

  /// `dt` s after the last one; 0: the first, or the same again.
  void step(const SensorFrame& sensors, double dt) noexcept {
    const bool valid = (sensors.valid & kValidJoints) != 0 && sensors.joint_count >= wheels_.size();
    for (std::size_t i = 0; i < wheels_.size(); ++i) wheels_[i].step(sensors.joints[i], valid, dt);
  }

  /// rad/s, in the joint's own sign; those of wheels without a sample are 0.
  void write(std::array<double, kMaxWheelVelocities>& out) const noexcept {
    out = {};
    for (std::size_t i = 0; i < wheels_.size(); ++i) out[i] = wheels_[i].known ? wheels_[i].speed.speed() : 0;
  }

 private:
  struct Wheel {
    SpeedTracker speed;
    double angle = 0;  ///< rad, of the last good sample
    double since = 0;  ///< s
    bool known = false;

    void step(const JointSample& sample, bool valid, double dt) noexcept {
      since += dt;
      if (!valid || !std::isfinite(sample.position)) return;
      const double travel = sample.position - angle;
      if (!known || since > kForgotten) {
        speed.reset(0);
        known = true;
      } else if (since > 0 && std::abs(travel) <= kFastest * since) {
        speed.step(travel, since);
      } else {
        return;
      }
      angle = sample.position;
      since = 0;
    }
  };

  std::vector<Wheel> wheels_;
};

static_assert(kMaxWheelVelocities == kMaxWheels);

}  // namespace robot_control
