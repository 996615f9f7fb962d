#pragma once
/// The user's parameters of the gate, and the limits of the machine's joints.

#include <cstdint>
#include <limits>

#include "parameters/block.h"

namespace robot_control {

/// The command of the wheels while the gate brakes.
enum class FailAction {
  kBrake,  ///< the driver's brake: damped, then held
  kCoast,  ///< no torque: the robot rolls until friction stops it, and on a slope it rolls away
};

inline std::vector<Word> words_of(FailAction) {
  return {{"brake", FailAction::kBrake}, {"coast", FailAction::kCoast}};
}

struct GateParameters {
  FailAction fail_action = FailAction::kBrake;
  std::uint64_t longest_ramp = 2020;  ///< cycles in a row under ramp permits: ramp_time, and loss_cycles beyond it
};

/// Limits of one joint. Beside each stands what it is where nothing is known.
struct JointLimits {
  double effort = 0;                                             ///< N·m or N, ≥ 0; 0: no torque at all
  double effort_rate = std::numeric_limits<double>::infinity();  ///< N·m/s or N/s, > 0
  double velocity = std::numeric_limits<double>::infinity();     ///< rad/s or m/s, > 0
  double lower = -std::numeric_limits<double>::infinity();       ///< rad or m, end stop
  double upper = std::numeric_limits<double>::infinity();        ///< rad or m, end stop, > lower
  double soft_zone = 0;                                          ///< rad or m before either end stop, ≥ 0
  bool wheel = false;                                            ///< GateParameters::fail_action applies
};

}  // namespace robot_control
