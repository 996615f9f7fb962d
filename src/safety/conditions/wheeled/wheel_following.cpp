#include "safety/conditions/wheeled/wheel_following.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

/// In the direction of the target.
double along(double target, double speed) noexcept {
  return target < 0 ? -speed : speed;
}

}  // namespace

WheelFollowing::WheelFollowing(const SafetyParameters& parameters, const DriveTrain& robot, double period)
    : period_(period),
      stall_(kCauseStall, parameters.stall, period),
      not_stopping_(kCauseNotStopping, parameters.not_stopping, period),
      runaway_(robot.wheels.size(), {.watch = ConditionWatch(kCauseRunaway, parameters.runaway, period)}),
      wrong_direction_(robot.wheels.size(),
                       {.watch = ConditionWatch(kCauseWrongDirection, parameters.wrong_direction, period)}),
      planned_(robot),
      scrub_(robot),
      scrubs_(!robot.wheels.empty() && scrub_.max_effort(0) > 0) {
  for (std::size_t i = 0; i < std::min(robot.wheels.size(), kMaxWheels); ++i) {
    const JointModel& joint = robot.joints[robot.wheels[i].joint];
    const double friction = kFrictions * (joint.friction + scrub_.max_effort(i));
    pushed_[i] = std::max(kPushedPart * joint.effort_limit, std::min(kLargePart * joint.effort_limit, friction));
    friction_[i] = joint.friction;
    per_yaw_[i] = robot.effective_wheel_base() / robot.wheels[i].radius;
    if (joint.velocity_limit > 0) fastest_[i] = joint.velocity_limit;
  }
}

void WheelFollowing::enter_run() noexcept {
  stall_.reset();
  not_stopping_.reset();
  for (Excess& excess : runaway_) excess.reset();
  for (Excess& excess : wrong_direction_) excess.reset();
  stalls_ = {};
  planned_.enter_run();
  moved_ = rested_ = 0;
}

void WheelFollowing::step(const SensorFrame& sensors, const WheelTargets& targets, const WheelMotion& motion,
                          const JointStandstill& standstill, double yaw_excess, std::uint64_t elapsed,
                          ActiveCauses& out) noexcept {
  const bool known = motion.speed_known();
  for (std::size_t i = 0; i < runaway_.size(); ++i) {
    if (!known || !targets.has(i)) {
      runaway_[i].reset();
      wrong_direction_[i].reset();
      continue;
    }
    update_excesses(targets, motion, i, elapsed, out);
  }
  const double dt = static_cast<double>(elapsed) * period_;
  planned_.step(targets, dt);
  out.update(stall_, known ? stalled(sensors, targets, motion, yaw_excess, dt) : kNothingMeasured, elapsed);
  out.update(not_stopping_, known ? not_stopped(targets, standstill, elapsed) : kNothingMeasured, elapsed);
}

void WheelFollowing::Excess::reset() noexcept {
  watch.reset();
  mark = 0;
}

void WheelFollowing::Excess::step(const ConditionMeasurement& measurement, double speed, double progress,
                                  std::uint64_t elapsed, ActiveCauses& out) noexcept {
  if (!measurement.beyond) return reset();
  const bool begins = mark == 0;
  const bool slows = !begins && speed < mark - progress && measurement.value <= kFarBeyond * measurement.limit;
  if (begins || slows) mark = speed;
  if (slows) return watch.reset();
  out.update(watch, measurement, elapsed);
}

void WheelFollowing::update_excesses(const WheelTargets& targets, const WheelMotion& motion, std::size_t wheel,
                                     std::uint64_t elapsed, ActiveCauses& out) noexcept {
  Excess &runaway = runaway_[wheel], &wrong = wrong_direction_[wheel];
  const double target = targets[wheel], tolerance = motion.speed_tolerance(wheel), progress = kProgress + tolerance;
  const double speed = target == 0 ? std::abs(motion.speed(wheel)) : along(target, motion.speed(wheel));
  const double back = target == 0 ? 0 : -speed;
  const ConditionMeasurement ahead = beyond(wheel, speed - std::abs(target), runaway.watch.limit() + tolerance);
  runaway.step(ahead, speed, progress, weighed(ahead, elapsed), out);
  wrong.step(beyond(wheel, back, wrong.watch.limit() + tolerance), back, progress, elapsed, out);
}

bool WheelFollowing::Stall::builds_up(double torque, double held, double dt) noexcept {
  if (!(torque <= held)) return false;
  if (torque > peak + kRise * std::abs(held)) {
    peak = torque;
    level = 0;
  }
  level += dt;
  return level <= kBuildUp;
}

double WheelFollowing::held(std::size_t wheel, double scrubbing) const noexcept {
  if (scrubbing == 0) return -std::numeric_limits<double>::infinity();
  return std::min(pushed_[wheel], friction_[wheel] + kGrounds * std::abs(scrubbing));
}

ConditionMeasurement WheelFollowing::stalled(const SensorFrame& sensors, const WheelTargets& targets,
                                             const WheelMotion& motion, double yaw_excess, double dt) noexcept {
  ConditionMeasurement measurement = kNothingMeasured;
  std::array<double, kMaxWheels> scrubbing{};
  if (scrubs_) {
    std::array<double, kMaxWheels> wanted{};
    for (std::size_t i = 0; i < motion.wheels(); ++i) wanted[i] = targets.has(i) ? targets[i] : 0;
    scrubbing = scrub_.efforts(wanted);
  }
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    Stall& stall = stalls_[i];
    const double wanted = targets.has(i) ? std::min(std::abs(targets[i]), fastest_[i]) : 0;
    const double speed = along(targets[i], motion.speed(i));
    const bool turns = std::abs(speed) >= kTurns * wanted;
    const double torque = sensors.joints[i].effort;
    if (turns || speed > stall.mark + kProgress + motion.speed_tolerance(i)) {
      stall = {.mark = speed};
    } else {
      stall.target_travel += wanted * dt;
      const bool overdue = stall.target_travel > motion.quantum(i);
      const bool pushes = overdue && std::min(std::abs(torque), std::abs(torque - planned_[i])) > pushed_[i];
      const double pushed = pushes ? kPushed : 0;
      const bool excused = stall.excused < kExcused * stall_.limit() &&
                           stall.builds_up(along(targets[i], torque), held(i, scrubbing[i]), dt);
      (excused ? stall.excused : stall.missed) += std::max({wanted, pushed, yaw_excess * per_yaw_[i]}) * dt;
    }
    measurement = worse(measurement, beyond(i, stall.missed, stall_.limit() + motion.quantum(i)));
  }
  return measurement;
}

ConditionMeasurement WheelFollowing::not_stopped(const WheelTargets& targets, const JointStandstill& standstill,
                                                 std::uint64_t elapsed) noexcept {
  rested_ = standstill.moving() ? 0 : rested_ + elapsed;
  if (!targets.commanded_to_stand() || static_cast<double>(rested_) * period_ >= kRest) {
    moved_ = 0;
  } else if (standstill.moving()) {
    moved_ += elapsed;
  }
  return beyond(kMaxJoints, static_cast<double>(moved_) * period_, not_stopping_.limit());
}

}  // namespace robot_control
