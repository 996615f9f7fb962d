#include "safety/conditions/common/gate_conditions.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

GateConditions::GateConditions(std::uint64_t loss_cycles, double period) noexcept
    : loss_cycles_(loss_cycles),
      second_(std::clamp<std::uint64_t>(static_cast<std::uint64_t>(std::llround(1 / period)), 1, kMaxTicks)) {}

void GateConditions::enter_run() noexcept {
  permits_ = refused_frames_ = in_a_row_ = in_second_ = 0;
  next_tick_ = 0;
  frame_ = tick_ = 0;
  ticks_.reset();
}

void GateConditions::remember(const Permit& permit, std::uint64_t cycle) noexcept {
  given_[permits_ % kRemembered] = {cycle, permit.action, permit.ramp_until};
  ++permits_;
}

void GateConditions::step(const SensorFrame& sensors, ActiveCauses& out) noexcept {
  const std::uint64_t frame = sensors.head.cycle;
  if (frame == 0) return;
  const GateReport& report = sensors.gate;
  const bool out_of_place = report.cycle >= frame || (report.cycle < frame_ && frame_ < frame);
  count(refuses(report), frame_ == 0 || out_of_place ? 1 : report.cycle - tick_);
  refused_frames_ = report.refused;
  const bool in_a_row = in_a_row_ >= loss_cycles_;
  if (in_a_row || 2 * in_second_ > second_) {
    const bool no_permit = (report.reasons & (kGateNoPermit | kGatePermitExpired)) != 0;
    const bool no_command = (report.reasons & kGateNoCommand) != 0;
    out.add(no_permit    ? kCauseMonitorLate
            : no_command ? kCauseCommandStale
                         : kCauseGateRefuses,
            Reaction::kBrake,
            {.beyond = true,
             .value = static_cast<double>(in_a_row ? in_a_row_ : in_second_),
             .limit = in_a_row ? static_cast<double>(loss_cycles_) : static_cast<double>(second_) / 2});
  }
  if (report.verdict != GateVerdict::kBrake && (out_of_place || disobeys(report)))
    out.add(kCauseGateDisobeys, Reaction::kBrake, {.beyond = true, .value = 1});
  frame_ = frame;
  tick_ = out_of_place ? frame - 1 : report.cycle;
}

bool GateConditions::refuses(const GateReport& report) const noexcept {
  const bool braked = report.verdict == GateVerdict::kBrake && (report.reasons & kGateControllerBrake) == 0;
  if (!braked && report.refused <= refused_frames_) return false;
  const Given* due = newest_before(report.cycle);
  return due != nullptr && due->allows(report.cycle);
}

/// The gate does not brake. A permit of a cycle for which none was issued is none.
bool GateConditions::disobeys(const GateReport& report) const noexcept {
  if (report.permit_cycle >= report.cycle || report.cycle - report.permit_cycle > kPermitLife) return true;
  const Given* used = newest_before(report.permit_cycle + 1);
  return used != nullptr && (used->cycle != report.permit_cycle || !used->allows(report.cycle));
}

const GateConditions::Given* GateConditions::newest_before(std::uint64_t cycle) const noexcept {
  for (std::uint64_t i = permits_; i > 0 && permits_ - i < kRemembered; --i) {
    const Given& permit = given_[(i - 1) % kRemembered];
    if (permit.cycle < cycle) return &permit;
  }
  return nullptr;
}

void GateConditions::count(bool refused, std::uint64_t elapsed) noexcept {
  in_a_row_ = refused ? in_a_row_ + elapsed : 0;
  for (std::uint64_t i = 0; i < std::min(elapsed, second_); ++i) {
    in_second_ += (refused ? 1u : 0u);
    in_second_ -= ticks_[next_tick_] ? 1u : 0u;
    ticks_[next_tick_] = refused;
    next_tick_ = next_tick_ + 1 == second_ ? 0 : next_tick_ + 1;
  }
}

}  // namespace robot_control
