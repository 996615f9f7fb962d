#pragma once
/// These conditions find a gate that does not obey the permits. The sensors of cycle k report what it did in its last
/// tick t, which is k−1. On hardware it is earlier if the driver was late and skipped cycles.
///
///   due         the newest permit of cycles < t that was alive in tick t: the one that the gate should have used
///   refuses     the due permit allowed motion (drive, or ramp while t ≤ ramp_until), the command did not request the
///               brake, and yet the tick braked or rejected a frame: in loss_cycles ticks in a row, or in more than
///               half of the ticks of the last second. A robot that stops and continues by itself is not predictable.
///               A gate that found no permit in time is monitor_late, one that found no command command_stale
///   disobeys    a command passed although the permit ordered the brake, its ramp had ended, it had expired, or it was
///               never issued, or t is not between the last frame that the monitor read and this one: software can no
///               longer stop this machine, so it leads to FAULT
///
/// A permit from before the first step (of an earlier monitor) is judged by its age only. Ticks that the monitor
/// skipped count as the next tick that it evaluated. Cycles that the driver skipped are no ticks. A report that is not
/// between the last frame and this one counts as that of tick k−1.

#include <array>
#include <bitset>
#include <cstdint>

#include "safety/latch/active_causes.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class GateConditions {
 public:
  static constexpr std::size_t kMaxTicks = 2048;  ///< of the last second

  /// `period` s.
  GateConditions(std::uint64_t loss_cycles, double period) noexcept;

  /// A new run: no permit was issued yet.
  void enter_run() noexcept;

  void step(const SensorFrame& sensors, ActiveCauses& out) noexcept;

  /// The permit that was issued in `cycle`; call once per cycle. A permit that is published again in the same cycle
  /// (for display) is not recorded: the gate may or may not have used it.
  void remember(const Permit& permit, std::uint64_t cycle) noexcept;

 private:
  static constexpr std::size_t kRemembered = 8;  // twice a permit's life

  struct Given {
    std::uint64_t cycle = 0;
    PermitAction action = PermitAction::kBrake;
    std::uint64_t ramp_until = 0;

    bool allows(std::uint64_t tick) const noexcept {
      return tick - cycle <= kPermitLife &&
             (action == PermitAction::kDrive || (action == PermitAction::kRamp && tick <= ramp_until));
    }
  };

  bool refuses(const GateReport& report) const noexcept;
  bool disobeys(const GateReport& report) const noexcept;
  void count(bool refused, std::uint64_t elapsed) noexcept;
  const Given* newest_before(std::uint64_t cycle) const noexcept;

  std::uint64_t loss_cycles_;
  std::uint64_t second_;       ///< ticks of the last second
  std::uint64_t permits_ = 0;  ///< remembered in this run
  std::array<Given, kRemembered> given_{};
  std::uint64_t refused_frames_ = 0;  ///< GateReport::refused at the last step
  std::uint64_t frame_ = 0;           ///< k of the last step; 0: none in this run
  std::uint64_t tick_ = 0;            ///< t of the last step
  std::uint64_t in_a_row_ = 0;
  std::uint64_t in_second_ = 0;
  std::size_t next_tick_ = 0;
  std::bitset<kMaxTicks> ticks_;  ///< of the last second: refused
};

}  // namespace robot_control
