#pragma once
/// Limits of each wheel that do not depend on the command.
///
///   wheel_speed         |ω| > limit + tolerance. While a speed limit L (m/s) has been in force for longer than
///                       ramp_time, also |ω| > (kSlack·L + kSlackSpeed)/radius + tolerance: the controller does not
///                       slow down
///   wheel_acceleration  |ω̇| > limit + tolerance
///   wheel_effort        |τ|/(the joint's effort limit) > limit, in ticks in which the gate let a command pass: the
///                       driver's own brake may be stronger than the motor
///   yaw_rate            gyro and wheels measure different yaw rates (yaw_agreement.h)
///   power               Σ max(0, τ ω) > limit + Σ |τ|·tolerance: the power that the motors draw; braking draws none
///
/// Without a measured torque wheel_effort and power are not evaluated.
///
/// ω, ω̇ and their tolerances: wheel_motion.h. The measurement is that of the worst wheel.

#include <algorithm>
#include <cmath>

#include "safety/conditions/common/condition_list.h"
#include "safety/conditions/wheeled/wheeled_observer.h"

namespace robot_control {

struct WheelLaws {
  static constexpr double kSlack = 1.2;        ///< overshoot of a wheel that follows
  static constexpr double kSlackSpeed = 0.05;  ///< m/s

  static ConditionMeasurement wheel_speed(const WheeledMeasurements& now, const ConditionWatch& watch) noexcept {
    if (!now.motion.speed_known()) return kNothingMeasured;
    return weighed(worst_of(now.motion.wheels(), [&](std::size_t i) {
      const double slowed = (kSlack * now.speed_limit + kSlackSpeed) / now.wheels[i].radius;
      return beyond(i, std::abs(now.motion.speed(i)), std::min(watch.limit(), slowed) + now.motion.speed_tolerance(i));
    }));
  }

  static ConditionMeasurement wheel_acceleration(const WheeledMeasurements& now, const ConditionWatch& watch) noexcept {
    if (!now.motion.acceleration_known()) return kNothingMeasured;
    return worst_of(now.motion.wheels(), [&](std::size_t i) {
      return beyond(i, std::abs(now.motion.acceleration(i)), watch.limit() + now.motion.acceleration_tolerance(i));
    });
  }

  static ConditionMeasurement wheel_effort(const WheeledMeasurements& now, const ConditionWatch& watch) noexcept {
    if (!now.motion.sampled() || !now.targets.passed() || !now.efforts_measured) return kNothingMeasured;
    return worst_of(now.motion.wheels(), [&](std::size_t i) {
      return beyond(i, std::abs(now.input.sensors->joints[i].effort) / now.wheels[i].effort_limit, watch.limit());
    });
  }

  static ConditionMeasurement power(const WheeledMeasurements& now, const ConditionWatch& watch) noexcept {
    if (!now.motion.speed_known() || !now.efforts_measured) return kNothingMeasured;
    double power = 0;
    double limit = watch.limit();
    for (std::size_t i = 0; i < now.motion.wheels(); ++i) {
      const double effort = now.input.sensors->joints[i].effort;
      power += std::max(0.0, effort * now.motion.speed(i));
      limit += std::abs(effort) * now.motion.speed_tolerance(i);
    }
    return beyond(kMaxJoints, power, limit);
  }
};

using WheelLimits = ConditionList<WatchedCondition<kCauseWheelSpeed, Stateless<WheelLaws::wheel_speed>>,
                                  WatchedCondition<kCauseWheelAcceleration, Stateless<WheelLaws::wheel_acceleration>>,
                                  WatchedCondition<kCauseWheelEffort, Stateless<WheelLaws::wheel_effort>>,
                                  WatchedCondition<kCausePower, Stateless<WheelLaws::power>>,
                                  WatchedCondition<kCauseYawRate, Stateless<&WheeledMeasurements::yaw_rate>>>;

}  // namespace robot_control
