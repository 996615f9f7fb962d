#include "rt/futex.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <climits>
#include <ctime>

#include "rt/clock.h"
#include "rt/wait_count.h"

namespace robot_control {
namespace {

timespec to_timespec(std::int64_t time_ns) noexcept {
  return {time_ns / 1'000'000'000, time_ns % 1'000'000'000};
}

}  // namespace

bool futex_wait(const std::atomic<std::uint32_t>& word, std::uint32_t expected, std::int64_t timeout_ns) noexcept {
  if (word.load(std::memory_order_acquire) != expected) return true;
  const std::int64_t deadline_ns = timeout_ns < 0 ? 0 : monotonic_ns() + timeout_ns;
  const timespec deadline = to_timespec(deadline_ns);
  do {
    count_wait();
    // FUTEX_WAIT_BITSET takes an absolute CLOCK_MONOTONIC time. The futex is not private, because the word is in shared
    // memory.
    const long result = syscall(SYS_futex, reinterpret_cast<const std::uint32_t*>(&word), FUTEX_WAIT_BITSET, expected,
                                timeout_ns < 0 ? nullptr : &deadline, nullptr, FUTEX_BITSET_MATCH_ANY);
    if (word.load(std::memory_order_acquire) != expected) return true;
    if (result == 0 || timeout_ns < 0) continue;
    if (monotonic_ns() >= deadline_ns) return false;
  } while (true);
}

void futex_wake_all(std::atomic<std::uint32_t>& word) noexcept {
  syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word), FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

void sleep_ns(std::int64_t duration_ns) noexcept {
  sleep_until(monotonic_ns() + duration_ns);
}

}  // namespace robot_control
