#pragma once
/// state_estimator: joint_states, odom, wheel_odom, imu/data, tf; services reset_odometry, set_odometry; the
/// calibration file.

#include <memory>

#include "bridge/nodes/node.h"
#include "signals/state_frame.h"

namespace robot_control {

std::unique_ptr<Node> make_state_estimator(const Setup& setup);

}  // namespace robot_control
