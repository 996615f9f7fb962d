#pragma once
/// telemetry: every cycle of the four nodes → run.csv. No topics but /diagnostics.

#include <memory>

#include "bridge/nodes/node.h"

namespace robot_control {

std::unique_ptr<Node> make_telemetry(const Setup& setup);

}  // namespace robot_control
