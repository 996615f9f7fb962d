#pragma once
/// Accepted live values → this node's overrides on the parameter server: `rosparam get` shows the values in force, and
/// a node that is started again reads them as any override (overlays.h). They outlive the node in roscore, as those do.

#include <string>
#include <vector>

#include "parameters/live_parameters.h"

namespace robot_control {

/// "pid_kp" → ~pid_kp, "feed_forward.mass" → ~feed_forward/mass. Empty, or which of them could not be written, and why.
/// May take as long as the master does.
std::string write_overrides(const std::vector<LiveValue>& values);

}  // namespace robot_control
