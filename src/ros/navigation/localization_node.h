#pragma once
/// The node localization finds the robot in a saved map. Topics, actions and services: docs/interfaces.md.

#include <memory>

#include "ros/nodes/node.h"

namespace robot_control::navigation {

std::unique_ptr<Node> make_localization(const Setup& setup);

}  // namespace robot_control::navigation
