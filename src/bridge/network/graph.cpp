#include "bridge/network/graph.h"

#include <ros/master.h>
#include <ros/this_node.h>

#include <algorithm>

namespace robot_control {

std::vector<std::string> publishers_of(const std::vector<std::string>& topics) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  request[0] = ros::this_node::getName();
  std::vector<std::string> nodes;
  if (!ros::master::execute("getSystemState", request, response, state, false)) return nodes;
  XmlRpc::XmlRpcValue& published = state[0];  // [[topic, [node, …]], …]
  for (int i = 0; i < published.size(); ++i) {
    if (std::ranges::find(topics, static_cast<std::string>(published[i][0])) == topics.end()) continue;
    for (int j = 0; j < published[i][1].size(); ++j) nodes.push_back(published[i][1][j]);
  }
  return nodes;
}

}  // namespace robot_control
