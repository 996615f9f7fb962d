#include "safety/standstill.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

void JointStandstill::step(const SensorFrame& sensors) noexcept {
  const bool valid = (sensors.valid & kValidJoints) != 0;
  bool finite = true;
  bool slow = true;
  const std::size_t count = std::min<std::size_t>({sensors.joint_count, kMaxJoints, wheels_});
  for (std::size_t i = 0; i < count; ++i) {
    const double speed = std::abs(sensors.joints[i].velocity);
    finite = finite && std::isfinite(speed);
    slow = slow && speed < standstill_speed_;
  }
  const bool known = valid && finite;
  moving_ = !known || (!slow && !standing());
  slow_cycles_ = known && slow ? slow_cycles_ + 1 : 0;
}

}  // namespace robot_control
