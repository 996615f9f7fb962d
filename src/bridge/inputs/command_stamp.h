#pragma once
/// The stamp of a command, judged once, when it arrives.
///
///   age = arrival − stamp   both on the sender's clock, the time of day or /clock; a stamp of 0 is none: age 0
///
/// Usable: −kClockSkew ≤ age ≤ timeout; an age below zero counts as zero, so that no command outlives the timeout.
/// Older: it timed out in transport. In the future: the two clocks differ, and its age is not known.
/// With timeout 0 no command is ever too old: no stamp is looked at.

#include <algorithm>
#include <cstdint>

namespace robot_control {

/// ns. Far above what NTP leaves between the machines of one network (RFC 5905, abstract: down to tens of
/// microseconds), far below any usual cmd_vel_timeout: a clock that is not synchronised is reported, one that is
/// synchronised is not.
inline constexpr std::int64_t kClockSkew = 100'000'000;

enum class StampVerdict { kUsable, kTooOld, kFuture };

struct JudgedStamp {
  StampVerdict verdict = StampVerdict::kUsable;
  std::int64_t age_ns = 0;  ///< usable: ≥ 0; else as found
};

constexpr JudgedStamp judge_stamp(std::int64_t stamp_ns, std::int64_t arrival_ns, std::int64_t timeout_ns) noexcept {
  if (stamp_ns == 0 || timeout_ns <= 0) return {};
  const std::int64_t age_ns = arrival_ns - stamp_ns;
  if (age_ns > timeout_ns) return {StampVerdict::kTooOld, age_ns};
  if (age_ns < -kClockSkew) return {StampVerdict::kFuture, age_ns};
  return {StampVerdict::kUsable, std::max<std::int64_t>(0, age_ns)};
}

}  // namespace robot_control
