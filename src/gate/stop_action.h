#pragma once
/// A stop action is how one joint is stopped while the gate passes no command. The robot's kind chooses it for each
/// joint and derives its parameters from the machine. The gate orders it, and the driver carries it out:
///
///   kBrake  JointMode::kBrake: the driver's own law damps the velocity and, below a small speed, holds the position
///           (brake_law.h)
///   kCoast  τ = 0: friction alone stops the joint, and a load moves it
///   kDamp   τ = −damping · q̇: a load moves the joint slowly
///   kFold   τ = stiffness · (q* − q) + damping · (q̇* − q̇). q* goes from the position at the first order, Q, to
///           `posture`, P. The part u of the way falls from 1 with u̇ = −min(1/0.64, u/0.18)/time, so that a body meets
///           the ground slowly: the first part is 1/0.64 times as fast as the mean. q* = P + u (Q − P). A joint with Q
///           between P and `upright`, U, is ahead of the others, for instance that of a foot in the air, or while the
///           robot rises. It waits for them: q* = P + min(u, (Q − P)/(U − P)) (U − P). In the last 0.2 of `time` the
///           stiffness falls to 0. After `time`, and without a position, it is kDamp. A machine that walks has
///           `walking_time` in place of `time`: a foot stays behind while the body moves on. After 1.2 of `time`, walking
///           or not, it is kBrake: the machine lies, and a driver's own brake needs neither encoder nor the sense of the
///           motor. So it is from where q is farther than kLost from q*. Sound joints stay within 0.1; a failed encoder
///           or a reversed motor drives the joint away
///
/// A driver that cannot carry out an action says so (Driver::accepts), and the loop does not start.

#include <optional>
#include <vector>

#include "parameters/block.h"
#include "signals/joint.h"

namespace robot_control {

enum class StopKind { kBrake, kCoast, kDamp, kFold };

/// Returns the actions that a user may choose for drive wheels. Others belong to the robot's kind.
inline std::vector<Word> words_of(StopKind) {
  return {{"brake", StopKind::kBrake}, {"coast", StopKind::kCoast}, {"damp", StopKind::kDamp}};
}

struct StopAction {
  StopKind kind = StopKind::kBrake;
  double damping = 0;                            ///< N·m·s/rad or N·s/m, ≥ 0; kDamp, kFold
  double stiffness = 0;                          ///< N·m/rad or N/m, ≥ 0; kFold
  double posture = 0;                            ///< rad or m, P of kFold
  std::optional<double> upright = std::nullopt;  ///< rad or m, U of kFold; none: no joint waits
  double time = 0;                               ///< s, ≥ 0; kFold
  double walking_time = 0;                       ///< s, ≥ 0; kFold
};

/// The stop of one joint as a law. Its state is empty while a command moves the joint.
class JointStop {
 public:
  explicit JointStop(const StopAction& action) noexcept : action_(action) {}

  /// Returns true from the first order of a fold on, until `release`.
  bool folds() const noexcept { return action_.kind == StopKind::kFold && elapsed_ > 0; }

  /// A command moves the joint.
  void release() noexcept {
    begin_.reset();
    elapsed_ = 0;
    left_ = 1;
    lost_ = false;
  }

  /// Returns the order of one cycle, `dt` s after the last one. `position`: measured, rad or m; none: not known.
  /// `walked`: the machine walked before the first order.
  JointCommand step(std::optional<double> position, double dt, bool walked = false) noexcept;

 private:
  StopAction action_;
  std::optional<double> begin_;  ///< rad or m, at the first order
  double elapsed_ = 0;           ///< s, since then
  double left_ = 1;              ///< u
  bool lost_ = false;            ///< farther than kLost from q* since the first order
};

}  // namespace robot_control
