#include "safety/latch/warnings.h"

#include <bit>
#include <cmath>

namespace robot_control {
namespace {

std::size_t index_of(std::uint64_t causes) noexcept {
  return static_cast<std::size_t>(std::countr_zero(causes));
}

}  // namespace

Warnings::Warnings(double period) noexcept
    : hold_cycles_(static_cast<std::uint64_t>(std::llround(kWarningHold / period))) {}

const CauseEvidence& Warnings::evidence(std::uint64_t causes) const noexcept {
  return held_[index_of(causes)].evidence;
}

void Warnings::step(const ActiveCauses& active, std::uint64_t cycle, std::uint64_t elapsed) noexcept {
  age(elapsed);
  const std::uint64_t warning = active.with(Reaction::kWarn);
  const std::uint64_t slowing = active.with(Reaction::kSlow);
  for (const CauseEvidence& measurement : active.measurements()) {
    if ((measurement.cause & (warning | slowing)) == 0) continue;
    Held& held = held_[index_of(measurement.cause)];
    const std::uint64_t since = (bits() & measurement.cause) != 0 ? held.evidence.cycle : cycle;
    held = {.left = hold_cycles_, .evidence = measurement};
    held.evidence.cycle = since;
  }
  warning_ |= warning;
  slowing_ |= slowing;
}

void Warnings::age(std::uint64_t elapsed) noexcept {
  for (std::uint64_t rest = bits(); rest != 0; rest &= rest - 1) {
    const std::uint64_t cause = rest & (~rest + 1);
    Held& held = held_[index_of(cause)];
    if (held.left >= elapsed) {
      held.left -= elapsed;
    } else {
      warning_ &= ~cause;
      slowing_ &= ~cause;
    }
  }
}

}  // namespace robot_control
