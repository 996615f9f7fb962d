#pragma once
/// A stop action is how one joint is stopped while the gate passes no command. The robot's kind chooses it for each
/// joint and derives its parameters from the machine. The gate orders it, and the driver carries it out:
///
///   kBrake  JointMode::kBrake: the driver's own law damps the velocity and, below a small speed, holds the position
///           (brake_law.h)
///   kCoast  τ = 0: friction alone stops the joint, and a load moves it
///   kDamp   τ = −damping · q̇: a load moves the joint slowly
///
/// A driver that cannot carry out an action says so (Driver::implements), and the loop does not start.

#include <vector>

#include "parameters/block.h"
#include "signals/joint.h"

namespace robot_control {

enum class StopKind { kBrake, kCoast, kDamp };

inline std::vector<Word> words_of(StopKind) {
  return {{"brake", StopKind::kBrake}, {"coast", StopKind::kCoast}, {"damp", StopKind::kDamp}};
}

struct StopAction {
  StopKind kind = StopKind::kBrake;
  double damping = 0;  ///< N·m·s/rad or N·s/m, ≥ 0; kDamp
};

/// Returns the command by which the gate orders the action.
inline JointCommand order_of(const StopAction& action) noexcept {
  switch (action.kind) {
    case StopKind::kCoast:
      return {.mode = JointMode::kEffort};
    case StopKind::kDamp:
      return {.mode = JointMode::kVelocity, .damping = action.damping};
    case StopKind::kBrake:
      break;
  }
  return {.mode = JointMode::kBrake};
}

}  // namespace robot_control
