#pragma once
/// A LeggedCommand is the part of the command that only machines on legs have.

#include <array>
#include <cstdint>

namespace robot_control {

enum class LegPhase : std::uint64_t {
  kLying = 0,
  kGathering = 1,
  kRising = 2,
  kStanding = 3,
  kLowering = 4,
  kJoints = 5,
  kWalking = 6
};

/// Bits 20 to 27 of CommandFrame::reasons.
enum LeggedReason : std::uint64_t {
  kReasonOutOfReach = 1u << 20,   ///< The pose is beyond the ranges of the legs.
  kReasonNotStanding = 1u << 21,  ///< A pose or a foot is requested, and it does not stand.
  kReasonNotLying = 1u << 22,     ///< Joints are requested, and it does not lie.
  kReasonLegSpeed = 1u << 23,     ///< The legs do not carry the body faster.
  kReasonNoPlan = 1u << 24,       ///< The forces of the feet have no solution: the last ones are in force.
  kReasonTooSteep = 1u << 25,     ///< It lies on a slope on which it does not stand up.
  kReasonMetRiser = 1u << 26,     ///< A foot hit an obstacle and is lifted over it.
  kReasonReaching = 1u << 27,     ///< A foot finds no ground where it was to land, and goes down.
};

/// The values of CommandFrame::stop_profile: how the robot lies down if the gate stops it.
enum LegStop : std::uint64_t { kStopStanding = 0, kStopWalking = 1 };

struct LeggedCommand {
  LegPhase phase = LegPhase::kLying;
  std::uint64_t lifted = 0;       ///< 1 + i: the foot of LegPlace i is in the air, or on its way; 0: none
  std::array<double, 6> body{};   ///< m and rad: x y height roll pitch yaw from the nominal pose, after limits
  std::uint64_t gait = 0;         ///< index of the robot's gaits (control/legged/walk/gait_table.h)
  double gait_phase = 0;          ///< 0 … 1
  std::array<double, 2> slope{};  ///< m/m: how much the ground rises to the front and left, below a robot on its feet
  std::uint64_t risers = 0;       ///< bits 1 << LegPlace: feet that are lifted over an obstacle
  std::uint64_t reaches = 0;      ///< the same: feet that find no ground
};

}  // namespace robot_control
