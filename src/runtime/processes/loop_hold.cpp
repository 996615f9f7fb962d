#include "runtime/processes/loop_hold.h"

#include "rt/clock.h"
#include "rt/futex.h"

namespace robot_control {

std::uint64_t LoopHold::ask(Asked asked) noexcept {
  asked.number = ++numbers_;
  inbox_.store(asked);
  word_.fetch_add(1, std::memory_order_release);
  futex_wake_all(word_);
  return asked.number;
}

bool LoopHold::await_stand(std::uint64_t number, std::int64_t timeout_ns) const noexcept {
  const std::int64_t end_ns = monotonic_ns() + timeout_ns;
  while (!stands(number)) {
    if (!looping() || monotonic_ns() > end_ns) return false;
    sleep_ns(kLook);
  }
  return true;
}

void LoopHold::look() noexcept {
  seen_ = word_.load(std::memory_order_acquire);
  inbox_.load(asked_);
}

bool LoopHold::may_tick(std::uint64_t cycle) noexcept {
  look();
  next_cycle_.store(cycle, std::memory_order_release);
  return asked_.parked == 0 && (asked_.paused == 0 || cycle < asked_.step_until);
}

bool LoopHold::park_asked() noexcept {
  look();
  return asked_.parked != 0;
}

void LoopHold::stand(std::int64_t wait_ns, const std::atomic<bool>& stopping) noexcept {
  do {
    answered_.store(asked_.number, std::memory_order_release);
    futex_wait(word_, seen_, wait_ns);
    if (asked_.parked == 0) return;
    look();
  } while (asked_.parked != 0 && !stopping.load(std::memory_order_relaxed));
}

}  // namespace robot_control
