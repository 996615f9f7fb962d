#pragma once
/// The accelerometer of a robot on legs is compared with what the ground can do.
///
///   imu reversed  −f_z > limit, on its feet or on the way to them; f: low pass of the specific force over kTime
///
/// The ground pushes the feet and never pulls them, so that f points up the body, and is 0 in free fall. A sign or a
/// mounting that is wrong shows it downwards. The attitude (attitude.h) and the estimator would believe it.

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "safety/conditions/common/condition_watch.h"
#include "safety/latch/active_causes.h"
#include "safety/safety_parameters.h"
#include "signals/legged/legged_command.h"

namespace robot_control {

class DownwardForce {
 public:
  static constexpr double kTime = 0.02;  ///< s

  /// `period` s.
  DownwardForce(const SafetyParameters& parameters, double period) noexcept
      : period_(period), watch_(kCauseImuReversed, parameters.imu_reversed, period) {}

  void enter_run() noexcept {
    watch_.reset();
    force_ = 0;
  }

  /// `force`: m/s², specific, base axes.
  void step(const Eigen::Vector3d& force, LegPhase phase, std::uint64_t elapsed, ActiveCauses& out) noexcept {
    force_ += std::min(1.0, static_cast<double>(elapsed) * period_ / kTime) * (force.z() - force_);
    const bool on_feet = phase != LegPhase::kLying && phase != LegPhase::kLowering && phase != LegPhase::kJoints;
    watch_.step({.beyond = on_feet && -force_ > watch_.limit(), .value = -force_, .limit = watch_.limit()}, elapsed);
    out.add(watch_);
  }

 private:
  double period_;
  ConditionWatch watch_;
  double force_ = 0;  ///< m/s², f_z
};

}  // namespace robot_control
