#pragma once
/// How a drive that closes the loop of its own speed carries out JointMode::kBrake. It takes the speed zero with its
/// own loop, and then does what its description says. The driver sends the speed zero, never an old one, whatever
/// follows.

#include <vector>

#include "parameters/block.h"

namespace robot_control {

enum class DriveBrake {
  kHold,     ///< At rest the loop stays closed at the speed zero: the robot stays on a slope.
  kRelease,  ///< At rest the motor gets no current: only friction or a mechanical brake holds the robot.
};

inline std::vector<Word> words_of(DriveBrake) {
  return {{"hold", DriveBrake::kHold}, {"release", DriveBrake::kRelease}};
}

}  // namespace robot_control
