#pragma once
/// The node navigate plans a path to a goal and monitors it. Topics, actions and services: docs/interfaces.md.

#include <memory>

#include "ros/nodes/node.h"

namespace robot_control::navigation {

std::unique_ptr<Node> make_navigate(const Setup& setup);

}  // namespace robot_control::navigation
