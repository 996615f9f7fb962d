#pragma once
/// The conditions that are active in one cycle, by the reaction they ask for, with what was measured of each.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "safety/conditions/condition_watch.h"
#include "signals/permit.h"

namespace robot_control {

class ActiveCauses {
 public:
  void clear() noexcept {
    bits_ = {};
    count_ = 0;
  }

  /// Of a cause that was added already the first finding stays.
  void add(StopCause cause, Reaction reaction, const Finding& finding = {}) noexcept {
    std::uint64_t& bits = bits_[static_cast<std::size_t>(reaction)];
    if ((bits & cause) != 0 || count_ == findings_.size()) return;
    bits |= cause;
    findings_[count_] = {.cause = cause, .joint = finding.joint, .value = finding.value, .limit = finding.limit};
    ++count_;
  }

  /// Nothing while it is not active.
  void add(const ConditionWatch& watch) noexcept {
    if (watch.active()) add(watch.cause(), watch.reaction(), watch.finding());
  }

  /// One more cycle of a condition.
  void judge(ConditionWatch& watch, const Finding& finding, std::uint64_t elapsed) noexcept {
    if (watch.step(finding, elapsed)) add(watch);
  }

  /// StopCause bits.
  std::uint64_t with(Reaction reaction) const noexcept { return bits_[static_cast<std::size_t>(reaction)]; }

  /// What latches.
  std::uint64_t stopping() const noexcept { return with(Reaction::kRamp) | with(Reaction::kBrake); }

  /// In the order added; `cycle` is 0.
  std::span<const CauseEvidence> findings() const noexcept { return {findings_.data(), count_}; }

 private:
  static constexpr std::size_t kReactions = 5;

  std::array<std::uint64_t, kReactions> bits_{};
  std::size_t count_ = 0;
  std::array<CauseEvidence, kStopCauses> findings_{};
};

}  // namespace robot_control
