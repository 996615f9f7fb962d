#pragma once
/// Wait for and wake on a 32-bit word, also across processes and on a read-only mapping.

#include <atomic>
#include <cstdint>

namespace robot_control {

/// Returns when `word != expected`, or after `timeout_ns` (relative, CLOCK_MONOTONIC; negative = for
/// ever); spurious wake-ups are absorbed. True if the word differs.
bool futex_wait(const std::atomic<std::uint32_t>& word, std::uint32_t expected, std::int64_t timeout_ns) noexcept;

void futex_wake_all(std::atomic<std::uint32_t>& word) noexcept;

/// Relative sleep on CLOCK_MONOTONIC.
void sleep_ns(std::int64_t duration_ns) noexcept;

}  // namespace robot_control
