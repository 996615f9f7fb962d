#pragma once
/// Questions to the ROS master.

#include <string>
#include <vector>

namespace robot_control {

/// Nodes that publish any of these topics (resolved names); empty when the master does not answer.
std::vector<std::string> publishers_of(const std::vector<std::string>& topics);

}  // namespace robot_control
