#include "safety/conditions/common/frame_conditions.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

void add_if_persistent(StopCause cause, std::uint64_t cycles, std::uint64_t joint, ActiveCauses& out) noexcept {
  if (cycles < FrameConditions::kPersistence) return;
  out.add(cause, Reaction::kBrake,
          {.beyond = true,
           .value = static_cast<double>(cycles),
           .limit = static_cast<double>(FrameConditions::kPersistence),
           .joint = joint});
}

bool finite(const JointSample& joint) noexcept {
  return (!has(joint, kValidPosition) || std::isfinite(joint.position)) &&
         (!has(joint, kValidVelocity) || std::isfinite(joint.velocity)) &&
         (!has(joint, kValidEffort) || std::isfinite(joint.effort));
}

}  // namespace

void FrameConditions::step(const MonitorInput& input, ActiveCauses& out) noexcept {
  if (input.sensors == nullptr) return add_if_persistent(kCauseCorruptFrame, input.corrupt, kMaxJoints, out);
  corrupt_ = input.corrupt != 0 ? corrupt_ + 1 : 0;
  const bool numbers_finite = finite(*input.sensors) && (input.command == nullptr || finite(*input.command));
  not_finite_ = numbers_finite ? 0 : not_finite_ + 1;
  add_if_persistent(kCauseCorruptFrame, corrupt_, kMaxJoints, out);
  if (!numbers_finite) add_if_persistent(kCauseNotFinite, not_finite_, not_finite_joint(*input.sensors), out);
}

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
