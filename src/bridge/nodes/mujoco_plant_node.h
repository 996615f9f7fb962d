#pragma once
/// mujoco_plant: imu/data_raw, ground_truth/odom, /clock (lockstep), robot_description; ~set_pause, ~step, ~reset,
/// ~inject_fault.

#include <memory>

#include "bridge/nodes/node.h"

namespace robot_control {

/// Publishes robot_description once it holds the locks and before its first frame.
std::unique_ptr<Node> make_mujoco_plant(const Setup& setup);

}  // namespace robot_control
