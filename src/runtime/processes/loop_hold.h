#pragma once
/// May the loop of a simulated machine tick? Pause, step and park, between the real-time thread, which asks before
/// each tick, and ordinary threads.
///
/// What is asked is a state, not an event, so that a latest-value inbox loses nothing:
///   may tick k  ⇔  ¬parked ∧ (¬paused ∨ k < step_until)
/// Every asking has a number; the loop answers with the newest number under which it stands. While it stands it
/// sleeps on a futex; no lock, no allocation. A parked loop touches neither machine nor cycle: they belong to the
/// thread that parked it.

#include <atomic>
#include <cstdint>

#include "rt/latest_value.h"
#include "signals/injected_fault.h"

namespace robot_control {

class LoopHold {
 public:
  struct Asked {
    std::uint64_t number = 0;  ///< set by `ask`
    std::uint64_t paused = 0;
    std::uint64_t step_until = 0;  ///< while paused: the cycle before which the loop stands again
    std::uint64_t parked = 0;
    InjectedFaults faults{};
  };

  // Ordinary threads; `ask` one at a time.

  /// Returns the number of this asking.
  std::uint64_t ask(Asked asked) noexcept;

  /// The loop stands, under this asking or a later one.
  bool stands(std::uint64_t number) const noexcept { return answered_.load(std::memory_order_acquire) >= number; }

  /// `stands`, waited for. False after `timeout_ns`, or when no loop runs.
  bool await_stand(std::uint64_t number, std::int64_t timeout_ns) const noexcept;

  /// The cycle that the loop asked for last.
  std::uint64_t next_cycle() const noexcept { return next_cycle_.load(std::memory_order_acquire); }

  /// Is there a loop that would answer?
  bool looping() const noexcept { return looping_.load(std::memory_order_acquire); }

  // The real-time thread.

  void begin() noexcept { looping_.store(true, std::memory_order_release); }
  void end() noexcept { looping_.store(false, std::memory_order_release); }

  /// Looks into the inbox.
  bool may_tick(std::uint64_t cycle) noexcept;

  /// Is the loop asked to park, as of now? A wait for others must not keep it from that.
  bool park_asked() noexcept;

  /// As of the last look.
  const InjectedFaults& faults() const noexcept { return asked_.faults; }

  /// After `may_tick` said no: answers, and sleeps until something else is asked or, unless parked, for `wait_ns`.
  void stand(std::int64_t wait_ns, const std::atomic<bool>& stopping) noexcept;

 private:
  void look() noexcept;

  LatestValue<Asked> inbox_;
  std::uint64_t numbers_ = 0;           ///< given out; ordinary threads
  std::atomic<std::uint32_t> word_{0};  ///< futex: something else is asked
  std::atomic<std::uint64_t> answered_{0};
  std::atomic<std::uint64_t> next_cycle_{0};
  std::atomic<bool> looping_{false};
  Asked asked_;             ///< real-time thread
  std::uint32_t seen_ = 0;  ///< `word_` before the last look
};

}  // namespace robot_control
