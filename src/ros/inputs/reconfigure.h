#pragma once
/// These functions show the live parameters to dynamic_reconfigure as flat names, plain numbers and ranges. They are
/// pure.
///
/// `feed_forward.mass` is named `feed_forward_mass`, as in a log. A value that is left out is derived, and shown as
/// the derived number (that of the first wheel if wheels differ). Setting it replaces the derived number.

#include <dynamic_reconfigure/ConfigDescription.h>

#include <string>
#include <vector>

#include "configuration/live_parameters.h"

namespace robot_control {

/// Accepted live values are written to the parameter server as overrides of this node. `rosparam get` then shows the
/// values in force, and the node reads them when it is started again (overlays.h). They stay in roscore after the end
/// of the node, as all overrides do.
///
/// Writes "pid_kp" to ~pid_kp, "feed_forward.mass" to ~feed_forward/mass. Returns "", or which values could not be
/// written and why. It waits for the master.
std::string write_overrides(const std::vector<LiveValue>& values);

/// `parameters` are the ones in force, with derived values filled in (robots/wheeled/retuning.h).
dynamic_reconfigure::Config config_of(const std::vector<LiveParameter>& parameters);

/// Returns a description with one group, "Default"; `parameters` are those of the start.
dynamic_reconfigure::ConfigDescription description_of(const std::vector<LiveParameter>& parameters);

/// Returns the request as the text of a YAML map for ~set_parameter_map; "" if it names no value. An unknown name is
/// copied unchanged, so that it is refused together with all other problems.
std::string request_text(const dynamic_reconfigure::Config& request, const std::vector<LiveParameter>& parameters);

}  // namespace robot_control
