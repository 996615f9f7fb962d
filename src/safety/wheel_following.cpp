#include "safety/wheel_following.h"

#include <cmath>

namespace robot_control {
namespace {

Finding beyond(std::size_t joint, double value, double limit) noexcept {
  return {.beyond = value > limit, .value = value, .limit = limit, .joint = joint};
}

/// In the direction of the target.
double along(double target, double speed) noexcept {
  return target < 0 ? -speed : speed;
}

Finding run_away(const WheelTargets& targets, const WheelMotion& motion, double limit) noexcept {
  Finding finding = kNothingFound;
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    if (!targets.has(i)) continue;
    const double target = targets[i];
    const double speed = target == 0 ? std::abs(motion.speed(i)) : along(target, motion.speed(i));
    finding = worse(finding, beyond(i, speed - std::abs(target), limit + motion.speed_tolerance(i)));
  }
  return finding;
}

Finding turned_wrongly(const WheelTargets& targets, const WheelMotion& motion, double limit) noexcept {
  Finding finding = kNothingFound;
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    if (!targets.has(i) || targets[i] == 0) continue;
    finding = worse(finding, beyond(i, -along(targets[i], motion.speed(i)), limit + motion.speed_tolerance(i)));
  }
  return finding;
}

}  // namespace

WheelFollowing::WheelFollowing(const SafetyParameters& parameters, double period) noexcept
    : period_(period),
      stall_(kCauseStall, parameters.stall, period),
      runaway_(kCauseRunaway, parameters.runaway, period),
      wrong_direction_(kCauseWrongDirection, parameters.wrong_direction, period),
      not_stopping_(kCauseNotStopping, parameters.not_stopping, period) {}

void WheelFollowing::enter_run() noexcept {
  for (ConditionWatch* watch : {&stall_, &runaway_, &wrong_direction_, &not_stopping_}) watch->reset();
  missed_ = {};
  still_moving_ = 0;
}

void WheelFollowing::step(const WheelTargets& targets, const WheelMotion& motion, const JointStandstill& standstill,
                          std::uint64_t elapsed, ActiveCauses& out) noexcept {
  if (motion.speed_known()) {
    out.judge(stall_, stalled(targets, motion, static_cast<double>(elapsed) * period_), elapsed);
    out.judge(runaway_, run_away(targets, motion, runaway_.limit()), elapsed);
    out.judge(wrong_direction_, turned_wrongly(targets, motion, wrong_direction_.limit()), elapsed);
  } else {
    for (ConditionWatch* watch : {&stall_, &runaway_, &wrong_direction_}) out.judge(*watch, kNothingFound, elapsed);
  }
  out.judge(not_stopping_, not_stopped(targets, standstill, elapsed), elapsed);
}

Finding WheelFollowing::stalled(const WheelTargets& targets, const WheelMotion& motion, double dt) noexcept {
  Finding finding = kNothingFound;
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    const double wanted = targets.has(i) ? std::abs(targets[i]) : 0;
    const bool follows = wanted == 0 || along(targets[i], motion.speed(i)) >= kFollows * wanted;
    missed_[i] = follows ? 0 : missed_[i] + wanted * dt;
    finding = worse(finding, beyond(i, missed_[i], stall_.limit() + motion.quantum(i)));
  }
  return finding;
}

Finding WheelFollowing::not_stopped(const WheelTargets& targets, const JointStandstill& standstill,
                                    std::uint64_t elapsed) noexcept {
  const bool moves_on = targets.told_to_stand() && standstill.moving();
  still_moving_ = moves_on ? still_moving_ + elapsed : 0;
  return beyond(kMaxJoints, static_cast<double>(still_moving_) * period_, not_stopping_.limit());
}

}  // namespace robot_control
