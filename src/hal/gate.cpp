#include "hal/gate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace robot_control {
namespace {

bool is_brake(const JointCommand& joint) noexcept {
  return joint.mode == JointMode::kBrake;
}

}  // namespace

Gate::Gate(std::vector<double> effort_limits) : joint_count_(effort_limits.size()) {
  if (joint_count_ > kMaxJoints) {
    throw std::invalid_argument("gate: " + std::to_string(joint_count_) + " joints, at most " +
                                std::to_string(kMaxJoints) + " are possible");
  }
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (!(effort_limits[i] >= 0)) {
      throw std::invalid_argument("gate: effort limit of joint " + std::to_string(i) + " is " +
                                  std::to_string(effort_limits[i]) + ", must be a number >= 0");
    }
    effort_limits_[i] = effort_limits[i];
  }
}

void Gate::reset() noexcept {
  report_ = GateReport{};
}

std::span<const JointCommand> Gate::step(const GateInput& input) noexcept {
  report_.verdict = GateVerdict::kBrake;
  report_.reasons = 0;
  commands_.fill(JointCommand{});
  const std::span<const JointCommand> result{commands_.data(), joint_count_};
  if (input.cycle == 0) {
    report_.reasons = kGateFirstTick;
    return result;
  }
  if (!permitted(input) || !fresh(input) || !sound(*input.command)) return result;

  std::copy_n(input.command->joints.begin(), joint_count_, commands_.begin());
  const bool held = (report_.reasons & kGateCommandHeld) != 0;
  if (held) ++report_.held;
  if (std::all_of(result.begin(), result.end(), is_brake)) {
    commands_.fill(JointCommand{});
    report_.reasons |= kGateControllerBrake;
    return result;
  }
  clamp();
  if (input.permit->action == PermitAction::kRamp) {
    report_.verdict = GateVerdict::kRamp;
  } else if ((report_.reasons & kGateEffortClamped) != 0) {
    report_.verdict = GateVerdict::kClamped;
  } else {
    report_.verdict = held ? GateVerdict::kHeld : GateVerdict::kPassed;
  }
  return result;
}

bool Gate::permitted(const GateInput& input) noexcept {
  if (input.permit_found == Lookup::kCorrupt) {
    report_.reasons |= kGateChecksum;
    ++report_.refused;
    return false;
  }
  const Permit& permit = *input.permit;
  if (input.permit_found != Lookup::kFrame || permit.head.run != input.run) {
    report_.reasons |= kGateNoPermit;
    return false;
  }
  if (permit.head.cycle >= input.cycle) {
    report_.reasons |= kGateFuture;
    ++report_.refused;
    return false;
  }
  report_.permit_cycle = permit.head.cycle;
  const std::uint64_t age = input.cycle - permit.head.cycle;
  if (age > 1) ++report_.late_permits;
  if (input.cycle > permit.expiry || age > kPermitLife) {
    report_.reasons |= kGatePermitExpired;
    return false;
  }
  switch (permit.action) {
    case PermitAction::kDrive:
      return true;
    case PermitAction::kRamp:
      if (input.cycle <= permit.ramp_until) return true;
      report_.reasons |= kGateRampOver;
      return false;
    case PermitAction::kBrake:
      report_.reasons |= kGatePermitBrake;
      return false;
  }
  report_.reasons |= kGateUnknownMode;
  ++report_.refused;
  return false;
}

bool Gate::fresh(const GateInput& input) noexcept {
  if (input.command_found == Lookup::kCorrupt) {
    report_.reasons |= kGateChecksum;
    ++report_.refused;
    return false;
  }
  const FrameHead& head = input.command->head;
  const bool found = input.command_found == Lookup::kFrame && head.run == input.run;
  if (found && head.cycle >= input.cycle) {
    report_.reasons |= kGateFuture;
    ++report_.refused;
    return false;
  }
  if (!found || input.cycle - head.cycle > kCommandLife) {
    report_.reasons |= kGateNoCommand;
    ++report_.missed;
    return false;
  }
  report_.command_cycle = head.cycle;
  if (input.cycle - head.cycle > 1) report_.reasons |= kGateCommandHeld;
  return true;
}

bool Gate::sound(const CommandFrame& command) noexcept {
  if (command.joint_count != joint_count_) {
    report_.reasons |= kGateWrongJointCount;
    ++report_.refused;
    return false;
  }
  std::uint64_t wrong = 0;
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (!finite(command.joints[i])) wrong |= kGateNotFinite;
    if (command.joints[i].mode > JointMode::kImpedance) wrong |= kGateUnknownMode;
  }
  report_.reasons |= wrong;
  if (wrong != 0) ++report_.refused;
  return wrong == 0;
}

void Gate::clamp() noexcept {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    double& effort = commands_[i].effort;
    if (std::abs(effort) <= effort_limits_[i]) continue;
    effort = std::copysign(effort_limits_[i], effort);
    report_.reasons |= kGateEffortClamped;
  }
}

}  // namespace robot_control
