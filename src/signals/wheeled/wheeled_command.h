#pragma once
/// A WheeledCommand is the part of the command that only machines on wheels have.

#include <array>
#include <cstdint>

#include "signals/wheeled/wheel_count.h"

namespace robot_control {

/// Bits 18 and 19 of CommandFrame::reasons.
enum WheeledReason : std::uint64_t {
  kReasonCurvatureKept = 1u << 18,  ///< One axis was scaled to keep the commanded curvature.
  kReasonSaturated = 1u << 19,      ///< A wheel's torque or speed is at its limit.
};

struct WheeledCommand {
  std::array<double, kMaxWheels> velocity{};  ///< rad/s, by the tracking loops of the wheel loops
};

}  // namespace robot_control
