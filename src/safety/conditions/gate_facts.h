#pragma once
/// Does the gate do what the permits say? The sensors of cycle k tell what it did in tick k−1.
///
///   due         the newest permit given of cycles ≤ k−2, which is what it should have used, if alive in tick k−1
///   refuses     due allowed motion (drive, or ramp while k−1 ≤ ramp_until), the tick braked or refused a frame, and
///               it was not the command that asked for the brake: loss_cycles ticks in a row, or in more than half of
///               the ticks of the last second. A controller that is slow or comes and goes, or a monitor whose permits
///               do not arrive: a robot that stops and drives on by itself is none that anybody can foresee.
///   disobeys    a command passed under a permit that ordered the brake, whose ramp was over, that had expired, or that
///               was never given: no software stops this machine any more, it waits for a repair
///
/// A permit of before the first step (of an earlier monitor) is judged by its age alone. Ticks that the monitor did not
/// look at count as the next one that it did.

#include <array>
#include <bitset>
#include <cstdint>

#include "safety/latch/active_causes.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class GateFacts {
 public:
  static constexpr std::size_t kMostTicks = 2048;  ///< of the last second

  /// `period` s.
  GateFacts(std::uint64_t loss_cycles, double period) noexcept;

  /// No permit of this run was given.
  void enter_run() noexcept;

  void step(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept;

  /// The permit of `cycle`, once each. One that is published again in its cycle (for display) the gate may have used or
  /// not; the first one counts.
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

  bool refuses(const GateReport& report, std::uint64_t tick) const noexcept;
  bool disobeys(const GateReport& report, std::uint64_t tick) const noexcept;
  void count(bool refused, std::uint64_t elapsed) noexcept;
  const Given& given(std::uint64_t i) const noexcept { return given_[i % kRemembered]; }

  std::uint64_t loss_cycles_;
  std::uint64_t second_;       ///< ticks of the last second
  std::uint64_t permits_ = 0;  ///< remembered in this run
  std::array<Given, kRemembered> given_{};
  std::uint64_t refused_frames_ = 0;  ///< GateReport::refused as last looked at
  std::uint64_t in_a_row_ = 0;
  std::uint64_t in_second_ = 0;
  std::size_t next_tick_ = 0;
  std::bitset<kMostTicks> ticks_;  ///< of the last second: refused
};

}  // namespace robot_control
