#pragma once
/// One condition over time: a finding per cycle → active once it has been beyond its limit for `persistence`.
///
///   active in cycle k  ⇔  beyond in every cycle looked at of [k − n + 1, k],  n = max(1, ⌈persistence/period⌉)
///
/// A cycle that was skipped counts as the next one that was looked at: a monitor that is late sees no later.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "safety/safety_parameters.h"
#include "signals/permit.h"

namespace robot_control {

/// What a fact says in one cycle.
struct Finding {
  bool beyond = false;
  double value = 0;  ///< in the unit of the cause
  double limit = 0;
  std::uint64_t joint = kMaxJoints;  ///< index into RobotModel::joints; kMaxJoints: of no single one
};

inline Finding beyond(std::size_t joint, double value, double limit) noexcept {
  return {.beyond = value > limit, .value = value, .limit = limit, .joint = joint};
}

/// Of two, that which is further beyond its limit, or nearer to it. What is not a number is no finding.
inline const Finding& worse(const Finding& a, const Finding& b) noexcept {
  return b.value - b.limit > a.value - a.limit ? b : a;
}

/// Nothing found: further from its limit than any.
inline constexpr Finding kNothingFound{.limit = std::numeric_limits<double>::infinity()};

/// Cycles that a finding counts for, where less of it may last longer: from kFarTimes its limit on, n times the limit
/// for one cycle is as bad as once the limit for n. A light wheel whose motor pulls the wrong way reaches a thousand
/// rad/s while others come off a bump.
inline std::uint64_t weighed(const Finding& finding, std::uint64_t elapsed) noexcept {
  constexpr double kFarTimes = 3;
  constexpr double kMostTimes = 50;
  const double times = finding.value / finding.limit;
  if (!finding.beyond || !(times >= kFarTimes)) return elapsed;
  return elapsed * static_cast<std::uint64_t>(std::min(times, kMostTimes));
}

class ConditionWatch {
 public:
  /// `period`: s.
  ConditionWatch(StopCause cause, const Condition& condition, double period) noexcept
      : cause_(cause),
        condition_(condition),
        cycles_(
            std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(condition.persistence / period - 1e-9)))) {}

  /// False: switched off, or without a limit. Then its fact need not be looked at.
  bool watched() const noexcept { return condition_.reaction != Reaction::kOff && condition_.limit.has_value(); }

  /// Meaningful when watched.
  double limit() const noexcept { return condition_.limit.value_or(0); }

  StopCause cause() const noexcept { return cause_; }
  Reaction reaction() const noexcept { return condition_.reaction; }

  void reset() noexcept { beyond_ = 0; }

  /// `elapsed`: cycles since the last step, ≥ 1. True: active.
  bool step(const Finding& finding, std::uint64_t elapsed) noexcept {
    finding_ = finding;
    beyond_ = watched() && finding.beyond ? beyond_ + elapsed : 0;
    return active();
  }

  bool active() const noexcept { return beyond_ >= cycles_; }

  /// Of the last step.
  const Finding& finding() const noexcept { return finding_; }

 private:
  StopCause cause_;
  Condition condition_;
  std::uint64_t cycles_;
  std::uint64_t beyond_ = 0;
  Finding finding_;
};

}  // namespace robot_control
