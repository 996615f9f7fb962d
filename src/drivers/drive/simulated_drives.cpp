#include "drivers/drive/simulated_drives.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "drivers/cia402/cia402_device.h"
#include "drivers/odrive/odrive_device.h"
#include "drivers/vesc/vesc_device.h"

namespace robot_control {
namespace {

constexpr double kVescCurrent = 10;      // A
constexpr double kOdriveWatchdog = 0.1;  // s, where the drive file says that it coasts on silence

double clock_of(std::size_t device) {
  return device % 2 == 0 ? SimulatedDrives::kClockPpm : -SimulatedDrives::kClockPpm;
}

/// The gain of a motor's speed loop is the damping of the brake, which is stable also for a lifted wheel.
double motor_damping(const DriveParameters& drive, const Brake& brake) {
  return brake.damping / (drive.gear * drive.gear);
}

OdriveDeviceParameters device_of(const odrive::OdriveParameters& drive, const Brake& brake, double clock_ppm) {
  return {.node = static_cast<std::uint8_t>(drive.drive.node),
          .firmware = drive.firmware == odrive::Firmware::k05 ? odrive::Firmware::k05 : odrive::Firmware::k06,
          .serial_number = drive.serial_number != 0 ? drive.serial_number : 1 + drive.drive.node,
          .torque_constant = drive.torque_constant,
          .counts_per_turn = drive.counts_per_turn,
          .heartbeat_period = drive.heartbeat_period,
          .estimates_period = drive.estimates_period,
          .effort_period = drive.effort_period,
          .watchdog_timeout = drive.drive.on_silence == SilenceReaction::kCoasts ? kOdriveWatchdog : 0,
          .enable_watchdog_endpoint = static_cast<std::uint16_t>(drive.enable_watchdog_endpoint),
          .watchdog_timeout_endpoint = static_cast<std::uint16_t>(drive.watchdog_timeout_endpoint),
          .speed_gain = motor_damping(drive.drive, brake),
          .clock_ppm = clock_ppm};
}

std::unique_ptr<Device> make_device(const OdriveDeviceParameters& device, VirtualCan& bus, DeviceMotor& motor) {
  return std::make_unique<OdriveDevice>(device, bus, motor);
}

/// Without a torque constant in the file the motor gives its greatest torque at kVescCurrent.
VescDeviceParameters device_of(const vesc::VescParameters& drive, const Brake& brake, double clock_ppm) {
  const double torque = drive.drive.torque_limit / drive.drive.gear;
  const double constant = drive.torque_constant > 0 ? drive.torque_constant : torque / kVescCurrent;
  return {.node = static_cast<std::uint8_t>(drive.drive.node),
          .pole_pairs = static_cast<double>(drive.pole_pairs),
          .torque_constant = constant,
          .max_current = torque / constant,
          .status_period = drive.status_period,
          .temperature_period = drive.temperature_period,
          .brake_current = drive.drive.on_silence == SilenceReaction::kBrakes ? torque / constant : 0,
          .speed_gain = motor_damping(drive.drive, brake),
          .clock_ppm = clock_ppm};
}

std::unique_ptr<Device> make_device(const VescDeviceParameters& device, VirtualCan& bus, DeviceMotor& motor) {
  return std::make_unique<VescDevice>(device, bus, motor);
}

Cia402DeviceParameters device_of(const cia402::Cia402Parameters& drive, const Brake& brake, double clock_ppm) {
  Cia402DeviceParameters device;
  device.node = static_cast<std::uint8_t>(drive.drive.node);
  device.fixed_mapping = drive.pdos == cia402::PdoSource::kFixed;
  device.rated_torque = drive.rated_torque != 0 ? drive.rated_torque : drive.drive.torque_limit / drive.drive.gear;
  if (drive.counts_per_turn != 0) device.counts_per_turn = drive.counts_per_turn;
  if (drive.velocity_unit != 0) device.velocity_unit = drive.velocity_unit;
  if (drive.vendor != 0) device.vendor = static_cast<std::uint32_t>(drive.vendor);
  if (drive.product != 0) device.product = static_cast<std::uint32_t>(drive.product);
  device.brake_damping = motor_damping(drive.drive, brake);
  device.brake_stiffness = brake.stiffness / (drive.drive.gear * drive.drive.gear);
  device.brake_hold_speed = brake.hold_speed * drive.drive.gear;
  if (drive.drive.takes_speeds) device.supported_modes = Cia402DeviceParameters::kSpeedModes;
  device.clock_ppm = clock_ppm;
  return device;
}

}  // namespace

SimulatedDrives::SimulatedDrives(const CanParameters& parameters, std::span<const Brake> brakes, double period,
                                 std::uint64_t seed)
    : bus_(parameters.bus.bit_rate, seed), period_ns_(std::llround(1.0e9 * period)) {
  std::visit([&](const auto& joints) { add(joints, brakes); }, parameters.joints);
  torques_.resize(motors_.size());
}

void SimulatedDrives::disturb(bool lossy, bool late) {
  bus_.lose(lossy ? kFrameLoss : 0);
  bus_.delay(late ? period_ns_ : 0);
}

template <class Joint>
void SimulatedDrives::add(const std::vector<Joint>& joints, std::span<const Brake> brakes) {
  for (const Joint& joint : joints) {
    to_motor_.push_back(static_cast<double>(joint.drive.direction) * joint.drive.gear);
    device_of_.push_back(devices_.size());
    DeviceMotor& motor = *motors_.emplace_back(std::make_unique<DeviceMotor>());
    const Brake& brake = brakes[motors_.size() - 1];
    devices_.push_back(make_device(device_of(joint, brake, clock_of(devices_.size())), bus_, motor));
  }
}

void SimulatedDrives::add(const std::vector<cia402::Cia402Parameters>& joints, std::span<const Brake> brakes) {
  std::map<std::uint64_t, std::map<std::uint64_t, std::size_t>> joints_by_axis_by_node;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    to_motor_.push_back(static_cast<double>(joints[i].drive.direction) * joints[i].drive.gear);
    motors_.push_back(std::make_unique<DeviceMotor>());
    joints_by_axis_by_node[joints[i].drive.node][joints[i].axis] = i;
  }
  device_of_.resize(joints.size());
  for (const auto& [node, joint_of_axis] : joints_by_axis_by_node) {
    std::vector<DeviceMotor*> motors;
    for (const auto& [axis, joint] : joint_of_axis) {
      motors.push_back(motors_[joint].get());
      device_of_[joint] = devices_.size();
    }
    const std::size_t first = joint_of_axis.begin()->second;
    const Cia402DeviceParameters device = device_of(joints[first], brakes[first], clock_of(devices_.size()));
    devices_.push_back(std::make_unique<Cia402Device>(device, bus_, std::move(motors)));
  }
}

void SimulatedDrives::move_motors(std::span<const JointSample> joints, double seconds) {
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    motors_[i]->position = to_motor_[i] * (joints[i].position + joints[i].velocity * seconds);
    motors_[i]->velocity = to_motor_[i] * joints[i].velocity;
  }
}

void SimulatedDrives::run(std::span<const JointSample> joints, std::int64_t until_ns) {
  const std::int64_t begin_ns = bus_.now_ns();
  const auto seconds = [](std::int64_t ns) { return 1.0e-9 * static_cast<double>(ns); };
  std::ranges::fill(torques_, 0);
  for (std::int64_t now_ns = begin_ns; now_ns < until_ns;) {
    bus_.advance(now_ns);
    move_motors(joints, seconds(now_ns - begin_ns));
    for (const auto& device : devices_) device->step(now_ns);
    const std::int64_t next_ns = std::min(now_ns + kStepNs, until_ns);
    const double share = seconds(next_ns - now_ns) / seconds(until_ns - begin_ns);
    for (std::size_t i = 0; i < motors_.size(); ++i) torques_[i] += share * to_motor_[i] * motors_[i]->torque;
    now_ns = next_ns;
  }
  bus_.advance(until_ns);
}

}  // namespace robot_control
