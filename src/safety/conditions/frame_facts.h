#pragma once
/// Can what was read be believed? kPersistence cycles in a row are a cause; a single one only costs the gate's brake.
///
///   corrupt     a checksum of this cycle's inputs was wrong
///   not finite  a number that sensors or command claim to be valid is NaN or infinite (finite.h); told with the joint
///               whose sample it is

#include <cstdint>

#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"

namespace robot_control {

class FrameFacts {
 public:
  static constexpr std::uint64_t kPersistence = 3;  ///< cycles

  void enter_run() noexcept { corrupt_ = not_finite_ = 0; }
  void step(const MonitorInput& input, ActiveCauses& out) noexcept;

 private:
  std::uint64_t corrupt_ = 0;
  std::uint64_t not_finite_ = 0;
};

}  // namespace robot_control
