#include "ros/inputs/live_overrides.h"

#include <ros/master.h>
#include <ros/param.h>

#include <algorithm>

namespace robot_control {

std::string write_overrides(const std::vector<LiveValue>& values) {
  std::string unwritten;
  for (const LiveValue& value : values) {
    // Without a master ros::param::set would wait for ever. After one failure the remaining values are not tried.
    if (!unwritten.empty() || !ros::master::check()) {
      unwritten += (unwritten.empty() ? "" : ", ") + value.key;
      continue;
    }
    std::string name = "~" + value.key;
    std::ranges::replace(name, '.', '/');
    std::visit([&name](auto plain) { ros::param::set(name, plain); }, value.value);
  }
  if (unwritten.empty()) return "";
  return "the parameter server does not know " + unwritten + ": no ROS master answers";
}

}  // namespace robot_control
