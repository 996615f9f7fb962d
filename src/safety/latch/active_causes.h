#pragma once
/// The conditions that are active in one cycle, by reaction, with the measurement of each.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "safety/conditions/common/condition_watch.h"
#include "signals/permit.h"

namespace robot_control {

class ActiveCauses {
 public:
  void clear() noexcept {
    bits_ = {};
    count_ = 0;
  }

  /// If a cause is added twice, its first measurement stays.
  void add(StopCause cause, Reaction reaction, const ConditionMeasurement& measurement = {}) noexcept {
    std::uint64_t& bits = bits_[static_cast<std::size_t>(reaction)];
    if ((bits & cause) != 0 || count_ == measurements_.size()) return;
    bits |= cause;
    measurements_[count_] = {
        .cause = cause, .joint = measurement.joint, .value = measurement.value, .limit = measurement.limit};
    ++count_;
  }

  /// No effect while the condition is not active.
  void add(const ConditionWatch& watch) noexcept {
    if (watch.active()) add(watch.cause(), watch.reaction(), watch.measurement());
  }

  /// One more cycle of a condition.
  void update(ConditionWatch& watch, const ConditionMeasurement& measurement, std::uint64_t elapsed) noexcept {
    if (watch.step(measurement, elapsed)) add(watch);
  }

  /// StopCause bits.
  std::uint64_t with(Reaction reaction) const noexcept { return bits_[static_cast<std::size_t>(reaction)]; }

  /// The causes that latch a stop.
  std::uint64_t stopping() const noexcept { return with(Reaction::kRamp) | with(Reaction::kBrake); }

  /// In the order added; `cycle` is 0.
  std::span<const CauseEvidence> measurements() const noexcept { return {measurements_.data(), count_}; }

 private:
  static constexpr std::size_t kReactions = 5;

  std::array<std::uint64_t, kReactions> bits_{};
  std::size_t count_ = 0;
  std::array<CauseEvidence, kStopCauses> measurements_{};
};

}  // namespace robot_control
