#pragma once
/// The node slam builds a map while the robot drives. Topics, actions and services: docs/interfaces.md.

#include <memory>

#include "ros/nodes/node.h"

namespace robot_control::navigation {

std::unique_ptr<Node> make_slam(const Setup& setup);

}  // namespace robot_control::navigation
