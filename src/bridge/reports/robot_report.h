#pragma once
/// The plant's log line about its robot. Pure.

#include <string>

#include "robot/robot_model.h"

namespace robot_control {

/// "robot 'jackal' of jackal.urdf: left wheels a, b, right wheels c, d, radius 0.098 m, wheel base 0.376 m (effective
/// 0.56 m), 18.43 kg"
std::string summary(const RobotModel& robot);

/// "assumed: <link name="base">: text"
std::string sentence(const RobotNote& note);

/// Something was repaired, overridden or is suspicious.
bool needs_a_look(const RobotNote& note);

}  // namespace robot_control
