#pragma once
/// The parameters of the gate, and the limits of the machine's joints.

#include <cstdint>
#include <limits>
#include <vector>

#include "gate/stop_action.h"

namespace robot_control {

struct GateParameters {
  std::vector<StopProfile> profiles = {};  ///< by CommandFrame::stop_profile; empty: one in which every joint brakes
  std::uint64_t longest_ramp = 2020;       ///< cycles in a row under ramp permits: ramp_time, and loss_cycles beyond it
};

/// Limits of one joint. Beside each stands what it is where nothing is known.
struct JointLimits {
  double effort = 0;                                              ///< N·m or N, ≥ 0; 0: no torque at all
  double effort_rate = std::numeric_limits<double>::infinity();   ///< N·m/s or N/s, > 0
  double velocity = std::numeric_limits<double>::infinity();      ///< rad/s or m/s, > 0
  double acceleration = std::numeric_limits<double>::infinity();  ///< rad/s² or m/s², > 0, of a kDriveVelocity command
  double lower = -std::numeric_limits<double>::infinity();        ///< rad or m, end stop
  double upper = std::numeric_limits<double>::infinity();         ///< rad or m, end stop, > lower
  double soft_zone = 0;                                           ///< rad or m before either end stop, ≥ 0
};

}  // namespace robot_control
