#pragma once
/// Converts keys of the parameter server into overlays on the YAML file.
///
/// `robot/rate` (relative to the namespace) overrides `robot.rate`; the private `~pid_kp` of a node overrides `<node's
/// block>.pid_kp`. Every key found becomes an overlay. The schema checks whether the key exists, so a typo on the
/// server is refused like one in the file. An empty text counts as not set, because a launch file sets every argument
/// and "" stands for one that was not given.

#include <set>
#include <string>
#include <vector>

#include "parameters/parameter_tree.h"

namespace XmlRpc {
class XmlRpcValue;
}

namespace robot_control {

/// Returns all leaves of `tree` with path "block.key" and origin "<server_name>/key". A list counts as one leaf. Keys
/// in `ignored` are left out.
std::vector<Overlay> overlays_of(const XmlRpc::XmlRpcValue& tree, const std::string& block,
                                 const std::string& server_name, const std::vector<std::string>& ignored = {});

/// Return the text or truth value that the server holds as `name`; "" or false if it holds none. Throw ParameterError
/// for any other type, for which ros::param::get() would return as if nothing were set. `what` describes the value in
/// that message: "the path of a YAML file".
std::string text_parameter(const XmlRpc::XmlRpcValue& value, const std::string& name, const std::string& what);
bool truth_parameter(const XmlRpc::XmlRpcValue& value, const std::string& name);

/// Returns one line per overlay, "/robot/rate = 500 overrides robot.rate of config/robot_params.yaml". Keys in
/// `unsaid`, without their block, are left out.
std::vector<std::string> override_lines(const std::vector<Overlay>& overlays, const std::string& file,
                                        const std::set<std::string>& unsaid = {});

}  // namespace robot_control
