#pragma once
/// The command that the drive wheels of a robot take.

#include "parameters/block.h"

namespace robot_control {

enum class WheelCommand {
  kTorque,    ///< Our wheel loops compute torques (JointMode::kEffort).
  kVelocity,  ///< The drives close the loops of their speeds (JointMode::kDriveVelocity).
};

inline std::vector<Word> words_of(WheelCommand) {
  return {{"torque", WheelCommand::kTorque}, {"velocity", WheelCommand::kVelocity}};
}

}  // namespace robot_control
