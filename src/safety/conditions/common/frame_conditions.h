#pragma once
/// These conditions find input frames that cannot be trusted. The cause is active after kPersistence bad cycles in a
/// row; in a single bad cycle only the gate brakes.
///
///   corrupt     a checksum of this cycle's inputs was wrong; without a sensor frame the attempts to read one count
///   not finite  a number that sensors or command mark as valid is NaN or infinite (finite); reported with the joint
///               of the sample

#include <cstdint>

#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"
#include "signals/command_frame.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// Returns the first joint with a valid number that is not finite; kMaxJoints: none.
std::uint64_t not_finite_joint(const SensorFrame& sensors) noexcept;

/// Checks joints, gyro, accelerometer, contact forces and battery, as far as they are marked as valid.
bool finite(const SensorFrame& sensors) noexcept;

/// Checks used joints, the request and the limited twist.
bool finite(const CommandFrame& command) noexcept;

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
