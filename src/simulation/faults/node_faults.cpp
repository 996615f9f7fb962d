#include "simulation/faults/node_faults.h"

#include <cmath>
#include <limits>

namespace robot_control {
namespace {

double garbage(FaultRandom& random) noexcept {
  const double choice = random.unit();
  if (choice < 0.125) return std::numeric_limits<double>::quiet_NaN();
  if (choice < 0.25) return std::copysign(std::numeric_limits<double>::infinity(), choice - 0.1875);
  return random.within(kGarbage);
}

/// Returns a random number of 0 … count − 1.
std::uint64_t pick(FaultRandom& random, double count) noexcept {
  return static_cast<std::uint64_t>(random.unit() * count);
}

void negate(Vector3& vector) noexcept {
  for (double& entry : vector) entry = -entry;
}

}  // namespace

void distort(FaultKind kind, StateFrame& state, FaultRandom& random) noexcept {
  if (kind == FaultKind::kWrong) {
    negate(state.base.pose_odom.position);
    negate(state.base.twist_base.linear);
    negate(state.base.twist_base.angular);
    return;
  }
  for (double& entry : state.base.pose_odom.position) entry = garbage(random);
  for (double& entry : state.base.pose_odom.orientation) entry = garbage(random);
  for (double& entry : state.base.twist_base.linear) entry = garbage(random);
  for (double& entry : state.base.twist_base.angular) entry = garbage(random);
  for (double& entry : state.base.gyro_bias) entry = garbage(random);
}

void distort(FaultKind kind, CommandFrame& command, FaultRandom& random) noexcept {
  constexpr double kModes = 6;  // the last one is unknown
  for (std::size_t i = 0; i < command.joint_count && i < kMaxJoints; ++i) {
    JointCommand& joint = command.joints[i];
    if (kind == FaultKind::kWrong) {
      joint.effort = -joint.effort;
      joint.velocity = -joint.velocity;
      joint.position = -joint.position;
      continue;
    }
    joint = {.mode = static_cast<JointMode>(pick(random, kModes)),
             .position = garbage(random),
             .velocity = garbage(random),
             .stiffness = garbage(random),
             .damping = garbage(random),
             .effort = garbage(random)};
  }
}

void distort(FaultKind kind, Permit& permit, FaultRandom& random) noexcept {
  constexpr double kActions = 4;  // one of them unknown
  constexpr double kStates = 6;
  constexpr double kAnyCauses = 4096;
  if (kind == FaultKind::kWrong) {
    const bool drives = permit.action == PermitAction::kDrive;
    permit.action = drives ? PermitAction::kBrake : PermitAction::kDrive;
    permit.state = drives ? SupervisorState::kReady : SupervisorState::kDrive;
    permit.causes = permit.active = permit.first_cause = 0;
    return;
  }
  permit.action = static_cast<PermitAction>(pick(random, kActions));
  permit.state = static_cast<SupervisorState>(pick(random, kStates));
  permit.causes = pick(random, kAnyCauses);
  permit.active = pick(random, kAnyCauses);
}

}  // namespace robot_control
