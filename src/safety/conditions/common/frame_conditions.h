#pragma once
/// These conditions find input frames that cannot be trusted. The cause is active after kPersistence bad cycles in a
/// row; in a single bad cycle only the gate brakes.
///
///   corrupt     a checksum of this cycle's inputs was wrong; without a sensor frame the attempts to read one count
///   not finite  a number that sensors or command mark as valid is NaN or infinite (finite.h); reported with the joint
///               of the sample

#include <cstdint>

#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"

namespace robot_control {

class FrameConditions {
 public:
  static constexpr std::uint64_t kPersistence = 3;  ///< cycles

  void enter_run() noexcept { corrupt_ = not_finite_ = 0; }
  void step(const MonitorInput& input, ActiveCauses& out) noexcept;

 private:
  std::uint64_t corrupt_ = 0;
  std::uint64_t not_finite_ = 0;
};

}  // namespace robot_control
