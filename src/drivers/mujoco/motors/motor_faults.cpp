#include "drivers/mujoco/motors/motor_faults.h"

#include <algorithm>

namespace robot_control {

void MotorFaults::add(std::size_t joint, double inertia, double effort_limit, std::uint64_t seed, double step) {
  motors_.push_back({.joint = joint,
                     .limit = effort_limit,
                     .stiffness = inertia / (4 * step * step),
                     .damping = inertia / (2 * step),
                     .output = FaultyOutput<JointCommand>(fault_seed(seed, FaultComponent::kMotor, joint))});
}

void MotorFaults::reset() noexcept {
  for (Motor& motor : motors_) {
    motor.output.reset();
    motor.state = State::kHealthy;
    motor.anchored = false;
  }
  failing_ = false;
}

void MotorFaults::step(Motor& motor, FaultKind kind, std::uint64_t cycle) noexcept {
  State state = State::kHealthy;
  if (kind == FaultKind::kStuck) state = State::kBlocked;
  if (kind == FaultKind::kGarbage) state = State::kRandom;
  if (kind == FaultKind::kWrong) state = State::kReversed;
  const auto distort = [&motor](FaultKind how, JointCommand&, FaultRandom& random) {
    if (how == FaultKind::kGarbage) motor.random_effort = random.within(motor.limit);
  };
  const Emission emission = motor.output.step(kind, cycle, received_[motor.joint], distort);
  if (emission == Emission::kNothing && kind != FaultKind::kSlow) state = State::kDead;
  if (state != motor.state) motor.anchored = false;
  motor.state = state;
}

std::span<const JointCommand> MotorFaults::receive(const InjectedFaults& faults, std::uint64_t cycle,
                                                   std::span<const JointCommand> commands) noexcept {
  const bool failing = any_fault(faults);
  if (!failing && !failing_) return commands;
  failing_ = failing;
  std::copy(commands.begin(), commands.end(), received_.begin());
  for (Motor& motor : motors_) step(motor, fault_of(faults, FaultComponent::kMotor, motor.joint), cycle);
  return {received_.data(), commands.size()};
}

double MotorFaults::effort(std::size_t index, JointMode mode, double effort, double position,
                           double velocity) noexcept {
  Motor& motor = motors_[index];
  switch (motor.state) {
    case State::kHealthy:
      return effort;
    case State::kDead:
      return 0;
    case State::kRandom:
      return motor.random_effort;
    case State::kReversed:
      return mode == JointMode::kBrake ? effort : -effort;
    case State::kBlocked:
      if (!motor.anchored) motor.anchor = position;
      motor.anchored = true;
      return motor.stiffness * (motor.anchor - position) - motor.damping * velocity;
  }
  return 0;
}

}  // namespace robot_control
