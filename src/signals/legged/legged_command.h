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

/// Bits 20 to 25 of CommandFrame::reasons.
enum LeggedReason : std::uint64_t {
  kReasonOutOfReach = 1u << 20,   ///< The pose is beyond the ranges of the legs.
  kReasonNotStanding = 1u << 21,  ///< A pose or a foot is requested, and it does not stand.
  kReasonNotLying = 1u << 22,     ///< Joints are requested, and it does not lie.
  kReasonLegSpeed = 1u << 23,     ///< The legs do not carry the body faster.
  kReasonNoPlan = 1u << 24,       ///< The forces of the feet have no solution: the last ones are in force.
  kReasonTooSteep = 1u << 25,     ///< It lies on a slope on which it does not stand up.
};

/// These numbers say what is asked of each foot, by LegPlace. 0: it shall not bear. 0.5: it stands without a gait. Else
/// it is the part of its stance that it has done at the end of this cycle, above 0 … 1.
using FootStances = std::array<double, 4>;

struct LeggedCommand {
  LegPhase phase = LegPhase::kLying;
  std::uint64_t lifted = 0;      ///< 1 + i: the foot of LegPlace i is in the air, or on its way; 0: none
  std::array<double, 6> body{};  ///< m and rad: x y height roll pitch yaw from the nominal pose, after limits
  std::uint64_t gait = 0;        ///< index of the robot's gaits (control/legged/walk/gait_table.h)
  double gait_phase = 0;         ///< 0 … 1
  FootStances stance{};
};

}  // namespace robot_control
