#pragma once
/// The estimator publishes joint_states, odom, wheel_odom, imu/data and tf. It has the services reset_odometry and
/// set_odometry, and writes the calibration file.

#include <memory>

#include "ros/nodes/node.h"
#include "signals/state_frame.h"

namespace robot_control {

std::unique_ptr<Node> make_estimator(const Setup& setup);

}  // namespace robot_control
