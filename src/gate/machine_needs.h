#pragma once
/// A robot kind needs modes of commands and inputs of its machine. A driver declares those that it has.

#include <cstdint>
#include <vector>

#include "signals/joint.h"

namespace robot_control {

enum class MachineInput : std::uint8_t {
  kJointMotion,  ///< position and velocity of each joint (kValidKinematics)
  kJointEffort,  ///< effort of each joint (kValidEffort)
  kImu,          ///< angular velocity and linear acceleration
  kContacts,     ///< forces of contacts
};

struct MachineNeeds {
  std::vector<JointMode> modes{};  ///< of the commands of its controller; its stop profiles have their own
  std::vector<MachineInput> inputs{};
};

}  // namespace robot_control
