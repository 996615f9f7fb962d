#include "safety/measurements/finite.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

bool finite(const JointSample& joint) noexcept {
  return (!has(joint, kValidPosition) || std::isfinite(joint.position)) &&
         (!has(joint, kValidVelocity) || std::isfinite(joint.velocity)) &&
         (!has(joint, kValidEffort) || std::isfinite(joint.effort));
}

}  // namespace

std::uint64_t not_finite_joint(const SensorFrame& sensors) noexcept {
  const std::uint64_t count = std::min<std::uint64_t>(sensors.joint_count, kMaxJoints);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!finite(sensors.joints[i])) return i;
  }
  return kMaxJoints;
}

bool finite(const SensorFrame& sensors) noexcept {
  if (not_finite_joint(sensors) < kMaxJoints) return false;
  if ((sensors.valid & kValidGyro) != 0 && !finite(sensors.imu.angular_velocity)) return false;
  if ((sensors.valid & kValidAccelerometer) != 0 && !finite(sensors.imu.linear_acceleration)) return false;
  for (std::size_t i = 0; i < kMaxContacts && i < sensors.contact_count; ++i) {
    if (sensors.contacts[i].valid != 0 && !finite(sensors.contacts[i].force)) return false;
  }
  return (sensors.valid & kValidBattery) == 0 ||
         (std::isfinite(sensors.battery_voltage) && std::isfinite(sensors.battery_current));
}

bool finite(const CommandFrame& command) noexcept {
  const std::size_t count = std::min<std::size_t>(command.joint_count, kMaxJoints);
  for (std::size_t i = 0; i < count; ++i) {
    if (!finite(command.joints[i])) return false;
  }
  return finite(command.requested) && finite(command.twist_limited);
}

}  // namespace robot_control
