#pragma once
/// These functions write the plant's log lines about its robot. They are pure.

#include <string>

#include "machine/machine_model.h"

namespace robot_control {

/// Returns "robot 'quadbot' of quadbot.urdf: four legs of 0.426 m, 12.7 kg".
std::string summary(const MachineModel& robot);

/// Returns "assumed: <link name="base">: text".
std::string sentence(const RobotNote& note);

/// Returns whether the note says that something was repaired or overridden, or is suspicious.
bool needs_a_look(const RobotNote& note);

}  // namespace robot_control
