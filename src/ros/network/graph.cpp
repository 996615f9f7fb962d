#include "ros/network/graph.h"

#include <ros/master.h>
#include <ros/this_node.h>

#include <algorithm>

namespace robot_control {

namespace {

/// Returns the master's lists [[topic, [node, …]], …], first that of publishers, then that of subscribers.
std::optional<XmlRpc::XmlRpcValue> system_state(Unanswered then) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  request[0] = ros::this_node::getName();
  const bool repeat = then == Unanswered::kRepeat;
  if (!ros::master::execute("getSystemState", request, response, state, repeat)) return std::nullopt;
  return state;
}

std::vector<std::string> nodes_of(XmlRpc::XmlRpcValue& list, const std::vector<std::string>& topics) {
  std::vector<std::string> nodes;
  for (int i = 0; i < list.size(); ++i) {
    if (std::ranges::find(topics, static_cast<std::string>(list[i][0])) == topics.end()) continue;
    for (int j = 0; j < list[i][1].size(); ++j) nodes.push_back(list[i][1][j]);
  }
  return nodes;
}

}  // namespace

std::vector<std::string> publishers_of(const std::vector<std::string>& topics, Unanswered then) {
  auto state = system_state(then);
  return state ? nodes_of((*state)[0], topics) : std::vector<std::string>();
}

std::string uri_of(const std::string& node) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue uri;
  request[0] = ros::this_node::getName();
  request[1] = node;
  const bool known = ros::master::execute("lookupNode", request, response, uri, false);
  return known && uri.getType() == XmlRpc::XmlRpcValue::TypeString ? static_cast<std::string>(uri) : "";
}

std::optional<std::vector<std::string>> publishers_known_to_reach(const std::string& topic) {
  auto state = system_state(Unanswered::kNone);
  if (!state) return std::nullopt;
  const std::vector<std::string> subscribers = nodes_of((*state)[1], {topic});
  if (std::ranges::find(subscribers, ros::this_node::getName()) == subscribers.end()) return std::nullopt;
  return nodes_of((*state)[0], {topic});
}

}  // namespace robot_control
