#pragma once
/// How causes stop the robot: stop categories of IEC 60204-1 (2016), 9.2.2.
///   0  brake at once
///   1  ramp down under supervision, then brake
///
/// The causes of kStopRules have a fixed category, whatever the user sets: either the control chain itself cannot be
/// trusted, or a stop was commanded. Causes that need repair are of category 0 and lead to FAULT. All other causes are
/// conditions of SafetyParameters, with the reaction that is set there.

#include <array>
#include <cstdint>

#include "signals/permit.h"

namespace robot_control {

enum class StopCategory : std::uint8_t { kBrake, kBrakeForRepair, kRamp };

struct StopRule {
  StopCause cause;
  StopCategory category;
};

inline constexpr auto kStopRules = std::to_array<StopRule>({
    {kCauseEmergencyStopTopic, StopCategory::kBrake},
    {kCauseEmergencyStopService, StopCategory::kBrake},
    {kCauseEmergencyStopInput, StopCategory::kBrake},
    {kCauseDriverLost, StopCategory::kBrake},
    {kCauseDriverFault, StopCategory::kBrakeForRepair},
    {kCauseControllerLost, StopCategory::kBrake},
    {kCauseEstimatorLost, StopCategory::kBrake},
    {kCauseHeartbeatLost, StopCategory::kRamp},
    {kCauseMonitorRestarted, StopCategory::kBrake},
    {kCauseCorruptFrame, StopCategory::kBrake},
    {kCauseNotFinite, StopCategory::kBrake},
    {kCauseMonitorLate, StopCategory::kBrake},
    {kCauseCommandStale, StopCategory::kBrake},
    {kCauseGateRefuses, StopCategory::kBrake},
    {kCauseGateDisobeys, StopCategory::kBrakeForRepair},
    {kCauseLatchUnreadable, StopCategory::kBrake},
});

/// All fixed causes of one category as bits.
constexpr std::uint64_t causes_of(StopCategory category) noexcept {
  std::uint64_t bits = 0;
  for (const StopRule& rule : kStopRules) {
    if (rule.category == category) bits |= rule.cause;
  }
  return bits;
}

/// Those of `causes` that need repair.
constexpr std::uint64_t for_repair(std::uint64_t causes) noexcept {
  return causes & causes_of(StopCategory::kBrakeForRepair);
}

inline constexpr std::uint64_t kAllCauses = (std::uint64_t{1} << kStopCauses) - 1;

}  // namespace robot_control
