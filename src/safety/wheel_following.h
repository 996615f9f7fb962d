#pragma once
/// Each wheel against what it was told.
///
/// With s the sign of the target q̇*, ω the measured speed (wheel_motion.h), δ its tolerance, both in the joint's sign;
/// only where a target reaches the wheel (wheel_targets.h):
///
///   stall            the angle ∫|q̇*|dt that the wheel should have turned since it was last seen to follow, that is, to
///                    turn with s·ω ≥ kFollows·|q̇*|; limit rad + 1 quantum: a wheel that follows slowly shows a count
///                    each quantum
///   runaway          s·ω − |q̇*| > limit + δ;  |ω| where the target is 0
///   wrong_direction  −s·ω > limit + δ
///   not_stopping     s since the robot was told to stand while it has not stood (standstill.h): who rolls on, who is
///                    pushed, and who swings about his rest

#include <array>
#include <cstdint>

#include "robot/robot_model.h"
#include "safety/active_causes.h"
#include "safety/standstill.h"
#include "safety/wheel_motion.h"
#include "safety/wheel_targets.h"

namespace robot_control {

class WheelFollowing {
 public:
  static constexpr double kFollows = 0.2;

  /// `period` s.
  WheelFollowing(const SafetyParameters& parameters, double period) noexcept;

  void enter_run() noexcept;
  void step(const WheelTargets& targets, const WheelMotion& motion, const JointStandstill& standstill,
            std::uint64_t elapsed, ActiveCauses& out) noexcept;

 private:
  Finding stalled(const WheelTargets& targets, const WheelMotion& motion, double dt) noexcept;
  Finding not_stopped(const WheelTargets& targets, const JointStandstill& standstill, std::uint64_t elapsed) noexcept;

  double period_;
  ConditionWatch stall_;
  ConditionWatch runaway_;
  ConditionWatch wrong_direction_;
  ConditionWatch not_stopping_;
  std::array<double, kMaxWheels> missed_{};  ///< rad
  std::uint64_t still_moving_ = 0;           ///< cycles
};

}  // namespace robot_control
