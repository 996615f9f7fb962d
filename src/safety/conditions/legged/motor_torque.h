#pragma once
/// A MotorTorque measures how often a motor gives another torque than its commands demand.
///
/// Three commands demand torques at the measured angle and speed of this cycle and of the one before. They are those of
/// now, of kMaxDelay and of 2 kMaxDelay ago, rounded to whole cycles but 0. They span a range. A sample that repeats
/// itself is late. It also counts moved on by its last change, and the one before it stays in force. After 2 kMaxDelay
/// the encoder is stuck. A torque is wrong if it is outside by more than kDemandShare of the range's end and
/// kEffortShare of the effort limit. All of these torques are means over kMean, because measured speeds come in steps.
/// The result w is the part of the last cycles in which the torque was wrong:
///
///   w += T/kTime (1 − w), or T/kTime (0 − w)      T: period
///
/// In the simulator a faulty encoder errs on its way to this computer alone, so that its motor seems to give a wrong
/// torque. A drive that follows the wrong angle itself gives the torque that this angle demands.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "signals/joint.h"

namespace robot_control {

class MotorTorque {
 public:
  static constexpr double kMaxDelay = 0.005;    ///< s: a late motor is none that fails
  static constexpr std::size_t kCommands = 21;  ///< of 2 kMaxDelay at 2 kHz
  static constexpr double kDemandShare = 0.5;   ///< nor is a weak one
  static constexpr double kEffortShare = 0.04;  ///< docs/evidence/derivations.md
  static constexpr double kMean = 0.01;         ///< s
  static constexpr double kTime = 0.06;         ///< s

  /// Commands before this cycle are not in force any more. It is not judged until those of 2 kMaxDelay are known again.
  void forget() noexcept { known_ = 0; }

  void reset() noexcept {
    known_ = 0;
    wrong_ = 0;
  }

  /// Compares the torque of `joint` with the commands before, and remembers the one that follows. All numbers are
  /// finite. `limit` N·m, `period` s.
  void step(const JointSample& joint, const JointCommand& command, double limit, double period) noexcept {
    follow({joint.position, joint.velocity}, period);
    compare(joint, limit, period);
    commands_[next_] = command;
    next_ = (next_ + 1) % kCommands;
    known_ = std::min(known_ + 1, kCommands);
  }

  /// Returns w, 0 … 1.
  double wrong() const noexcept { return wrong_; }

 private:
  using Motion = std::array<double, 2>;  ///< rad, rad/s

  void follow(const Motion& sampled, double period) noexcept {
    repeats_ = sampled == motions_[0] ? repeats_ + period : 0;
    if (repeats_ > 2 * kMaxDelay) {
      motions_.fill(sampled);
    } else if (repeats_ == 0) {
      motions_ = {sampled, motions_[0], sampled};
    } else {
      for (std::size_t i = 0; i < sampled.size(); ++i) motions_[2][i] = 2 * sampled[i] - motions_[1][i];
    }
  }

  void compare(const JointSample& joint, double limit, double period) noexcept {
    const auto late = static_cast<std::size_t>(std::max(1.0, std::round(kMaxDelay / period)));  // cycles
    if (known_ <= 2 * late) {
      given_ = joint.effort;
      demanded_.fill(joint.effort);
      return;
    }
    const double part = std::min(1.0, period / kMean);
    given_ += part * (joint.effort - given_);
    for (std::size_t i = 0; i < demanded_.size(); ++i) {
      const double demand =
          std::clamp(demanded(i / motions_.size() * late, motions_[i % motions_.size()]), -limit, limit);
      demanded_[i] += part * (demand - demanded_[i]);
    }
    const auto [lower, upper] = std::ranges::minmax(demanded_);
    const bool wrong = given_ < lower - kDemandShare * std::abs(lower) - kEffortShare * limit ||
                       given_ > upper + kDemandShare * std::abs(upper) + kEffortShare * limit;
    wrong_ += period / kTime * ((wrong ? 1 : 0) - wrong_);
  }

  double demanded(std::size_t ago, const Motion& motion) const noexcept {
    const JointCommand& law = commands_[(next_ + kCommands - 1 - ago) % kCommands];
    return law.effort + law.stiffness * (law.position - motion[0]) + law.damping * (law.velocity - motion[1]);
  }

  std::array<JointCommand, kCommands> commands_{};  ///< of the last cycles, a ring
  std::size_t next_ = 0, known_ = 0;                ///< index of the oldest one, how many there are
  std::array<Motion, 3> motions_{};                 ///< the last sample, the one before that differs, moved on
  double repeats_ = 0;                              ///< s for which the last sample has been the same
  double given_ = 0;                                ///< N·m, the mean
  std::array<double, 9> demanded_{};                ///< N·m, the means: of three commands, each at three motions
  double wrong_ = 0;
};

}  // namespace robot_control
