#include "safety/standstill.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

void JointStandstill::step(const SensorFrame& sensors) noexcept {
  bool slow = (sensors.valid & kValidJoints) != 0;
  const std::size_t count = std::min<std::size_t>({sensors.joint_count, kMaxJoints, wheels_});
  for (std::size_t i = 0; i < count; ++i) {
    slow = slow && std::abs(sensors.joints[i].velocity) < standstill_speed_;  // false for NaN
  }
  slow_cycles_ = slow ? slow_cycles_ + 1 : 0;
}

}  // namespace robot_control
