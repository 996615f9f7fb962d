#pragma once
/// Causes whose reaction the user cannot set (CAUSE in signals/stop_causes.def): either the control chain itself cannot
/// be trusted, or a stop was commanded. All other causes are conditions of SafetyParameters, with the reaction that is
/// set there.

#include <array>
#include <cstdint>

#include "signals/permit.h"

namespace robot_control {

enum class FixedReaction : std::uint8_t {
  kBrake,  ///< stop category 0 of IEC 60204-1 (2016), 9.2.2: brake at once; STOPPED
  kFault,  ///< the same; FAULT: the machine has to be repaired before a reset
  kRamp,   ///< stop category 1: ramp down under supervision, then brake
};

struct FixedCause {
  StopCause cause;
  FixedReaction reaction;
};

// clang-format off
inline constexpr auto kFixedCauses = std::to_array<FixedCause>({
#define CAUSE(id, name, sentence, remedy, actor, unit, reaction) {kCause##id, FixedReaction::reaction},
#define CONDITION(...)
#define CONDITION_WITHOUT_LIMIT(...)
#include "signals/stop_causes.def"
});
// clang-format on

/// All fixed causes with one reaction, as bits.
constexpr std::uint64_t causes_of(FixedReaction reaction) noexcept {
  std::uint64_t bits = 0;
  for (const FixedCause& row : kFixedCauses) {
    if (row.reaction == reaction) bits |= row.cause;
  }
  return bits;
}

/// Those of `causes` that lead to FAULT.
constexpr std::uint64_t leading_to_fault(std::uint64_t causes) noexcept {
  return causes & causes_of(FixedReaction::kFault);
}

inline constexpr std::uint64_t kAllCauses = (std::uint64_t{1} << kStopCauses) - 1;

}  // namespace robot_control
