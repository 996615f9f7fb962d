#include "rt/futex.h"

#include <climits>
#include <ctime>
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "rt/clock.h"

namespace robot_control {
namespace {

timespec to_timespec(std::int64_t duration_ns) noexcept {
  return {duration_ns / 1'000'000'000, duration_ns % 1'000'000'000};
}

}  // namespace

bool futex_wait(const std::atomic<std::uint32_t>& word, std::uint32_t expected, std::int64_t timeout_ns) noexcept {
  const std::int64_t deadline = timeout_ns < 0 ? 0 : monotonic_ns() + timeout_ns;
  while (word.load(std::memory_order_acquire) == expected) {
    timespec left{};
    if (timeout_ns >= 0) {
      const std::int64_t left_ns = deadline - monotonic_ns();
      if (left_ns <= 0) return false;
      left = to_timespec(left_ns);
    }
    // Not FUTEX_PRIVATE_FLAG: the word lies in shared memory.
    syscall(SYS_futex, reinterpret_cast<const std::uint32_t*>(&word), FUTEX_WAIT, expected,
            timeout_ns < 0 ? nullptr : &left, nullptr, 0);
  }
  return true;
}

void futex_wake_all(std::atomic<std::uint32_t>& word) noexcept {
  syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word), FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

void sleep_ns(std::int64_t duration_ns) noexcept {
  const timespec duration = to_timespec(duration_ns);
  clock_nanosleep(CLOCK_MONOTONIC, 0, &duration, nullptr);
}

}  // namespace robot_control
