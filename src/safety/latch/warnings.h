#pragma once
/// Active causes that do not latch: they are reported, and may limit the speed (Reaction::kWarn, kSlow).
///
/// Each is held for kWarningHold after its condition has ended, so that neither a display nor the speed limit flickers.

#include <array>
#include <cstdint>

#include "safety/latch/active_causes.h"

namespace robot_control {

inline constexpr double kWarningHold = 1.0;  ///< s

class Warnings {
 public:
  /// `period` s.
  explicit Warnings(double period) noexcept;

  void enter_run() noexcept { warning_ = slowing_ = 0; }
  void step(const ActiveCauses& active, std::uint64_t cycle, std::uint64_t elapsed) noexcept;

  /// StopCause bits.
  std::uint64_t bits() const noexcept { return warning_ | slowing_; }
  bool slowing() const noexcept { return slowing_ != 0; }

  /// The last measurement of the lowest of these bits, which is set, with the cycle since which it is active.
  const CauseEvidence& evidence(std::uint64_t causes) const noexcept;

 private:
  struct Held {
    std::uint64_t left = 0;  ///< cycles
    CauseEvidence evidence;
  };

  void age(std::uint64_t elapsed) noexcept;

  std::uint64_t hold_cycles_;
  std::uint64_t warning_ = 0;
  std::uint64_t slowing_ = 0;
  std::array<Held, kStopCauses> held_{};  ///< by bit
};

}  // namespace robot_control
