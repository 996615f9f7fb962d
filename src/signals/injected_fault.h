#pragma once
/// A fault of a simulated machine consists of a component, its index and a kind. The terms are those of the PX4 user
/// guide, "System Failure Injection". Encoders and motors are those of one joint, and their index is that of the joint.
/// All other components exist once and have the index 0.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_control {

enum class FaultComponent : std::uint8_t {
  kEncoder,
  kMotor,
  kGyro,
  kAccelerometer,
  kBattery,
  kEStopButton,
  kController,
  kEstimator,
  kMonitor,
};
inline constexpr std::size_t kFaultComponents = 9;

enum class FaultKind : std::uint8_t {
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

/// Returns whether each joint has such a component.
constexpr bool is_of_joint(FaultComponent component) noexcept {
  return component == FaultComponent::kEncoder || component == FaultComponent::kMotor;
}

struct InjectedFault {
  FaultComponent component{};
  std::uint8_t index = 0;
  FaultKind kind = FaultKind::kOk;

  bool operator==(const InjectedFault&) const = default;
};

/// This is enough for every encoder and motor of a robot with twelve joints.
inline constexpr std::size_t kMaxInjectedFaults = 24;

/// The faults stand first; the entries behind them are kOk. All zero means that everything is healthy.
using InjectedFaults = std::array<InjectedFault, kMaxInjectedFaults>;

constexpr bool any_fault(const InjectedFaults& faults) noexcept {
  return faults.front().kind != FaultKind::kOk;
}

constexpr FaultKind fault_of(const InjectedFaults& faults, FaultComponent component, std::size_t index = 0) noexcept {
  for (const InjectedFault& fault : faults) {
    if (fault.kind == FaultKind::kOk) break;
    if (fault.component == component && fault.index == index) return fault.kind;
  }
  return FaultKind::kOk;
}

/// Begins, changes or, with kOk, ends a fault. Returns false, and changes nothing, if there are kMaxInjectedFaults
/// others.
constexpr bool set_fault(InjectedFaults& faults, const InjectedFault& fault) noexcept {
  const auto same = [&](const InjectedFault& other) {
    return other.kind == FaultKind::kOk || (other.component == fault.component && other.index == fault.index);
  };
  const auto entry = std::find_if(faults.begin(), faults.end(), same);
  if (entry == faults.end()) return fault.kind == FaultKind::kOk;
  if (fault.kind != FaultKind::kOk) {
    *entry = fault;
  } else {
    std::move(entry + 1, faults.end(), entry);
    faults.back() = {};
  }
  return true;
}

}  // namespace robot_control
