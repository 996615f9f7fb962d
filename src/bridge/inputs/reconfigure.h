#pragma once
/// dynamic_reconfigure's view of the live parameters: flat names, plain numbers, a range of each. Pure.
///
/// `feed_forward.mass` is `feed_forward_mass` here, as in run.csv. A value that is left out, and so derived, is shown
/// as the number that holds (of the first wheel, where wheels differ); setting it fixes it.

#include <string>
#include <vector>

#include "bridge/messages/reconfigure_messages.h"
#include "parameters/live_parameters.h"

namespace robot_control {

/// `parameters`: in force, derived values filled in (runtime/retuning.h).
msg::Config config_of(const std::vector<LiveParameter>& parameters);

/// One group, "Default"; `parameters` are those of the start.
msg::ConfigDescription description_of(const std::vector<LiveParameter>& parameters);

/// The request as the text of a YAML map for ~set_parameter_map; empty: it names no value. A name that is none of the
/// parameters' goes into it as it is, so that it is refused with the others' problems.
std::string request_text(const msg::Config& request, const std::vector<LiveParameter>& parameters);

}  // namespace robot_control
