#pragma once
/// Private parameters of a node.

#include <ros/ros.h>

#include <stdexcept>
#include <string>

namespace robot_control::navigation {

/// Returns the parameter ~name, or `otherwise` where it is not set. Throws std::runtime_error for one of another type,
/// which ROS takes for one that is not set; `what` says what it must be.
template <class T>
T own_parameter(const std::string& name, T otherwise, const char* what) {
  const ros::NodeHandle own("~");
  if (own.hasParam(name) && !own.getParam(name, otherwise)) throw std::runtime_error("~" + name + " must be " + what);
  return otherwise;
}

}  // namespace robot_control::navigation
