#pragma once
/// Conditions of the body, from IMU and contact sensors (body_motion.h).
///
///   tilt       angle between the ground's normal n and the base's z axis > limit. On wheels n is the vertical u
///              (attitude.h), on legs that of standing_feet.h. The angle to u has a limit of its own there
///   tip over   tilt > half the limit of tilt, and its rate > limit. A robot that walks catches itself with its next
///              step: the limit of tilt itself counts
///   free fall  |a| < limit
///   lift       Σ F·u < limit · m g, if the robot has contact sensors; m = MachineModel::mass
///   impact     component of a perpendicular to u, mean over kImpactWindow, > limit; that is a speed change of
///              limit · kImpactWindow. The mean, because stiff bodies stop within milliseconds; the perpendicular
///              component, because bumps and landings accelerate upwards. It is not judged while a machine folds its
///              legs, and for `landing` after it: the blow is its own
///   IMU jump   the change of the gyro's rates from sample to sample (RateChange) > limit. The accelerometer is not
///              judged: a robot that falls shakes it as much as random samples would (docs/evidence/derivations.md)
///   IMU stuck  all axes of gyro or of accelerometer are bit for bit equal to the last sample while the machine moves.
///              Noise changes the last bits of every new sample; an IMU that is slower than the loop repeats a sample
///              for less than any allowed persistence. At standstill even correct sensors may repeat a value
///
/// a: specific force of the accelerometer; u: vertical, upwards; both in base axes. The default limits are 1.5 times
/// what normal driving reaches; the measured values stand in docs/evidence/derivations.md. Without a sample its
/// conditions are not beyond their limits.

#include <algorithm>

#include "safety/conditions/common/condition_list.h"
#include "safety/measurements/body_motion.h"
#include "safety/monitor_input.h"

namespace robot_control {

/// The measurements of one cycle that every kind has.
struct BodyMeasurements {
  const MonitorInput& input;  ///< with sensors
  std::uint64_t elapsed;      ///< cycles since the last step, ≥ 1
  double dt;                  ///< s, the same
  const BodyMotion& body;
  const FixedDirection& ground;  ///< n
  double least_tilt = 0;         ///< rad, the limit of tilt is at least this
  double least_slope = 0;        ///< rad, the limit of the angle to u is at least this
  bool catches = false;          ///< it walks
};

struct BodyLaws {
  static ConditionMeasurement tilt(const BodyMeasurements& now, const ConditionWatch& watch) noexcept {
    const Attitude& attitude = now.body.attitude();
    if (!attitude.known()) return kNothingMeasured;
    const double limit = std::max(watch.limit(), now.least_tilt), steepest = std::max(limit, now.least_slope);
    if (!attitude.surely_within(steepest) && attitude.tilt() > steepest)
      return beyond(kMaxJoints, attitude.tilt(), steepest);
    return now.ground.surely_within(limit) ? kNothingMeasured : beyond(kMaxJoints, now.ground.tilt(), limit);
  }
  static ConditionMeasurement free_fall(const BodyMeasurements& now, const ConditionWatch& watch) noexcept {
    return now.body.felt() ? below(now.body.force(), watch.limit()) : kNothingMeasured;
  }
  static ConditionMeasurement lift(const BodyMeasurements& now, const ConditionWatch& watch) noexcept {
    return below(now.body.carried(), watch.limit());
  }
  static ConditionMeasurement impact(const BodyMeasurements& now, const ConditionWatch& watch) noexcept {
    return now.body.folds() ? kNothingMeasured : beyond(kMaxJoints, now.body.shock(), watch.limit());
  }
  static ConditionMeasurement imu_jump(const BodyMeasurements& now, const ConditionWatch& watch) noexcept {
    return beyond(kMaxJoints, now.body.rate_change(), watch.limit());
  }
  static ConditionMeasurement gyro_stuck(const BodyMeasurements& now, const ConditionWatch& watch) noexcept {
    return {.beyond = now.body.gyro_repeated() > 0, .value = now.body.gyro_repeated(), .limit = watch.persistence()};
  }
  static ConditionMeasurement force_stuck(const BodyMeasurements& now, const ConditionWatch& watch) noexcept {
    return {.beyond = now.body.force_repeated() > 0, .value = now.body.force_repeated(), .limit = watch.persistence()};
  }
};

class TipOver {
 public:
  TipOver(const SafetyParameters& parameters, const MachineModel&, double) noexcept
      : tilt_(parameters.tilt.limit.value_or(0) / 2) {}
  void enter_run() noexcept {}
  ConditionMeasurement measure(const BodyMeasurements& now, const ConditionWatch& watch) const noexcept {
    const double rate = now.ground.tilt_rate(now.body.rate());
    if (!(rate > watch.limit())) return kNothingMeasured;  // before the angle, which costs more; without a gyro, too
    const bool leans = now.body.attitude().known() && now.ground.tilt() > (now.catches ? 2 : 1) * tilt_;
    return leans ? beyond(kMaxJoints, rate, watch.limit()) : kNothingMeasured;
  }

 private:
  double tilt_;  ///< rad
};

using BodyConditions =
    ConditionList<WatchedCondition<kCauseTilt, Stateless<BodyLaws::tilt>>, WatchedCondition<kCauseTipOver, TipOver>,
                  WatchedCondition<kCauseFreeFall, Stateless<BodyLaws::free_fall>>,
                  WatchedCondition<kCauseLift, Stateless<BodyLaws::lift>>,
                  WatchedCondition<kCauseImpact, Stateless<BodyLaws::impact>>,
                  WatchedCondition<kCauseImuJump, Stateless<BodyLaws::imu_jump>>,
                  WatchedCondition<kCauseImuStuck, Stateless<BodyLaws::gyro_stuck>>,
                  WatchedCondition<kCauseImuStuck, Stateless<BodyLaws::force_stuck>>>;

}  // namespace robot_control
