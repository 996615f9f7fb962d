#pragma once
/// The digest compares the gate's outputs of two ticks bit for bit.

#include <cstdint>
#include <span>

#include "signals/checksum.h"
#include "signals/gate_report.h"
#include "signals/joint.h"

namespace robot_control {

/// Returns the checksum of all commands to the driver and of the report.
inline std::uint64_t digest_of(std::span<const JointCommand> commands, const GateReport& report) noexcept {
  Checksum sum;
  sum.mix({reinterpret_cast<const char*>(commands.data()), commands.size_bytes()});
  sum.mix({reinterpret_cast<const char*>(&report), sizeof report});
  return sum.sum();
}

}  // namespace robot_control
