#pragma once
/// Pause, step and park the loop of a simulated machine: ordinary threads request it, the real-time thread checks the
/// request before each tick.
///
/// A request is a state, not an event, so a latest-value inbox loses nothing:
///   tick k is allowed  ⇔  ¬parked ∧ (¬paused ∨ k < step_until)
/// Every request has a number. The loop acknowledges the number of the newest request under which it stands still; then
/// it sleeps on a futex, without lock or allocation. A parked loop uses neither machine nor cycle: they belong to the
/// thread that parked it.

#include <atomic>
#include <cstdint>

#include "bus/latest_value.h"
#include "signals/injected_fault.h"

namespace robot_control {

class LoopHold {
 public:
  static constexpr std::int64_t kPollPeriod = 500'000;  ///< ns, of a thread that waits for the loop

  struct Request {
    std::uint64_t number = 0;  ///< set by `request`
    std::uint64_t paused = 0;
    std::uint64_t step_until = 0;  ///< while paused: the cycle before which the loop stands again
    std::uint64_t parked = 0;
    InjectedFaults faults{};
  };

  // Ordinary threads; `request` is called by one at a time.

  /// Returns the number of this request.
  std::uint64_t request(Request request) noexcept;

  /// The loop stands still, under this request or a later one.
  bool stands(std::uint64_t number) const noexcept { return answered_.load(std::memory_order_acquire) >= number; }

  /// Waits until the loop stands. False after `timeout_ns`, or when no loop runs.
  bool await_stand(std::uint64_t number, std::int64_t timeout_ns) const noexcept;

  /// The cycle for which the loop checked last.
  std::uint64_t next_cycle() const noexcept { return next_cycle_.load(std::memory_order_acquire); }

  /// There is a loop that acknowledges.
  bool looping() const noexcept { return looping_.load(std::memory_order_acquire); }

  // The real-time thread.

  void begin() noexcept { looping_.store(true, std::memory_order_release); }
  void end() noexcept { looping_.store(false, std::memory_order_release); }

  /// Reads the inbox. The cycle may run under the newest request.
  bool may_tick(std::uint64_t cycle) noexcept;

  /// Reads the inbox; returns whether the loop has to park. It parks also while it waits for other nodes.
  bool park_requested() noexcept;

  /// By the request read last; false: a tick is allowed beyond the cycles of a step.
  bool paused() const noexcept { return request_.paused != 0; }

  /// Those of the request read last.
  const InjectedFaults& faults() const noexcept { return request_.faults; }

  /// After `may_tick` returned false: acknowledges, and sleeps until another request or, unless parked, for `wait_ns`.
  void stand(std::int64_t wait_ns, const std::atomic<bool>& stopping) noexcept;

 private:
  void receive() noexcept;

  LatestValue<Request> inbox_;
  std::uint64_t numbers_ = 0;           ///< given out; ordinary threads
  std::atomic<std::uint32_t> word_{0};  ///< futex: another request
  std::atomic<std::uint64_t> answered_{0};
  std::atomic<std::uint64_t> next_cycle_{0};
  std::atomic<bool> looping_{false};
  Request request_;         ///< real-time thread
  std::uint32_t seen_ = 0;  ///< `word_` before the last request was read
};

}  // namespace robot_control
