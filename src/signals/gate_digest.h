#pragma once
/// A number for what the gate gave to the driver in one tick, to compare two ticks bit for bit.

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "signals/gate_report.h"
#include "signals/joint.h"

namespace robot_control {

/// Multiply-rotate hash over all words, as checksum_of.
inline std::uint64_t digest_of(std::span<const JointCommand> commands, const GateReport& report) noexcept {
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio, odd
  std::uint64_t hash = commands.size();
  const auto add = [&hash]<class Part>(const Part& part) {
    for (const std::uint64_t word : std::bit_cast<std::array<std::uint64_t, sizeof(Part) / 8>>(part)) {
      hash = std::rotl((hash ^ word) * kOdd, 29);
    }
  };
  for (const JointCommand& command : commands) add(command);
  add(report);
  return hash;
}

}  // namespace robot_control
