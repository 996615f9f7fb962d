#pragma once
/// The last check before the motors. It asks in this order, and the first "no" brakes:
///   1. is the permit alive (the monitor)?   2. does it allow motion?
///   3. is the command fresh (the controller)?   4. is every number finite, every checksum right?
/// Then it clamps. Up to 3 missed commands the last one holds; beyond, brake, unlatched and counted.
///
/// At tick k (all of the driver's present run, else the frame counts as missing):
///   permit   cycle < k  ∧  k ≤ min(expiry, cycle + kPermitLife)
///   action   kDrive, or kRamp while k ≤ ramp_until
///   command  k − kCommandLife ≤ cycle ≤ k − 1; older than k − 1 is *held*
///   numbers  every field of every joint finite, every mode a JointMode, joint_count the robot's
///   clamp    |effort| ≤ the joint's limit; the driver clamps the total torque of its law
/// Tick 0 brakes. A brake is JointCommand{} on every joint. A frame counted in `refused` is one that was
/// there and was not believed; a tick counted in `missed` is one that only the command was missing in.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rt/latest_frames.h"
#include "signals/command_frame.h"
#include "signals/gate_report.h"
#include "signals/joint.h"
#include "signals/permit.h"

namespace robot_control {

struct GateInput {
  std::uint64_t run = 0;
  std::uint64_t cycle = 0;  ///< k
  Lookup permit_found = Lookup::kMissing;
  const Permit* permit = nullptr;  ///< never null; meaningful when found
  Lookup command_found = Lookup::kMissing;
  const CommandFrame* command = nullptr;  ///< never null; meaningful when found
};

class Gate {
 public:
  /// One limit per joint, N·m or N, ≥ 0. Throws std::invalid_argument: NaN, negative, more than kMaxJoints.
  explicit Gate(std::vector<double> effort_limits);

  /// A new run: counters begin anew.
  void reset() noexcept;

  /// What the driver shall do in tick k: one command per joint. `report()` tells why.
  std::span<const JointCommand> step(const GateInput& input) noexcept;

  const GateReport& report() const noexcept { return report_; }

 private:
  bool permitted(const GateInput& input) noexcept;
  bool fresh(const GateInput& input) noexcept;
  bool sound(const CommandFrame& command) noexcept;
  void clamp() noexcept;

  std::size_t joint_count_ = 0;
  std::array<double, kMaxJoints> effort_limits_{};
  std::array<JointCommand, kMaxJoints> commands_{};
  GateReport report_;
};

}  // namespace robot_control
