#pragma once
/// These functions translate the words of the service inject_fault. A component's word is one of kFaultComponentNames.
/// Before "encoder" and "motor" stands the name of a driven or held joint, or of a group of joints
/// (MachineModel::groups): "left_encoder", "left_wheel_joint_motor". A group with the name of such a joint has no word:
/// its joints are named one by one. All functions allocate.

#include <string>
#include <string_view>
#include <vector>

#include "machine/machine_model.h"
#include "signals/injected_fault.h"

namespace robot_control {

/// Returns all words of components: those that exist once, those of groups, and those of each driven or held joint.
std::vector<std::string> fault_words(const MachineModel& machine);

/// Returns the components that a word names, each of them healthy; empty for an unknown word.
std::vector<InjectedFault> components_of(const MachineModel& machine, std::string_view word);

/// Sets the faults that two words name and returns "". If a word is unknown, or the list of faults has no room, changes
/// nothing and returns the problem with its remedy.
std::string set_fault(InjectedFaults& faults, const MachineModel& machine, std::string_view component,
                      std::string_view kind);

/// Returns "left_encoder stuck, gyro off", or "none". A group is named where each of its joints has the same fault.
std::string names_of(const InjectedFaults& faults, const MachineModel& machine);

}  // namespace robot_control
