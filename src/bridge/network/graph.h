#pragma once
/// Questions to the ROS master.

#include <optional>
#include <string>
#include <vector>

namespace robot_control {

/// Nodes that publish any of these topics (resolved names); empty when the master does not answer.
std::vector<std::string> publishers_of(const std::vector<std::string>& topics);

/// Of this node's XML-RPC server; empty when the master does not answer, or does not know the node.
std::string uri_of(const std::string& node);

/// Nodes that publish this topic (resolved name), from a master that knows this node as its subscriber. None: it does
/// not answer, or does not know this node, as after its restart; then it does not know the others either.
std::optional<std::vector<std::string>> publishers_known_to_reach(const std::string& topic);

}  // namespace robot_control
