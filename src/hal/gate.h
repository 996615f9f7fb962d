#pragma once
/// The last check before the motors. It asks in this order, and the first "no" brakes:
///   1. is the permit alive (the monitor)?   2. does it allow motion?
///   3. is the command fresh (the controller)?   4. is every number finite, every checksum right?
/// Then it clamps. Up to 3 missed commands the last one holds; beyond, brake, unlatched and counted.

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

/// The newest command and permit that were latched at tick k are of cycles k-kCommandLife … k-1.
inline constexpr std::uint64_t kCommandLife = 4;

struct GateInput {
  std::uint64_t run = 0;
  std::uint64_t cycle = 0;  ///< k
  Lookup permit_found = Lookup::kMissing;
  const Permit* permit = nullptr;    ///< never null; meaningful when found
  Lookup command_found = Lookup::kMissing;
  const CommandFrame* command = nullptr;  ///< never null; meaningful when found
};

class Gate {
 public:
  /// One limit per joint, N·m or N.
  explicit Gate(std::vector<double> effort_limits);

  /// A new run: counters begin anew.
  void reset() noexcept;

  /// What the driver shall do in tick k: one command per joint. `report()` tells why.
  std::span<const JointCommand> step(const GateInput& input) noexcept;

  const GateReport& report() const noexcept;
};

}  // namespace robot_control
