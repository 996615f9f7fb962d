#pragma once
/// A WheeledCommand is the part of the command that only machines on wheels have.

#include <array>
#include <cstdint>

#include "signals/wheeled/wheel_count.h"

namespace robot_control {

/// The bits below belong to CommandReason, so that one number holds both.
inline constexpr unsigned kFirstWheeledReason = 18;

/// Bits of WheeledCommand::reasons.
enum WheeledReason : std::uint64_t {
  kReasonCurvatureKept = 1u << kFirstWheeledReason,    ///< One axis was scaled to keep the commanded curvature.
  kReasonSaturated = 1u << (kFirstWheeledReason + 1),  ///< A wheel's torque or speed is at its limit.
};
inline constexpr std::uint64_t kWheeledReasons = kReasonCurvatureKept | kReasonSaturated;

struct WheeledCommand {
  std::uint64_t reasons = 0;                  ///< WheeledReason bits
  std::array<double, kMaxWheels> velocity{};  ///< rad/s, by the tracking loops of the wheel loops
};

}  // namespace robot_control
