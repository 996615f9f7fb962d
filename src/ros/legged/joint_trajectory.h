#pragma once
/// A JointTrajectory is a message of `joint_trajectory` that was checked, as a path of all joints over time. It is
/// pure.
///
///   start    where the joints are when the message arrives, at rest, at time 0
///   points   the joints that the message names are there at time_from_start; the others stay at the start
///   between  the cubic with the points' positions and velocities, or a straight line where the next point has none
///   after    the last point
///
/// A message is refused in the following cases. Accelerations are not used.
///
///   joints   none, an unknown one, or one that is named twice
///   numbers  not one position for each joint; velocities or accelerations that are neither missing nor one for each
///            joint; efforts; NaN and infinity
///   times    those that do not grow; a point at time 0 that is not the start
///   path     it leaves a joint's range, or is faster than the joint may be (joint_bounds)

#include <trajectory_msgs/JointTrajectory.h>

#include <string>
#include <vector>

#include "control/legged/leg_controller.h"
#include "machine/legs/leg_model.h"
#include "ros/messages/bounded_message.h"
#include "ros/network/wire_guard.h"

namespace robot_control {

using BoundedJointTrajectory = Bounded<trajectory_msgs::JointTrajectory, 24, kMaxMessage>;

class JointTrajectory {
 public:
  using Positions = LegsValues;  ///< rad, in the order of MachineModel::joints

  /// Reads a message with at least one point. Returns "", or why it is refused; then the path is as before.
  std::string read(const trajectory_msgs::JointTrajectory& message, const LegModel& robot, const Positions& start);

  /// Returns where the joints are at this time in s.
  Positions at(double time) const;

  /// Returns the time of the last point in s.
  double duration() const { return points_.back().time; }

 private:
  struct Point {
    double time = 0;  ///< s
    Positions positions{};
    Positions arriving{};  ///< rad/s, of the path to this point
    Positions leaving{};   ///< rad/s, of the path from this point
  };

  std::vector<Point> points_{Point{}};  ///< the first is the start
};

}  // namespace robot_control
