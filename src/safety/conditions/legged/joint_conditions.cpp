#include "safety/conditions/legged/joint_conditions.h"

namespace robot_control {

ConditionMeasurement JointFollowing::measure(const LeggedMeasurements& now, const ConditionWatch& watch,
                                             std::size_t i) noexcept {
  if (!now.walks()) behind_[i] = 0;
  if (!has_position(now.joint(i)) || now.phase == LegPhase::kLying || now.phase == LegPhase::kJoints)
    return kNothingMeasured;
  const bool judged = now.walks() ? now.swings(i) : now.command(i).mode == JointMode::kImpedance;
  const double left = judged ? std::abs(now.command(i).position - now.joint(i).position) : 0;
  if (now.walks() && judged) behind_[i] += std::min(1.0, now.dt / kMeanTime) * (left - behind_[i]);
  if (left > (now.phase == LegPhase::kStanding ? 1 : kFarTimes) * watch.limit())
    return weighed(beyond(i, left, watch.limit()));
  return now.walks() ? weighed(beyond(i, behind_[i], watch.limit())) : kNothingMeasured;
}

ConditionMeasurement JointMismatch::measure(const LeggedMeasurements& now, const ConditionWatch& watch) noexcept {
  if (!now.walks()) {
    swings_ = {};
    for (MotorTorque& torque : torques_) torque.reset();
    return kNothingMeasured;
  }
  return at_once(worst_of(kLegsJoints, [&](std::size_t i) {
    const double against = has_position(now.joint(i)) ? moved_against_command(now, i) : 0;
    const double parts = std::max(against / kMaxOpposition, wrong_torque(now, i) / kWrongTorqueShare);
    return beyond(i, parts * watch.limit(), watch.limit());
  }));
}

/// Returns by how many rad the angle of a joint has moved against its command in this swing.
double JointMismatch::moved_against_command(const LeggedMeasurements& now, std::size_t i) noexcept {
  Swing& swing = swings_[i];
  if (!now.swings(i)) {
    swing = {};
    return 0;
  }
  const double command = now.command(i).position, angle = now.joint(i).position;
  if (!swing.last) {
    swing.last = {command, angle, 0};
  } else if (static_cast<double>(swing.last->age += now.elapsed) * period_ > kStride - period_ / 2) {
    const double turned = angle - swing.last->joint, wanted = command - swing.last->command;
    swing.against = std::max(0.0, swing.against + (wanted < 0 ? turned : wanted > 0 ? -turned : 0));
    swing.last = {command, angle, 0};
  }
  return swing.against;
}

/// Returns in which part of the last cycles the torque of the motor was wrong.
double JointMismatch::wrong_torque(const LeggedMeasurements& now, std::size_t i) noexcept {
  constexpr std::uint64_t kOtherLaw = kGateRateClamped | kGateSpeedClamped | kGatePositionClamped;
  const JointSample& joint = now.joint(i);
  const GateReport& gate = now.input.sensors->gate;
  if (!now.walks_by(i) || gate.verdict == GateVerdict::kBrake || now.elapsed > 1 || (gate.reasons & kOtherLaw) != 0 ||
      !finite(now.command(i)) || !has(joint, kValidMotion) ||
      !std::isfinite(joint.position + joint.velocity + joint.effort)) {
    torques_[i].forget();
    return 0;
  }
  torques_[i].step(joint, now.command(i), now.limits[i].effort, period_);
  return torques_[i].wrong();
}

}  // namespace robot_control
