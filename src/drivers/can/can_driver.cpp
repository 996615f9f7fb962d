#include "drivers/can/can_driver.h"

#include <algorithm>

namespace robot_control {
namespace {

DriverFault fault_of(DriveCause cause) noexcept {
  switch (cause) {
    case DriveCause::kSilent:
    case DriveCause::kNoAnswer:
      return kFaultLink;
    case DriveCause::kNotFinite:
      return kFaultNotFinite;
    default:
      return kFaultDrive;
  }
}

}  // namespace

CanDriver::CanDriver(const CanParameters& parameters, std::span<const Brake> brakes, double period, CanSocket socket,
                     std::function<CanTime()> clock)
    : bus_(std::move(socket)), drives_(parameters, period), clock_(std::move(clock)), commands_(drives_.size()) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    laws_.emplace_back(brakes[i], drives_[i].drive_parameters().torque_limit);
  }
}

void CanDriver::start() {
  reset_ = true;
  stopped_ = false;
  state_ = DriverState::kStarting;
  faults_ = 0;
  for (JointLaw& law : laws_) law.reset();
}

bool CanDriver::all_are(DriveState state) const noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (drives_[i].status().state != state) return false;
  }
  return true;
}

void CanDriver::judge_faults() noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const DriveStatus& status = drives_[i].status();
    if (status.state == DriveState::kFault && !reset_) faults_ |= fault_of(status.cause);
  }
  const bool fell_back = state_ == DriverState::kRunning && !all_are(DriveState::kRunning);
  if (fell_back && faults_ == 0) faults_ |= kFaultDrive;
  if (faults_ != 0) {
    state_ = DriverState::kFault;
  } else if (all_are(DriveState::kRunning)) {
    state_ = DriverState::kRunning;
  }
}

void CanDriver::read(SensorFrame& sensors) noexcept {
  const CanTime now = clock_();
  now_ns_ = now.time_ns;
  for (int i = 0; i < kMaxBatches; ++i) {
    const ReceivedFrames received = bus_.receive(now);
    for (const ReceivedFrame& each : received.frames) drives_.receive(each.frame, each.stamp_ns);
    if (!received.more) break;
  }
  judge_faults();
  sensors.driver_state = state_;
  sensors.faults = faults_;
  sensors.valid = 0;
  sensors.joint_count = drives_.size();
  sensors.battery_voltage = 0;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const DriveSample& sample = drives_[i].sample();
    JointSample& joint = sensors.joints[i];
    joint = sample.joint;
    joint.age_ns = now_ns_ - sample.stamp_ns;
    joint.valid = (sample.valid ? kValidPosition | kValidVelocity : 0U) | (sample.effort_valid ? kValidEffort : 0U);
    const DriveStatus& status = drives_[i].status();
    joint.fault = status.state == DriveState::kFault ? static_cast<std::uint32_t>(status.cause) : 0;
    if (sample.voltage > 0) sensors.battery_voltage = sample.voltage;
  }
  if (sensors.battery_voltage > 0) sensors.valid |= kValidBattery;
}

double CanDriver::wanted_torque(std::size_t joint, const JointCommand& command) noexcept {
  const DriveSample& sample = drives_[joint].sample();
  if (!sample.valid) {
    laws_[joint].reset();
    return 0;
  }
  const JointSample now = at_time(sample, now_ns_);
  return laws_[joint].step(command, now.position, now.velocity);
}

void CanDriver::write(std::span<const JointCommand> commands) noexcept {
  const bool obeys = !stopped_ && state_ == DriverState::kRunning && commands.size() == drives_.size();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    commands_[i] = {.enabled = true, .reset = reset_, .torque = wanted_torque(i, obeys ? commands[i] : JointCommand{})};
  }
  reset_ = false;
  send_.clear();
  drives_.step(commands_, now_ns_, send_);
  bus_.send(send_.frames());
}

std::vector<std::string> CanDriver::words() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < drives_.size(); ++i) lines.push_back(drives_[i].words());
  return lines;
}

}  // namespace robot_control
