#pragma once
/// The measurements that latched the causes: the first kMaxEvidence in the order of latching, with their values at that
/// time. They outlive a new run and a restart of the monitor; an accepted reset clears them.

#include <array>
#include <cstdint>

#include "safety/latch/active_causes.h"
#include "safety/latch/warnings.h"
#include "signals/permit.h"

namespace robot_control {

class Evidence {
 public:
  /// Records the causes that latch now and were not latched before.
  void latch(const ActiveCauses& active, std::uint64_t cycle) noexcept;

  /// Takes over the evidence of an earlier monitor's permit.
  void restore(const Permit& last) noexcept;

  void clear() noexcept {
    known_ = 0;
    count_ = 0;
  }

  /// The latched ones, then the warnings; the rest is empty.
  void write(const Warnings& warnings, std::array<CauseEvidence, kMaxEvidence>& out) const noexcept;

 private:
  std::uint64_t known_ = 0;  ///< latched causes, also those that did not fit
  std::size_t count_ = 0;
  std::array<CauseEvidence, kMaxEvidence> latched_{};
};

}  // namespace robot_control
