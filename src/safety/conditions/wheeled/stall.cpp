#include "safety/conditions/wheeled/stall.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

Stall::Stall(const SafetyParameters&, const DriveTrain& robot, double)
    : planned_(robot), scrub_(robot), scrubs_(!robot.wheels.empty() && scrub_.max_effort(0) > 0) {
  for (std::size_t i = 0; i < std::min(robot.wheels.size(), kMaxWheels); ++i) {
    const JointModel& joint = robot.joints[robot.wheels[i].joint];
    const double friction = kFrictions * (joint.friction + scrub_.max_effort(i));
    wheels_[i] = {
        .pushed = std::max(kPushedPart * joint.effort_limit, std::min(kLargePart * joint.effort_limit, friction)),
        .friction = joint.friction,
        .per_yaw = robot.effective_wheel_base() / robot.wheels[i].radius,
        .fastest = joint.velocity_limit > 0 ? joint.velocity_limit : kInfinity};
  }
}

void Stall::enter_run() noexcept {
  standing_ = {};
  planned_.enter_run();
}

bool Stall::Standing::builds_up(double torque, double held, double dt) noexcept {
  if (!(torque <= held)) return false;
  if (torque > peak + kTorqueRise * std::abs(held)) {
    peak = torque;
    level = 0;
  }
  level += dt;
  return level <= kBuildUp;
}

double Stall::held(std::size_t wheel, double scrubbing) const noexcept {
  if (scrubbing == 0) return -kInfinity;
  return std::min(wheels_[wheel].pushed, wheels_[wheel].friction + kGrounds * std::abs(scrubbing));
}

ConditionMeasurement Stall::measure(const WheeledMeasurements& now, const ConditionWatch& watch) noexcept {
  const WheelTargets& targets = now.targets;
  const WheelMotion& motion = now.motion;
  planned_.step(targets, now.dt);
  if (!motion.speed_known()) return kNothingMeasured;
  std::array<double, kMaxWheels> wanted{}, scrubbing{};
  for (std::size_t i = 0; i < motion.wheels(); ++i) wanted[i] = targets.has(i) ? targets[i] : 0;
  if (scrubs_) scrubbing = scrub_.efforts(wanted);
  const double yaw_excess = now.yaw_rate.beyond ? now.yaw_rate.value - now.yaw_rate.limit : 0;
  return worst_of(motion.wheels(), [&](std::size_t i) {
    const Wheel& wheel = wheels_[i];
    Standing& standing = standing_[i];
    const double towards = targets[i] < 0 ? -1 : 1, speed = towards * motion.speed(i);
    const double target = std::min(std::abs(wanted[i]), wheel.fastest), torque = now.input.sensors->joints[i].effort;
    if (std::abs(speed) >= kTurns * target || speed > standing.mark + kMinProgress + motion.speed_tolerance(i)) {
      standing = {.mark = speed};
    } else {
      standing.target_travel += target * now.dt;
      const bool overdue = standing.target_travel > motion.quantum(i);
      const bool pushes = overdue && std::min(std::abs(torque), std::abs(torque - planned_[i])) > wheel.pushed;
      const bool excused = standing.excused < kMaxExcusedShare * watch.limit() &&
                           standing.builds_up(towards * torque, held(i, scrubbing[i]), now.dt);
      (excused ? standing.excused : standing.missed) +=
          std::max({target, pushes ? kPushedSpeed : 0, yaw_excess * wheel.per_yaw}) * now.dt;
    }
    return beyond(i, standing.missed, watch.limit() + motion.quantum(i));
  });
}

}  // namespace robot_control
