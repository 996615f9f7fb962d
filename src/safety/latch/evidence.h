#pragma once
/// By what the latched causes were told: the first kMaxEvidence in the order they came, each as it was found when it
/// latched. It outlives a new run and a restart of the monitor; an accepted reset clears it.

#include <array>
#include <cstdint>

#include "safety/latch/active_causes.h"
#include "safety/latch/warnings.h"
#include "signals/permit.h"

namespace robot_control {

class Evidence {
 public:
  /// Of what latches now, that which had not before.
  void latch(const ActiveCauses& active, std::uint64_t cycle) noexcept;

  /// What an earlier monitor's permit held of its latched causes.
  void restore(const Permit& last) noexcept;

  void clear() noexcept {
    known_ = 0;
    count_ = 0;
  }

  /// The latched ones, then the warnings, then nothing.
  void write(const Warnings& warnings, std::array<CauseEvidence, kMaxEvidence>& out) const noexcept;

 private:
  std::uint64_t known_ = 0;  ///< latched causes, those among them for which there was no place, too
  std::size_t count_ = 0;
  std::array<CauseEvidence, kMaxEvidence> latched_{};
};

}  // namespace robot_control
