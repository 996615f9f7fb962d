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

#include "rt/latest_value.h"
#include "signals/injected_fault.h"

namespace robot_control {

class LoopHold {
 public:
  static constexpr std::int64_t kLook = 500'000;  ///< ns between two looks of a thread that waits for the loop

  struct Asked {
    std::uint64_t number = 0;  ///< set by `ask`
    std::uint64_t paused = 0;
    std::uint64_t step_until = 0;  ///< while paused: the cycle before which the loop stands again
    std::uint64_t parked = 0;
    InjectedFaults faults{};
  };

  // Ordinary threads; `ask` one at a time.

  /// Returns the number of this request.
  std::uint64_t ask(Asked asked) noexcept;

  /// The loop stands still, under this request or a later one.
  bool stands(std::uint64_t number) const noexcept { return answered_.load(std::memory_order_acquire) >= number; }

  /// `stands`, waited for. False after `timeout_ns`, or when no loop runs.
  bool await_stand(std::uint64_t number, std::int64_t timeout_ns) const noexcept;

  /// The cycle for which the loop checked last.
  std::uint64_t next_cycle() const noexcept { return next_cycle_.load(std::memory_order_acquire); }

  /// There is a loop that acknowledges.
  bool looping() const noexcept { return looping_.load(std::memory_order_acquire); }

  // The real-time thread.

  void begin() noexcept { looping_.store(true, std::memory_order_release); }
  void end() noexcept { looping_.store(false, std::memory_order_release); }

  /// Looks into the inbox.
  bool may_tick(std::uint64_t cycle) noexcept;

  /// Is the loop asked to park, as of now? A wait for others must not keep it from that.
  bool park_asked() noexcept;

  /// As of the last look; false: a tick is allowed beyond the cycles of a step.
  bool paused() const noexcept { return asked_.paused != 0; }

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
