#include "loop/processes/loop_hold.h"

#include "rt/clock.h"
#include "rt/futex.h"

namespace robot_control {

std::uint64_t LoopHold::request(Request request) noexcept {
  request.number = ++numbers_;
  inbox_.store(request);
  word_.fetch_add(1, std::memory_order_release);
  futex_wake_all(word_);
  return request.number;
}

bool LoopHold::await_stand(std::uint64_t number, std::int64_t timeout_ns) const noexcept {
  const std::int64_t end_ns = monotonic_ns() + timeout_ns;
  while (!stands(number)) {
    if (!looping() || monotonic_ns() > end_ns) return false;
    sleep_ns(kPollPeriod);
  }
  return true;
}

void LoopHold::receive() noexcept {
  seen_ = word_.load(std::memory_order_acquire);
  inbox_.load(request_);
}

bool LoopHold::may_tick(std::uint64_t cycle) noexcept {
  receive();
  next_cycle_.store(cycle, std::memory_order_release);
  return request_.parked == 0 && (request_.paused == 0 || cycle < request_.step_until);
}

bool LoopHold::park_requested() noexcept {
  receive();
  return request_.parked != 0;
}

void LoopHold::stand(std::int64_t wait_ns, const std::atomic<bool>& stopping) noexcept {
  do {
    answered_.store(request_.number, std::memory_order_release);
    futex_wait(word_, seen_, wait_ns);
    if (request_.parked == 0) return;
    receive();
  } while (request_.parked != 0 && !stopping.load(std::memory_order_relaxed));
}

}  // namespace robot_control
