#pragma once
/// The monitor of a robot on wheels.

#include "safety/conditions/wheeled/wheeled_conditions.h"
#include "safety/monitor.h"

namespace robot_control {

using SafetyMonitor = Monitor<WheeledConditions>;

}  // namespace robot_control
