#include "drivers/mujoco/motors/motor_faults.h"

#include <algorithm>

#include "drivers/mujoco/motors/wheel_joints.h"

namespace robot_control {

MotorFaults::MotorFaults(const DriveTrain& robot, std::uint64_t seed, double step)
    : left_{wheel_joints(robot, Side::kLeft),
            FaultyOutput<WheelCommands>(fault_seed(seed, FaultComponent::kLeftMotor))},
      right_{wheel_joints(robot, Side::kRight),
             FaultyOutput<WheelCommands>(fault_seed(seed, FaultComponent::kRightMotor))} {
  for (const WheelModel& wheel : robot.wheels) {
    Drive& drive = drives_[wheel.joint];
    drive.limit = robot.joints[wheel.joint].effort_limit;
    drive.stiffness = wheel.inertia / (4 * step * step);
    drive.damping = wheel.inertia / (2 * step);
  }
}

void MotorFaults::reset() noexcept {
  for (Motors* side : {&left_, &right_}) {
    side->output.reset();
    side->kind = FaultKind::kOk;
  }
  for (Drive& drive : drives_) {
    drive.state = State::kHealthy;
    drive.anchored = false;
  }
}

void MotorFaults::step(Motors& side, FaultKind kind, std::uint64_t cycle) noexcept {
  WheelCommands commands;
  for (std::size_t i = 0; i < side.joints.size(); ++i) commands[i] = received_[side.joints[i]];
  State state = State::kHealthy;
  if (kind == FaultKind::kStuck) state = State::kBlocked;
  if (kind == FaultKind::kGarbage) state = State::kRandom;
  if (kind == FaultKind::kWrong) state = State::kReversed;
  const auto distort = [&](FaultKind how, WheelCommands&, FaultRandom& random) {
    if (how != FaultKind::kGarbage) return;
    for (const std::size_t joint : side.joints) drives_[joint].random_effort = random.within(drives_[joint].limit);
  };
  const Emission emission = side.output.step(kind, cycle, commands, distort);
  if (emission == Emission::kNothing && kind != FaultKind::kSlow) state = State::kDead;
  for (std::size_t i = 0; i < side.joints.size(); ++i) {
    Drive& drive = drives_[side.joints[i]];
    if (state != drive.state) drive.anchored = false;
    drive.state = state;
    received_[side.joints[i]] = commands[i];
  }
  side.kind = kind;
}

std::span<const JointCommand> MotorFaults::receive(const InjectedFaults& faults, std::uint64_t cycle,
                                                   std::span<const JointCommand> commands) noexcept {
  const FaultKind left = fault_of(faults, FaultComponent::kLeftMotor);
  const FaultKind right = fault_of(faults, FaultComponent::kRightMotor);
  const auto healthy = [](const Motors& side, FaultKind kind) {
    return kind == FaultKind::kOk && side.kind == FaultKind::kOk;
  };
  if (healthy(left_, left) && healthy(right_, right)) return commands;
  std::copy(commands.begin(), commands.end(), received_.begin());
  step(left_, left, cycle);
  step(right_, right, cycle);
  return {received_.data(), commands.size()};
}

double MotorFaults::effort(std::size_t joint, JointMode mode, double effort, double position,
                           double velocity) noexcept {
  Drive& drive = drives_[joint];
  switch (drive.state) {
    case State::kHealthy:
      return effort;
    case State::kDead:
      return 0;
    case State::kRandom:
      return drive.random_effort;
    case State::kReversed:
      return mode == JointMode::kBrake ? effort : -effort;
    case State::kBlocked:
      if (!drive.anchored) drive.anchor = position;
      drive.anchored = true;
      return drive.stiffness * (drive.anchor - position) - drive.damping * velocity;
  }
  return 0;
}

}  // namespace robot_control
