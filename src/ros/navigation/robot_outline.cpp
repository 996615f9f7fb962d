#include "ros/navigation/robot_outline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace robot_control::navigation {
namespace {

constexpr const char* kDescription = "robot_description";

RigidBodies described(const ros::NodeHandle& handle) {
  std::string urdf;
  handle.getParam(kDescription, urdf);
  return read_rigid_bodies({urdf, handle.resolveName(kDescription)});
}

}  // namespace

Footprint described_footprint(const ros::NodeHandle& handle) {
  return footprint_of(described(handle));
}

RobotOutline::RobotOutline(ros::NodeHandle& handle) : outline_(described(handle)) {
  if (outline_.changes()) joints_.connect(handle, [this](const sensor_msgs::JointState& message) { receive(message); });
}

std::vector<std::string> RobotOutline::missing() {
  const ros::NodeHandle handle;
  if (handle.hasParam(kDescription)) return {};
  return {handle.resolveName(kDescription) + ": start the robot"};
}

void RobotOutline::receive(const sensor_msgs::JointState& message) {
  std::map<std::string, double> positions;
  for (std::size_t i = 0; i < std::min(message.name.size(), message.position.size()); ++i) {
    if (std::isfinite(message.position[i])) positions[message.name[i]] = message.position[i];
  }
  try {
    outline_.update(positions, ros::SteadyTime::now().toSec());
  } catch (const std::invalid_argument& error) {  // the base lies beside such an outline
    ROS_WARN_THROTTLE(10, "joint_states: %s", error.what());
  }
}

}  // namespace robot_control::navigation
