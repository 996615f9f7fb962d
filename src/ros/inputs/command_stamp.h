#pragma once
/// The stamp of a command is checked once, when the command arrives.
///
///   age = arrival − stamp   both on the sender's clock, the time of day or /clock; a stamp of 0 is none: age 0
///
/// A command is usable if −kClockSkew ≤ age ≤ timeout. An age below zero counts as zero, so that no command outlives
/// the timeout. An older command timed out in transport. A stamp in the future means that the two clocks differ and the
/// age is not known. With timeout 0 stamps are not checked, and no command is too old.

#include <algorithm>
#include <cstdint>

namespace robot_control {

/// ns, the largest accepted difference of two clocks. It is far above that of machines synchronised by NTP (RFC 5905,
/// abstract: down to tens of microseconds). It is far below any usual cmd_vel_timeout. So only clocks that are not
/// synchronised are reported.
inline constexpr std::int64_t kClockSkew = 100'000'000;

enum class StampVerdict { kUsable, kTooOld, kFuture };

struct JudgedStamp {
  StampVerdict verdict = StampVerdict::kUsable;
  std::int64_t age_ns = 0;  ///< ≥ 0 if usable, else as measured
};

constexpr JudgedStamp judge_stamp(std::int64_t stamp_ns, std::int64_t arrival_ns, std::int64_t timeout_ns) noexcept {
  if (stamp_ns == 0 || timeout_ns <= 0) return {};
  const std::int64_t age_ns = arrival_ns - stamp_ns;
  if (age_ns > timeout_ns) return {StampVerdict::kTooOld, age_ns};
  if (age_ns < -kClockSkew) return {StampVerdict::kFuture, age_ns};
  return {StampVerdict::kUsable, std::max<std::int64_t>(0, age_ns)};
}

}  // namespace robot_control
