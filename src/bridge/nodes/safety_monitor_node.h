#pragma once
/// safety_monitor: e_stop, heartbeat, clearance in; safety_status (latched) out; services e_stop_trigger, e_stop_reset.

#include <memory>

#include "bridge/nodes/node.h"
#include "signals/permit.h"

namespace robot_control {

std::unique_ptr<Node> make_safety_monitor(const Setup& setup);

}  // namespace robot_control
