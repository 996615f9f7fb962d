#pragma once
/// Parameter server → overlays on the YAML file.
///
/// `robot/rate` (relative to the namespace) lies over `robot.rate`, the private `~pid_kp` of a node over
/// `<node's block>.pid_kp`. Every key found becomes an overlay: whether it exists is the schema's to judge, so
/// that a typo on the server is refused like one in the file.

#include <string>
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

}  // namespace robot_control
