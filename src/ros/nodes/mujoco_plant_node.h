#pragma once
/// mujoco_plant publishes imu/data_raw, ground_truth/odom and, in lockstep, /clock, and sets robot_description. It has
/// the services ~set_pause, ~step, ~reset and ~inject_fault.

#include <memory>

#include "ros/nodes/node.h"

namespace robot_control {

/// The node publishes robot_description after it has taken the locks and before its first frame.
std::unique_ptr<Node> make_mujoco_plant(const Setup& setup);

}  // namespace robot_control
