#pragma once
/// state_estimator: joint_states, odom, tf; service reset_odometry.

#include <memory>

#include "bridge/node.h"

namespace robot_control {

std::unique_ptr<Node> make_state_estimator(const Setup& setup);

}  // namespace robot_control
