#include "bridge/live_overrides.h"

#include <ros/master.h>
#include <ros/param.h>

#include <algorithm>

namespace robot_control {

std::string write_overrides(const std::vector<LiveValue>& values) {
  for (const LiveValue& value : values) {
    // Without a master ros::param::set would wait for one, for ever.
    if (!ros::master::check()) return "the parameter server does not know: no ROS master answers";
    std::string name = "~" + value.key;
    std::ranges::replace(name, '.', '/');
    std::visit([&name](auto plain) { ros::param::set(name, plain); }, value.value);
  }
  return "";
}

}  // namespace robot_control
