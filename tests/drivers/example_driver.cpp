#include "drivers/example_driver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace robot_control {
namespace {

/// Cycles without a status: one may be late, by the jitter of a bus.
constexpr std::uint64_t kMaxSilence = 3;

double torque_of(const JointCommand& command, const JointSample& at) {
  switch (command.mode) {
    case JointMode::kEffort:
      return command.effort;
    case JointMode::kVelocity:
      return command.effort + command.damping * (command.velocity - at.velocity);
    case JointMode::kImpedance:
      return command.effort + command.stiffness * (command.position - at.position) +
             command.damping * (command.velocity - at.velocity);
    default:
      return std::nan("");  // kBrake, and a mode that is unknown
  }
}

}  // namespace

ExampleDriver::ExampleDriver(const MachineModel& robot, std::vector<std::unique_ptr<DriveLink>> links,
                             std::int64_t period_ns)
    : period_ns_(period_ns) {
  for (std::size_t i = 0; i < links.size(); ++i) {
    joints_.push_back({.link = std::move(links[i]), .effort_limit = robot.joints.at(i).effort_limit});
  }
}

// It may block: the loop does not run yet.
void ExampleDriver::start() {
  faults_ = 0;
  state_ = DriverState::kStarting;
  stopped_ = false;
  brake();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    DriveStatus status;
    for (int ms = 0; !joints_[i].link->receive(status); ++ms) {
      if (ms == 200)
        throw DriverError("the drive of joint " + std::to_string(i) + " is silent: look at cable and power");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    joints_[i].sample = status.joint;
    joints_[i].silent_for = 0;
  }
  state_ = DriverState::kRunning;
}

void ExampleDriver::read(SensorFrame& sensors) noexcept {
  for (Joint& joint : joints_) receive(joint);
  if (faults_ != 0) state_ = DriverState::kFault;
  sensors.driver_state = state_;
  sensors.faults = faults_;
  sensors.valid = 0;  // kValidGyro …, where there is an IMU
  sensors.joint_count = joints_.size();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    sensors.joints[i] = joints_[i].sample;
    sensors.joints[i].valid = faults_ == 0 ? kValidMotion : 0;
    sensors.joints[i].age_ns = static_cast<std::int64_t>(joints_[i].silent_for) * period_ns_;
  }
}

void ExampleDriver::receive(Joint& joint) noexcept {
  DriveStatus status;
  joint.silent_for = joint.link->receive(status) ? 0 : joint.silent_for + 1;
  if (joint.silent_for > kMaxSilence) faults_ |= kFaultLink;
  if (joint.silent_for > 0) return;
  joint.sample.fault = status.joint.fault;
  if (status.joint.fault != 0) faults_ |= kFaultDrive;
  if (!std::isfinite(status.joint.position + status.joint.velocity + status.joint.effort)) {
    faults_ |= kFaultNotFinite;
    return;
  }
  joint.sample = status.joint;
}

void ExampleDriver::write(std::span<const JointCommand> commands) noexcept {
  if (stopped_ || state_ != DriverState::kRunning || commands.size() != joints_.size()) return brake();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double torque = torque_of(commands[i], joints_[i].sample);
    if (std::isfinite(torque)) {
      joints_[i].link->send_torque(std::clamp(torque, -joints_[i].effort_limit, joints_[i].effort_limit));
    } else {
      joints_[i].link->send_brake();
    }
  }
}

void ExampleDriver::stop() noexcept {
  stopped_ = true;
  brake();
}

void ExampleDriver::brake() noexcept {
  for (const Joint& joint : joints_) joint.link->send_brake();
}

}  // namespace robot_control
