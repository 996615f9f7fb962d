#pragma once
/// telemetry writes every cycle of the four nodes to run.bag. Its only topic is /diagnostics, its service
/// ~record.

#include <memory>

#include "ros/nodes/node.h"

namespace robot_control {

std::unique_ptr<Node> make_telemetry(const Setup& setup);

}  // namespace robot_control
