#pragma once
/// Stop causes in words: the condition, its remedy, and the role that can apply it. A latched cause needs e_stop_reset
/// after its remedy. If the remedy is empty, it needs only e_stop_reset.
///
///   operator     drives the robot
///   integrator   sets the robot up: nodes, parameters, URDF, network
///   technician   repairs the machine: sensors, motors, cables, battery

#include <array>

#include "signals/bit_name.h"
#include "signals/permit.h"

namespace robot_control {

// clang-format off
inline constexpr auto kStopCauseNames = std::to_array<BitName>({
#define CAUSE(id, name, sentence, remedy, actor, unit, ...) {kCause##id, #name, sentence, remedy, actor, unit},
#include "signals/stop_causes.def"
});
// clang-format on

}  // namespace robot_control
