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

#include <algorithm>
#include <cmath>

#include "machine/gravity.h"
#include "safety/conditions/legged/legged_observer.h"

namespace robot_control {

class DownwardForce {
 public:
  static constexpr double kTime = 0.02;             ///< s, a tenth of the stance of a trot
  static constexpr double kLargest = 2 * kGravity;  ///< m/s²

  DownwardForce(const SafetyParameters&, const LegModel&, double) noexcept {}
  void enter_run() noexcept { force_ = 0; }

  ConditionMeasurement measure(const LeggedMeasurements& now, const ConditionWatch& watch) noexcept {
    const bool on_feet = now.phase == LegPhase::kRising || now.phase == LegPhase::kStanding || now.walks();
    if (!on_feet) force_ = 0;
    if (!on_feet) return kNothingMeasured;
    const double along_z = now.body.along_z(), weight = std::min(0.25, now.dt / kTime);
    if (std::isfinite(along_z)) force_ += weight * (std::clamp(along_z, -kLargest, kLargest) - force_);
    return beyond(kMaxJoints, -force_, watch.limit());
  }

 private:
  double force_ = 0;  ///< m/s², f
};

}  // namespace robot_control
