#pragma once
/// Accepted live values are written to the parameter server as overrides of this node. `rosparam get` then shows the
/// values in force, and the node reads them when it is started again (overlays.h). They stay in roscore after the end
/// of the node, as all overrides do.

#include <string>
#include <vector>

#include "configuration/live_parameters.h"

namespace robot_control {

/// Writes "pid_kp" to ~pid_kp, "feed_forward.mass" to ~feed_forward/mass. Returns "", or which values could not be
/// written and why. It waits for the master.
std::string write_overrides(const std::vector<LiveValue>& values);

}  // namespace robot_control
