#pragma once
/// telemetry: every cycle of the four nodes → run.bag and run.csv. No topics but /diagnostics; service ~record.

#include <memory>

#include "bridge/nodes/node.h"

namespace robot_control {

std::unique_ptr<Node> make_telemetry(const Setup& setup);

}  // namespace robot_control
