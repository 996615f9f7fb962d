#pragma once
/// A fault of a simulated machine consists of a component and a kind, in the terms of PX4 (PX4 user guide, "System
/// Failure Injection").

#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_control {

/// The values are indices of InjectedFaults. Left and right mean every wheel of that side.
enum class FaultComponent : std::size_t {
  kLeftEncoder,
  kRightEncoder,
  kGyro,
  kAccelerometer,
  kLeftMotor,
  kRightMotor,
  kController,
  kEstimator,
  kMonitor,
  kBattery,
  kEStopButton,
};
inline constexpr std::size_t kFaultComponents = 11;

enum class FaultKind : std::uint64_t {
  kOk,            ///< healthy again
  kOff,           ///< no output
  kStuck,         ///< the last output again and again
  kGarbage,       ///< random output
  kWrong,         ///< plausible and wrong
  kSlow,          ///< a new output every 10 cycles only
  kDelayed,       ///< the output of 10 cycles ago
  kIntermittent,  ///< off and on at random
};
inline constexpr std::size_t kFaultKinds = 8;

/// Returns whether the component is a node. The faults of nodes exist only in ClosedLoop, those of all other components
/// in the simulated plant.
constexpr bool is_node(FaultComponent component) noexcept {
  return component == FaultComponent::kController || component == FaultComponent::kEstimator ||
         component == FaultComponent::kMonitor;
}

using InjectedFaults = std::array<FaultKind, kFaultComponents>;  ///< all zero: everything is healthy

inline FaultKind fault_of(const InjectedFaults& faults, FaultComponent component) noexcept {
  return faults[static_cast<std::size_t>(component)];
}

/// Returns all faults in one number for the log, Σ kind · 8^component, with one octal digit per component. 0 means
/// healthy.
static_assert(3 * kFaultComponents <= 53, "the log's numbers are doubles");
constexpr std::uint64_t fault_code(const InjectedFaults& faults) noexcept {
  std::uint64_t code = 0;
  for (std::size_t i = 0; i < kFaultComponents; ++i) code |= (static_cast<std::uint64_t>(faults[i]) & 7u) << (3 * i);
  return code;
}

}  // namespace robot_control
