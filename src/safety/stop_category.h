#pragma once
/// How each cause stops the robot: stop categories of IEC 60204-1 (2016), 9.2.2.
///   0  brake at once
///   1  ramp down under supervision, then brake
/// A driver fault is category 0 and waits for a repair besides.

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
});

/// All causes of one category as bits.
constexpr std::uint64_t causes_of(StopCategory category) noexcept {
  std::uint64_t bits = 0;
  for (const StopRule& rule : kStopRules) {
    if (rule.category == category) bits |= rule.cause;
  }
  return bits;
}

inline constexpr std::uint64_t kAllCauses =
    causes_of(StopCategory::kBrake) | causes_of(StopCategory::kBrakeForRepair) | causes_of(StopCategory::kRamp);

}  // namespace robot_control
