#pragma once
/// These functions ask the ROS master for publishers.

#include <optional>
#include <string>
#include <vector>

namespace robot_control {

/// It names what follows if the master does not answer.
enum class Unanswered { kNone, kRepeat };

/// Returns the nodes that publish any of these topics (resolved names). If the master does not answer, returns none, or
/// asks again until it does (kRepeat).
std::vector<std::string> publishers_of(const std::vector<std::string>& topics, Unanswered then = Unanswered::kNone);

/// Returns the address of a node's XML-RPC server; "" if the master does not answer or does not know the node.
std::string uri_of(const std::string& node);

/// Returns the nodes that publish this topic (resolved name). Returns nothing if the master does not answer or does not
/// know this node as a subscriber. A restarted master knows neither this node nor the publishers.
std::optional<std::vector<std::string>> publishers_known_to_reach(const std::string& topic);

}  // namespace robot_control
