#pragma once
/// A command says which feet swing. A walk gives stiffness to the joints of feet in the air alone. Feet that bear are
/// commanded by torques.

#include <cstddef>

#include "signals/command_frame.h"

namespace robot_control {

/// Returns whether a robot walks by this command, which holds angles or torques for this joint; null: no command.
inline bool walks_by(const CommandFrame* command, std::size_t joint) noexcept {
  return command != nullptr && command->legged.phase == LegPhase::kWalking &&
         command->joints[joint].mode == JointMode::kImpedance;
}

/// Returns whether the joint's foot is in the air.
inline bool commanded_to_swing(const CommandFrame* command, std::size_t joint) noexcept {
  return walks_by(command, joint) && command->joints[joint].stiffness > 0;
}

}  // namespace robot_control
