#pragma once
/// The conditions of a robot on legs compare body, joints and feet with their limits, and the state with the gyro.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "machine/gravity.h"
#include "machine/stored.h"
#include "safety/conditions/common/body_conditions.h"
#include "safety/conditions/common/condition_set.h"
#include "safety/conditions/legged/encoder_conditions.h"
#include "safety/conditions/legged/joint_conditions.h"
#include "safety/conditions/legged/legged_observer.h"

namespace robot_control {

/// The accelerometer of a robot on legs is compared with what the ground can do.
///
///   imu reversed  −f > limit, on its feet. f is the low pass over kTime of the specific force along the body's z axis,
///                 within ±kLargest
///
/// The ground pushes the feet and never pulls them, so that f is up, and 0 in free fall. An IMU whose axes turn round
/// shows it downwards. The attitude (attitude.h) and the estimator would believe it. One sample is at most a quarter of
/// f, so that none brings the f of a robot that stands to the default limit. A missing sample changes nothing. Without
/// a command the driver folds the legs, which pulls the body down: f begins with 0 after it. While the body is pushed
/// (body_motion.h) the ground is not alone, and legs that catch it pull it down: f is 0.
class DownwardForce {
 public:
  static constexpr double kTime = 0.02;             ///< s, a tenth of the stance of a trot
  static constexpr double kLargest = 2 * kGravity;  ///< m/s²

  DownwardForce(const SafetyParameters&, const LegModel&, double) noexcept {}
  void enter_run() noexcept { force_ = 0; }

  ConditionMeasurement measure(const LeggedMeasurements& now, const ConditionWatch& watch) noexcept {
    const bool on_feet = now.phase == LegPhase::kRising || now.phase == LegPhase::kStanding || now.walks();
    const bool measured = on_feet && !(now.walks() && now.body.pushed());
    if (!measured) force_ = 0;
    if (!measured) return kNothingMeasured;
    const double along_z = now.body.along_z(), weight = std::min(0.25, now.dt / kTime);
    if (std::isfinite(along_z)) force_ += weight * (std::clamp(along_z, -kLargest, kLargest) - force_);
    return beyond(kMaxJoints, -force_, watch.limit());
  }

 private:
  double force_ = 0;  ///< m/s², f
};

/// The estimator's state is compared with the gyro.
///
///   wrong state  |ω − ω_g| > limit, with the state's turning rate ω of the cycle before and the gyro's ω_g of that cycle
///
/// They differ by the gyro's bias. A walk is balanced by the state, so that a robot whose state has the wrong sign tips
/// within 0.2 s. A state that is 10 ms old may differ as much. Without one of them nothing is compared.
class WrongState {
 public:
  WrongState(const SafetyParameters&, const LegModel&, double) noexcept { enter_run(); }
  void enter_run() noexcept { (*before_).setConstant(std::numeric_limits<double>::quiet_NaN()); }

  ConditionMeasurement measure(const LeggedMeasurements& now, const ConditionWatch& watch) noexcept {
    const Eigen::Vector3d by_gyro = *before_;
    *before_ = now.body.rate();
    if (now.input.state == nullptr || now.elapsed != 1) return kNothingMeasured;
    const Eigen::Map<const Eigen::Vector3d> by_state(now.input.state->base.twist_base.angular.data());
    return beyond(kMaxJoints, (by_state - by_gyro).norm(), watch.limit());
  }

 private:
  Stored<Eigen::Vector3d> before_;  ///< rad/s, ω_g
};

using FootConditions = ConditionList<WatchedCondition<kCauseFootSlip, Stateless<&LeggedMeasurements::foot_slip>>,
                                     WatchedCondition<kCauseFootLoad, Stateless<&LeggedMeasurements::foot_load>>,
                                     WatchedCondition<kCauseSinking, Stateless<&LeggedMeasurements::sinking>>,
                                     WatchedCondition<kCauseBodyTurn, Stateless<&LeggedMeasurements::body_turn>>>;

using LeggedConditions =
    ConditionSet<LeggedObserver,                                                                                      //
                 BodyConditions,                                                                                      //
                 WatchedCondition<kCauseImuReversed, DownwardForce>, WatchedCondition<kCauseWrongState, WrongState>,  //
                 JointConditions,                                                                                     //
                 EncoderConditions,                                                                                   //
                 FootConditions>;

/// Returns limits with a limit of foot_slip, where none is given: one leg length per second.
inline SafetyParameters legged_limits(const SafetyParameters& given, const LegModel& robot) {
  SafetyParameters limits = given;
  if (!limits.foot_slip.limit) limits.foot_slip.limit = robot.leg_length();
  return limits;
}

}  // namespace robot_control
