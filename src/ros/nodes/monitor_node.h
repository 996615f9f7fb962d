#pragma once
/// The monitor subscribes to e_stop, heartbeat and clearance, publishes safety_status (latched), and has the
/// services e_stop_trigger and e_stop_reset.

#include <memory>

#include "ros/nodes/node.h"
#include "signals/permit.h"

namespace robot_control {

std::unique_ptr<Node> make_monitor(const Setup& setup);

}  // namespace robot_control
