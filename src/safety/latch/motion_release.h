#pragma once
/// Two independent rules decide whether motion may begin; missing evidence never releases motion.
///
/// A *current command frame* in cycle k is the command of cycle k−1, computed from the state of cycle k−1. Its counters
/// of requests (control/common/command_watch.h) began in its first_cycle.
///
/// **Zero first.** A start is one of
///   the first cycle of a run that this monitor sees: the driver was started or reset, or the monitor was
///   the first_cycle of an estimator or of a controller
///   the first cycle after a pause (SensorFrame::resumes)
/// After the latest start motion is released as soon as a current command frame reports one of
///   zero     a zero request was received after that start
///   silence  no message of any sender, accepted or refused, for silence_needed cycles after that start, and no part of
///            the request in force is other than zero
/// Once released, motion stays released until the next start.
///
/// **Evidence for a reset.** It exists in cycle k if the current command frame reports a request of zeros alone, and
/// one of
///   zero     a zero request was received after the last gap, and only zero requests since then
///   silence  as above, after the last gap
/// A *gap* is a start, a cycle without a current command frame, or a cycle that the monitor skipped. Messages and
/// silence before a gap do not count.
///
/// A zero request counts as received after cycle c if the frame's counter began at c or later. It also counts if the
/// counter has grown since the first current frame after c.

#include <cstdint>
#include <optional>

#include "safety/monitor_input.h"

namespace robot_control {

class MotionRelease {
 public:
  /// A new run.
  void enter_run() noexcept;

  /// `elapsed`: cycles since the last step, ≥ 1.
  void step(const MonitorInput& input, std::uint64_t elapsed) noexcept;

  /// Starts until now, over all runs.
  std::uint64_t starts() const noexcept { return starts_; }

  /// Zero first is satisfied.
  bool released() const noexcept { return released_; }

  /// 0: in the last step there was evidence that no motion is requested. Otherwise one bit of ResetRefusal.
  std::uint64_t reset_refusal() const noexcept { return reset_refusal_; }

 private:
  /// Zero requests after a cycle.
  struct Count {
    std::uint64_t after = 0;
    std::optional<std::uint64_t> before;  ///< of the counter; none before the first current frame

    void restart(std::uint64_t cycle) noexcept { *this = {.after = cycle, .before = std::nullopt}; }
    bool grown(const CommandFrame& command) noexcept;
  };

  void begin(std::uint64_t cycle) noexcept;
  void start(std::uint64_t cycle) noexcept;
  void update_start(std::optional<std::uint64_t>& known, std::uint64_t first_cycle) noexcept;
  void evaluate(const CommandFrame& command) noexcept;

  std::optional<std::uint64_t> resumes_;  ///< SensorFrame::resumes of the last step
  std::optional<std::uint64_t> state_first_;
  std::optional<std::uint64_t> command_first_;
  Count since_start_;
  Count since_gap_;
  std::uint64_t starts_ = 0;
  bool released_ = false;
  std::uint64_t reset_refusal_ = kRefusalGap;
};

}  // namespace robot_control
