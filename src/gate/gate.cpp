#include "gate/gate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "gate/joint_clamp.h"

namespace robot_control {
namespace {

constexpr std::uint64_t kClamps = kGateEffortClamped | kGateRateClamped | kGateSpeedClamped | kGatePositionClamped;

bool is_brake(const JointCommand& joint) noexcept {
  return joint.mode == JointMode::kBrake;
}

[[noreturn]] void refuse(const std::string& what, std::size_t joint, double value, const std::string& rule) {
  throw std::invalid_argument("gate: " + what + " of joint " + std::to_string(joint) + " is " + std::to_string(value) +
                              ", must be a number " + rule);
}

void check(const JointLimits& limits, std::size_t joint) {
  if (!(limits.effort >= 0) || std::isinf(limits.effort)) refuse("effort limit", joint, limits.effort, ">= 0");
  if (!(limits.effort_rate > 0)) refuse("effort rate", joint, limits.effort_rate, "> 0");
  if (!(limits.velocity > 0)) refuse("velocity limit", joint, limits.velocity, "> 0");
  if (!(limits.acceleration > 0)) refuse("acceleration limit", joint, limits.acceleration, "> 0");
  if (!(limits.lower < limits.upper)) refuse("lower end stop", joint, limits.lower, "< the upper one");
  if (!(limits.soft_zone >= 0) || std::isinf(limits.soft_zone)) refuse("soft zone", joint, limits.soft_zone, ">= 0");
}

const StopAction& checked(const StopAction& action, std::size_t joint) {
  const auto check = [&](const char* what, double value) {
    if (!(value >= 0) || std::isinf(value)) refuse(what, joint, value, ">= 0");
  };
  check("stop damping", action.damping);
  check("stop stiffness", action.stiffness);
  check("stop time", action.time);
  check("stop time until the brake", action.brake_after);
  if (!std::isfinite(action.target)) refuse("stop target", joint, action.target, "that is finite");
  if (!std::isfinite(action.start)) refuse("stop start", joint, action.start, "that is finite");
  return action;
}

bool needs_sample(const JointLimits& limits) noexcept {
  return std::isfinite(limits.velocity) || std::isfinite(limits.lower) || std::isfinite(limits.upper);
}

}  // namespace

Gate::Gate(const std::vector<JointLimits>& limits, const GateParameters& parameters, double period)
    : longest_ramp_(parameters.longest_ramp), period_(period) {
  if (limits.size() > kMaxJoints) {
    throw std::invalid_argument("gate: " + std::to_string(limits.size()) + " joints, at most " +
                                std::to_string(kMaxJoints) + " are possible");
  }
  if (!(period > 0)) throw std::invalid_argument("gate: period " + std::to_string(period) + " s, must be > 0");
  for (const StopProfile& profile : parameters.profiles) {
    if (profile.size() != limits.size()) {
      throw std::invalid_argument("gate: " + std::to_string(profile.size()) + " stop actions for " +
                                  std::to_string(limits.size()) + " joints, must be one for each");
    }
    auto& actions = profiles_.emplace_back();
    for (const StopAction& action : profile) actions.emplace_back(checked(action, actions.size()));
  }
  if (profiles_.empty()) profiles_.emplace_back(limits.size(), StopAction{});
  for (std::size_t i = 0; i < limits.size(); ++i) {
    check(limits[i], i);
    limits_.emplace_back(limits[i]);
    memory_.emplace_back(JointMemory{.speed = JointSpeed(period)});
  }
}

void Gate::enter_run() noexcept {
  for (JointMemory& memory : memory_) memory = {.speed = JointSpeed(period_)};
  last_cycle_.reset();
  newest_permit_ = ramp_began_ = profile_ = 0;
  ramping_ = false;
  report_ = GateReport{};
}

std::span<const JointCommand> Gate::step(const GateInput& input) noexcept {
  report_.cycle = input.cycle;
  report_.verdict = GateVerdict::kBrake;
  report_.reasons = 0;
  report_.contact_schedule = {};
  read_samples(input);
  if (!check_and_clamp(input)) stop(elapsed_at(input.cycle), false);
  remember();
  last_cycle_ = input.cycle;
  return {commands_.data(), limits_.size()};
}

void Gate::read_samples(const GateInput& input) noexcept {
  const SensorFrame& sensors = *input.sensors;
  samples_ = std::span(sensors.joints).first(sensors.joint_count == limits_.size() ? limits_.size() : 0);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (has_position(i)) memory_[i].speed.step(samples_[i].position, input.cycle);
  }
}

bool Gate::check_and_clamp(const GateInput& input) noexcept {
  if (input.cycle == 0) {
    report_.reasons = kGateFirstTick;
    return false;
  }
  if (finds_command(input)) report_.command_cycle = input.command->head.cycle;
  if (!permit_is_alive(input) || !permit_allows_motion(*input.permit, input.cycle) || !command_is_fresh(input) ||
      !command_is_valid(*input.command) || !samples_suffice(*input.command)) {
    return false;
  }

  std::copy_n(input.command->joints.begin(), limits_.size(), commands_.begin());
  const bool held = (report_.reasons & kGateCommandHeld) != 0;
  if (held) ++report_.held;
  if (std::all_of(commands_.begin(), commands_.begin() + static_cast<std::ptrdiff_t>(limits_.size()), is_brake)) {
    stop(elapsed_at(input.cycle), true);
    report_.reasons |= kGateControllerBrake;
    return true;
  }
  report_.contact_schedule = input.command->contact_schedule;
  profile_ = input.command->stop_profile;
  clamp(static_cast<double>(elapsed_at(input.cycle)) * period_);
  if (input.permit->action == PermitAction::kRamp) {
    report_.verdict = GateVerdict::kRamp;
  } else if ((report_.reasons & kClamps) != 0) {
    report_.verdict = GateVerdict::kClamped;
  } else {
    report_.verdict = held ? GateVerdict::kHeld : GateVerdict::kPassed;
  }
  return true;
}

