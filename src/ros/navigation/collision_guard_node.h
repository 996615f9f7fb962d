#pragma once
/// The node collision_guard publishes `clearance` and `guard_state` from the lasers, for every sender of motion.
/// Topics: docs/interfaces.md.
///
/// The clearance is published at each odom. It is 0 while a laser or odom is not trusted, and also by the monitor once
/// this node has fallen silent. The mode `off` publishes ∞ once.

#include <memory>

#include "ros/nodes/node.h"

namespace robot_control::navigation {

std::unique_ptr<Node> make_collision_guard(const Setup& setup);

}  // namespace robot_control::navigation
