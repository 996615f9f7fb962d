#pragma once
/// Threads wait on a 32-bit word and wake each other, also across processes; waiting needs only a read-only mapping.

#include <atomic>
#include <cstdint>

namespace robot_control {

/// Waits until `word != expected`, at most `timeout_ns` (relative, CLOCK_MONOTONIC; negative: for ever). Spurious
/// wake-ups are absorbed. Returns whether the word differs.
bool futex_wait(const std::atomic<std::uint32_t>& word, std::uint32_t expected, std::int64_t timeout_ns) noexcept;

void futex_wake_all(std::atomic<std::uint32_t>& word) noexcept;

/// Sleeps for a time relative to now, on CLOCK_MONOTONIC.
void sleep_ns(std::int64_t duration_ns) noexcept;

}  // namespace robot_control
