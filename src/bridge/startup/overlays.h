#pragma once
/// Parameter server → overlays on the YAML file.
///
/// `robot/rate` (relative to the namespace) lies over `robot.rate`, the private `~pid_kp` of a node over
/// `<node's block>.pid_kp`. Every key found becomes an overlay: whether it exists is the schema's to judge, so
/// that a typo on the server is refused like one in the file. An empty text is none: launch files set every argument,
/// and the one that was not given is "".

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "parameters/parameters.h"

namespace XmlRpc {
class XmlRpcValue;
}

namespace robot_control {

/// All leaves of `tree`, a list being one: path "block.key", origin "<server_name>/key". Keys in `ignored` are left
/// out.
std::vector<Overlay> overlays_of(const XmlRpc::XmlRpcValue& tree, const std::string& block,
                                 const std::string& server_name, const std::vector<std::string>& ignored = {});

/// What is set on the server as `name`, empty where nothing is: a text, or true or false. Throws ParameterError where
/// it is anything else; ros::param::get() would return as if nothing were set. `what` it is: "the path of a YAML file".
std::string text_parameter(const XmlRpc::XmlRpcValue& value, const std::string& name, const std::string& what);
bool truth_parameter(const XmlRpc::XmlRpcValue& value, const std::string& name);

/// Names of environment variables in which a launch file lists the paths that it overrides itself, between spaces:
/// "robot.clock robot.wait_for_nodes". They reach the nodes of that launch alone, unlike parameters, which stay.
inline constexpr std::string_view kSetByLaunch = "ROBOT_CONTROL_SET_BY_";

/// The paths in all of these variables of `environment` ("NAME=value", as environ(7) has them).
std::set<std::string> set_by_launch(const char* const* environment);

/// "/robot/rate = 500 overrides robot.rate of config/robot_params.yaml", a line each; without those of `unsaid`.
std::vector<std::string> override_lines(const std::vector<Overlay>& overlays, const std::string& file,
                                        const std::set<std::string>& unsaid = {});

}  // namespace robot_control
