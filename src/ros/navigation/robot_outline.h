#pragma once
/// The outline of the robot, by `robot_description` and, with legs or an arm, `joint_states`.

#include <sensor_msgs/JointState.h>

#include <string>
#include <vector>

#include "navigation/moving_outline.h"
#include "ros/navigation/bounded_inputs.h"

namespace robot_control::navigation {

/// Returns the outline of `robot_description`, with every joint at zero. Throws what footprint_of_urdf throws.
Footprint described_footprint(const ros::NodeHandle& handle);

class RobotOutline {
 public:
  /// Throws what footprint_of_urdf throws.
  explicit RobotOutline(ros::NodeHandle& handle);

  /// Returns what a node waits for before it is constructed.
  static std::vector<std::string> missing();

  const Footprint& footprint() const noexcept { return outline_.footprint(); }

 private:
  void receive(const sensor_msgs::JointState& message);

  MovingOutline outline_;
  InputTopic<BoundedJointState> joints_{"joint_states", 1};
};

}  // namespace robot_control::navigation
