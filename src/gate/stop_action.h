#pragma once
/// A stop action is how one joint is stopped while the gate passes no command, and a stop profile has one for each
/// joint. The robot's kind declares its profiles and derives them from the machine. Each command names the profile that
/// applies after it. The gate orders the actions, and the driver carries them out:
///
///   kBrake  JointMode::kBrake: the driver's own law damps the velocity and, below a small speed, holds the position
///           (brake_law.h)
///   kCoast  τ = 0: friction alone stops the joint, and a load moves it
///   kDamp   τ = −damping · q̇: a load moves the joint slowly
///   kMove   τ = stiffness · (q* − q) + damping · (q̇* − q̇), where q* moves to `target`, P
///
/// A move begins at the position of the first order, Q. The part u of the way falls from 1, so that the joint arrives
/// slowly:
///
///   u̇ = −min(1/kFirstRateShare, u/kEndShare)/time      q* = P + u (Q − P)
///
/// A joint with Q between P and `start`, S, is ahead of the others, and waits for them:
///
///   q* = P + min(u, (Q − P)/(S − P)) (S − P)
///
/// The stiffness falls to 0 in the last part kFadeShare of `time`. After `time`, and without a position, the move is
/// kDamp. After `brake_after` it is kBrake, which needs neither encoder nor the sense of the motor. It is kBrake, too,
/// once q is farther than kMaxDeviation from q*: a failed encoder or a reversed motor drives the joint away.
///
/// A driver that cannot carry out an action says so (Driver::accepts), and the loop does not start.

#include <optional>
#include <vector>

#include "parameters/block.h"
#include "signals/joint.h"

namespace robot_control {

enum class StopKind { kBrake, kCoast, kDamp, kMove };

/// Returns the actions that a user may choose with robot.fail_action. Others belong to the robot's kind.
inline std::vector<Word> words_of(StopKind) {
  return {{"brake", StopKind::kBrake}, {"coast", StopKind::kCoast}, {"damp", StopKind::kDamp}};
}

struct StopAction {
  StopKind kind = StopKind::kBrake;
  double damping = 0;      ///< N·m·s/rad or N·s/m, ≥ 0; kDamp, kMove
  double stiffness = 0;    ///< N·m/rad or N/m, ≥ 0; kMove
  double target = 0;       ///< rad or m, P of kMove
  double start = target;   ///< rad or m, S of kMove; at `target` no joint waits
  double time = 0;         ///< s, ≥ 0; kMove
  double brake_after = 0;  ///< s since the first order, ≥ 0; kMove
};

using StopProfile = std::vector<StopAction>;  ///< one action for each joint

/// The stop of one joint as a law. While a command moves the joint, its state is that of a new object.
class JointStop {
 public:
  static constexpr double kFirstRateShare = 0.64;  ///< part of the time in which u reaches 0 at its first rate
  static constexpr double kEndShare = 0.18;        ///< part of the time: the time constant with which u ends
  static constexpr double kFadeShare = 0.2;        ///< part of the time
  static constexpr double kMaxDeviation = 0.25;    ///< rad or m; sound joints stay within 0.1

  /// Returns true from the first order of a move on.
  bool moves() const noexcept { return elapsed_ > 0; }

  /// Returns the order of one cycle, `dt` s after the last one. `position`: measured, rad or m; none: not known. The
  /// action is the same in each cycle of a stop.
  JointCommand step(const StopAction& action, std::optional<double> position, double dt) noexcept;

 private:
  std::optional<double> begin_;  ///< Q
  double elapsed_ = 0;           ///< s, since the first order
  double left_ = 1;              ///< u
  bool lost_ = false;            ///< farther than kMaxDeviation from q* since the first order
};

}  // namespace robot_control
