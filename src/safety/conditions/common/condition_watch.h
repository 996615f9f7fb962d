#pragma once
/// Persistence of one condition: a measurement per cycle → active after it was beyond its limit for `persistence`.
///
///   active in cycle k  ⇔  beyond in every evaluated cycle of [k − n + 1, k],  n = max(1, ⌈persistence/period⌉)
///
/// A cycle that was skipped counts as the next evaluated one, so skipped cycles do not delay a condition.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "safety/safety_parameters.h"
#include "signals/permit.h"

namespace robot_control {

/// The measured quantity of a condition in one cycle.
struct ConditionMeasurement {
  bool beyond = false;
  double value = 0;  ///< in the unit of the cause
  double limit = 0;
  std::uint64_t joint = kMaxJoints;  ///< index into MachineModel::joints; kMaxJoints: no single joint
  std::uint64_t times = 1;           ///< how often each cycle counts
};

inline ConditionMeasurement beyond(std::size_t joint, double value, double limit) noexcept {
  return {.beyond = value > limit, .value = value, .limit = limit, .joint = joint};
}

inline ConditionMeasurement below(double value, double limit) noexcept {
  return {.beyond = value < limit, .value = value, .limit = limit};
}

/// The one of two with the larger value − limit. NaN is never worse.
inline const ConditionMeasurement& worse(const ConditionMeasurement& a, const ConditionMeasurement& b) noexcept {
  return b.value - b.limit > a.value - a.limit ? b : a;
}

/// A measurement that is never beyond its limit and never the worse of two.
inline constexpr ConditionMeasurement kNothingMeasured{.limit = std::numeric_limits<double>::infinity()};

/// Returns the worst measurement of `measure(0)` … `measure(count - 1)`.
template <class Measure>
ConditionMeasurement worst_of(std::size_t count, const Measure& measure) noexcept {
  ConditionMeasurement worst = kNothingMeasured;
  for (std::size_t i = 0; i < count; ++i) worst = worse(worst, measure(i));
  return worst;
}

inline constexpr double kFarTimes = 3;  ///< a measurement of so many times its limit is far beyond it

/// From kFarTimes the limit on, a measurement of n times the limit counts n cycles, at most kMaxTimes. A light wheel
/// whose motor runs away (10³ rad/s) is stopped before the persistence ends; a wheel that leaves a bump is not.
inline ConditionMeasurement weighed(ConditionMeasurement measurement) noexcept {
  constexpr double kMaxTimes = 50;
  const double times = measurement.value / measurement.limit;
  if (measurement.beyond && times >= kFarTimes)
    measurement.times = static_cast<std::uint64_t>(std::min(times, kMaxTimes));
  return measurement;
}

/// Counts one cycle as more than the longest persistence, a minute at 2 kHz.
inline ConditionMeasurement at_once(ConditionMeasurement measurement) noexcept {
  measurement.times = std::uint64_t{1} << 20;
  return measurement;
}

class ConditionWatch {
 public:
  /// `period`: s.
  ConditionWatch(StopCause cause, const Condition& condition, double period) noexcept
      : cause_(cause),
        condition_(condition),
        cycles_(
            std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(condition.persistence / period - 1e-9)))) {}

  /// False: switched off, or without a limit. Then its quantity need not be computed.
  bool watched() const noexcept { return condition_.reaction != Reaction::kOff && condition_.limit.has_value(); }

  /// Meaningful if watched.
  double limit() const noexcept { return condition_.limit.value_or(0); }
  double persistence() const noexcept { return condition_.persistence; }  ///< s
  std::uint64_t cycles() const noexcept { return cycles_; }               ///< n

  StopCause cause() const noexcept { return cause_; }
  Reaction reaction() const noexcept { return condition_.reaction; }

  void reset() noexcept { beyond_ = 0; }

  /// `elapsed`: cycles since the last step, ≥ 1. True: active.
  bool step(const ConditionMeasurement& measurement, std::uint64_t elapsed) noexcept {
    if (!measurement.beyond || !watched()) {
      beyond_ = 0;
      return false;
    }
    measurement_ = measurement;
    beyond_ += elapsed * measurement.times;
    return active();
  }

  bool active() const noexcept { return beyond_ >= cycles_; }

  /// The measurement of the last step in which it was beyond its limit.
  const ConditionMeasurement& measurement() const noexcept { return measurement_; }

 private:
  StopCause cause_;
  Condition condition_;
  std::uint64_t cycles_;
  std::uint64_t beyond_ = 0;
  ConditionMeasurement measurement_;
};

}  // namespace robot_control
