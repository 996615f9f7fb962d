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

/// `parameters` are the ones in force, with derived values filled in (robots/wheeled/retuning.h).
dynamic_reconfigure::Config config_of(const std::vector<LiveParameter>& parameters);

/// Returns a description with one group, "Default"; `parameters` are those of the start.
dynamic_reconfigure::ConfigDescription description_of(const std::vector<LiveParameter>& parameters);

/// Returns the request as the text of a YAML map for ~set_parameter_map; "" if it names no value. An unknown name is
/// copied unchanged, so that it is refused together with all other problems.
std::string request_text(const dynamic_reconfigure::Config& request, const std::vector<LiveParameter>& parameters);

}  // namespace robot_control
