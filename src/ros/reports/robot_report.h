#pragma once
/// These functions write the plant's log lines about its robot. They are pure.

#include <string>

#include "machine/legs/leg_model.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Returns "robot 'jackal' of jackal.urdf: left wheels a, b, right wheels c, d, radius 0.098 m, wheel base 0.376 m
/// (effective 0.56 m), 18.43 kg".
std::string summary(const DriveTrain& robot);

/// Returns "robot 'quadbot' of quadbot.urdf: four legs of 0.426 m, 12.7 kg" for a robot on legs, else as above.
std::string summary(const MachineModel& robot);

/// Returns "assumed: <link name="base">: text".
std::string sentence(const RobotNote& note);

/// Returns whether the note says that something was repaired or overridden, or is suspicious.
bool needs_a_look(const RobotNote& note);

}  // namespace robot_control
