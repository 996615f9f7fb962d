#include "safety/measurements/wheel_targets.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

void WheelTargets::step(const MonitorInput& input) noexcept {
  passed_ = input.sensors->gate.verdict != GateVerdict::kBrake;
  if (input.command == nullptr) return;
  motion_ = false;
  const std::size_t commanded = std::min<std::size_t>(wheels_, input.command->joint_count);
  for (std::size_t i = 0; i < wheels_; ++i) {
    const JointCommand& joint = input.command->joints[i];
    has_[i] = i < commanded && joint.mode != JointMode::kBrake && std::isfinite(joint.velocity);
    velocity_[i] = has_[i] ? joint.velocity : 0;
    motion_ = motion_ || velocity_[i] != 0;
  }
}

}  // namespace robot_control
