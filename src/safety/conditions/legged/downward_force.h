#pragma once
/// The accelerometer of a robot on legs is compared with what the ground can do.
///
///   imu reversed  −f > limit, on its feet. f is the low pass over kTime of the specific force along the body's z axis,
///                 within ±kLargest
///
/// The ground pushes the feet and never pulls them, so that f is up, and 0 in free fall. An IMU whose axes turn round
/// shows it downwards. The attitude (attitude.h) and the estimator would believe it. One sample is at most a quarter of
/// f, so that none brings the f of a robot that stands to the default limit. A missing sample changes nothing. Without
/// a command the driver folds the legs, which pulls the body down: f begins with 0 after it.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "machine/gravity.h"
#include "safety/conditions/common/condition_watch.h"
#include "safety/latch/active_causes.h"
#include "safety/safety_parameters.h"
#include "signals/legged/legged_command.h"

namespace robot_control {

class DownwardForce {
 public:
  static constexpr double kTime = 0.02;             ///< s, a tenth of the stance of a trot
  static constexpr double kLargest = 2 * kGravity;  ///< m/s²

  /// `period` s.
  DownwardForce(const SafetyParameters& parameters, double period) noexcept
      : period_(period), watch_(kCauseImuReversed, parameters.imu_reversed, period) {}

  void enter_run() noexcept {
    watch_.reset();
    force_ = 0;
  }

  /// `along_z`: m/s², NaN without a sample.
  void step(double along_z, LegPhase phase, std::uint64_t elapsed, ActiveCauses& out) noexcept {
    const bool on_feet = phase == LegPhase::kRising || phase == LegPhase::kStanding || phase == LegPhase::kWalking;
    const double weight = std::min(0.25, static_cast<double>(elapsed) * period_ / kTime);
    if (!on_feet) force_ = 0;
    if (on_feet && std::isfinite(along_z)) force_ += weight * (std::clamp(along_z, -kLargest, kLargest) - force_);
    out.update(watch_, on_feet ? beyond(kMaxJoints, -force_, watch_.limit()) : kNothingMeasured, elapsed);
  }

 private:
  double period_;
  ConditionWatch watch_;
  double force_ = 0;  ///< m/s², f
};

}  // namespace robot_control