bool Gate::finds_command(const GateInput& input) const noexcept {
  const FrameHead& head = input.command->head;
  return input.command_found == Lookup::kFrame && head.run == input.run && head.cycle < input.cycle &&
         input.cycle - head.cycle <= kCommandLife;
}

bool Gate::permit_is_alive(const GateInput& input) noexcept {
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
  const bool superseded = permit.head.cycle < newest_permit_;
  newest_permit_ = std::max(newest_permit_, permit.head.cycle);
  if (superseded || input.cycle > permit.expiry || age > kPermitLife) {
    report_.reasons |= kGatePermitExpired;
    return false;
  }
  return true;
}

bool Gate::permit_allows_motion(const Permit& permit, std::uint64_t cycle) noexcept {
  switch (permit.action) {
    case PermitAction::kDrive:
      ramping_ = false;
      return true;
    case PermitAction::kRamp:
      if (!ramping_) ramp_began_ = cycle;
      ramping_ = true;
      if (cycle > permit.ramp_until) report_.reasons |= kGateRampOver;
      if (cycle - ramp_began_ >= longest_ramp_) report_.reasons |= kGateRampTooLong;
      return report_.reasons == 0;
    case PermitAction::kBrake:
      ramping_ = false;
      report_.reasons |= kGatePermitBrake;
      return false;
  }
  report_.reasons |= kGateUnknownMode;
  ++report_.refused;
  return false;
}

bool Gate::command_is_fresh(const GateInput& input) noexcept {
  if (input.command_found == Lookup::kCorrupt) {
    report_.reasons |= kGateChecksum;
    ++report_.refused;
    return false;
  }
  const FrameHead& head = input.command->head;
  if (input.command_found == Lookup::kFrame && head.run == input.run && head.cycle >= input.cycle) {
    report_.reasons |= kGateFuture;
    ++report_.refused;
    return false;
  }
  if (!finds_command(input)) {
    report_.reasons |= kGateNoCommand;
    ++report_.missed;
    return false;
  }
  if (input.cycle - head.cycle > 1) report_.reasons |= kGateCommandHeld;
  return true;
}

bool Gate::command_is_valid(const CommandFrame& command) noexcept {
  if (command.joint_count != limits_.size()) {
    report_.reasons |= kGateWrongJointCount;
    ++report_.refused;
    return false;
  }
  std::uint64_t wrong = command.stop_profile < profiles_.size() ? 0 : std::uint64_t{kGateUnknownMode};
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    if (!finite(command.joints[i])) wrong |= kGateNotFinite;
    if (static_cast<std::uint64_t>(command.joints[i].mode) >= kJointModes) wrong |= kGateUnknownMode;
  }
  report_.reasons |= wrong;
  if (wrong != 0) ++report_.refused;
  return wrong == 0;
}

bool Gate::samples_suffice(const CommandFrame& command) noexcept {
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    if (is_brake(command.joints[i]) || !needs_sample(limits_[i]) || has_position(i)) continue;
    report_.reasons |= kGateBadSensors;
    return false;
  }
  return true;
}

void Gate::clamp(double elapsed) noexcept {
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    const JointLimits& limits = limits_[i];
    JointCommand& command = commands_[i];
    report_.reasons |= clamp_effort(limits, command);
    if (is_brake(command)) continue;
    report_.reasons |= clamp_gains(command);
    const JointMemory& memory = memory_[i];
    const bool measured = has_position(i) && has(samples_[i], kValidEffort) && std::isfinite(samples_[i].effort);
    const double from = memory.driven ? memory.effort : 0.0;
    const double to = memory.driven || !measured ? from : samples_[i].effort;
    const double step = limits.effort_rate * elapsed;
    report_.reasons |= clamp_rate(std::min(from, to) - step, std::max(from, to) + step, command);
    if (!has_position(i)) continue;
    const double now = memory.speed.value();
    const double slowest = memory.follows ? memory.velocity : std::min(0.0, now);
    const double fastest = memory.follows ? memory.velocity : std::max(0.0, now);
    const double change = limits.acceleration * elapsed;
    report_.reasons |= clamp_acceleration(slowest - change, fastest + change, command);
    report_.reasons |= clamp_speed(limits, samples_[i].position, now, command);
    report_.reasons |= clamp_position(limits, samples_[i].position, command);
  }
}

void Gate::stop(std::uint64_t elapsed, bool by_command) noexcept {
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    if (by_command && !memory_[i].stop.moves()) {
      commands_[i] = {};
      continue;
    }
    const auto position = has_position(i) ? std::optional(samples_[i].position) : std::nullopt;
    commands_[i] = memory_[i].stop.step(profiles_[profile_][i], position, static_cast<double>(elapsed) * period_);
  }
}

void Gate::remember() noexcept {
  const bool braked = report_.verdict == GateVerdict::kBrake;
  auto command = commands_.begin();
  for (JointMemory& memory : memory_) {
    if (!braked) memory.stop = {};
    memory.driven = !braked && !is_brake(*command);
    memory.follows = memory.driven && command->mode == JointMode::kDriveVelocity;
    memory.velocity = command->velocity;
    memory.effort = (command++)->effort;
  }
}

}  // namespace robot_control
