#pragma once
/// All inputs of one step of a controller.

#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// Holds the inputs of one cycle. A null pointer is an input that is not available in this cycle.
struct ControlInput {
  const SensorFrame* sensors = nullptr;  ///< never null
  const StateFrame* state = nullptr;
  const Permit* permit = nullptr;  ///< the newest unexpired one ≤ k-1
  VelocityCommand request;         ///< the inbox; a new message is one with a new count
};

}  // namespace robot_control
