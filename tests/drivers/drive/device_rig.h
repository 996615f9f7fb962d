#pragma once
/// Drives and their devices on a bus in virtual time, each motor with a simple inertia.

#include <gtest/gtest.h>

#include "drivers/ak/ak_device.h"
#include "drivers/ak/ak_drive.h"
#include "drivers/cia402/cia402_device.h"
#include "drivers/cia402/cia402_drive.h"
#include "drivers/cybergear/cybergear_device.h"
#include "drivers/cybergear/cybergear_drive.h"
#include "drivers/damiao/damiao_device.h"
#include "drivers/damiao/damiao_drive.h"
#include "drivers/drive/drive_set.h"
#include "drivers/moteus/moteus_device.h"
#include "drivers/moteus/moteus_drive.h"
#include "drivers/odrive/odrive_device.h"
#include "drivers/odrive/odrive_drive.h"
#include "drivers/vesc/vesc_device.h"
#include "drivers/vesc/vesc_drive.h"

namespace robot_control {

class DeviceRig {
 public:
  static constexpr std::int64_t kStepNs = 125'000;
  static constexpr std::uint8_t kHostNode = 127;

  explicit DeviceRig(double rate = 500, double bit_rate = 1.0e6, std::uint64_t seed = 1)
      : period_(1 / rate),
        bus_(bit_rate, seed, 5 * bit_rate),
        host_(bus_.join([this](const can_frame& frame, std::int64_t now_ns) {
          if (host_lives && answers) received_.push_back({frame, now_ns});
        })) {}

  double period() const { return period_; }
  VirtualCan& bus() { return bus_; }
  std::size_t host() const { return host_; }
  std::int64_t now_ns() const { return now_ns_; }
  DeviceMotor& motor(std::size_t i = 0) { return *motors_.at(i); }
  Drive& drive(std::size_t i = 0) { return drives()[i]; }
  Device& device(std::size_t i = 0) { return *devices_.at(i); }

  DeviceMotor& add_motor() { return *motors_.emplace_back(std::make_unique<DeviceMotor>()); }
  template <class DeviceType>
  DeviceType& add_device(std::unique_ptr<DeviceType> device) {
    DeviceType& added = *device;
    devices_.push_back(std::move(device));
    return added;
  }
  void add_drive(const odrive::OdriveParameters& parameters) { odrives_.push_back(parameters); }
  void add_drive(const cia402::Cia402Parameters& parameters) { cia402s_.push_back(parameters); }
  void add_drive(const vesc::VescParameters& parameters) { vescs_.push_back(parameters); }
  void add_drive(const damiao::DamiaoParameters& parameters) { damiaos_.push_back(parameters); }
  void add_drive(const cybergear::CybergearParameters& parameters) { cybergears_.push_back(parameters); }
  void add_drive(const ak::AkParameters& parameters) { aks_.push_back(parameters); }
  void add_drive(const moteus::MoteusParameters& parameters) { moteuses_.push_back(parameters); }
  /// Returns the drives of the one dialect that was added.
  DriveSet made_drives() const {
    if (!odrives_.empty()) return drives_of<odrive::OdriveDrive>(odrives_, period_);
    if (!vescs_.empty()) return drives_of<vesc::VescDrive>(vescs_, period_);
    if (!damiaos_.empty()) return drives_of<damiao::DamiaoDrive>(damiaos_, period_);
    if (!cybergears_.empty()) return drives_of<cybergear::CybergearDrive>(cybergears_, period_);
    if (!aks_.empty()) return drives_of<ak::AkDrive>(aks_, period_);
    if (!moteuses_.empty()) return drives_of<moteus::MoteusDrive>(moteuses_, period_);
    return cia402::cia402_drives(cia402s_, kHostNode, period_);
  }
  /// No drive may be added after the first call.
  DriveSet& drives() {
    if (!drives_) drives_.emplace(made_drives());
    return *drives_;
  }

  /// One command per drive.
  std::vector<DriveCommand> commands;
  bool host_lives = true;
  bool answers = true;    ///< The host receives what the devices send.
  double inertia = 0.01;  ///< kg·m² of each motor
  double slope = 0;       ///< N·m that pulls each motor

  void cycle() {
    const auto end_ns = now_ns_ + std::llround(1.0e9 * period_);
    if (host_lives) run_host();
    while (now_ns_ < end_ns) advance();
  }
  void run(double seconds) {
    for (long i = 0; i < std::lround(seconds / period_); ++i) cycle();
  }
  /// Returns whether it came true within the time.
  bool run_until(const std::function<bool()>& condition, double seconds) {
    for (long i = 0; i < std::lround(seconds / period_) && !condition(); ++i) cycle();
    return condition();
  }
  bool all_are(DrivePhase state) {
    for (std::size_t i = 0; i < drives().size(); ++i) {
      if (drive(i).status().state != state) return false;
    }
    return true;
  }
  void command_all(const DriveCommand& command) { commands.assign(drives().size(), command); }
  void reset() {
    command_all({.enabled = true, .reset = true});
    cycle();
  }
  ::testing::AssertionResult runs(double seconds = 5) {
    command_all({.enabled = true});
    if (run_until([this] { return all_are(DrivePhase::kRunning); }, seconds)) return ::testing::AssertionSuccess();
    auto failure = ::testing::AssertionFailure();
    for (std::size_t i = 0; i < drives().size(); ++i) failure << drive(i).words() << '\n';
    return failure;
  }

 private:
  void run_host() {
    send_.clear();
    for (const Received& each : received_) drives().receive(each.frame, each.stamp_ns);
    received_.clear();
    drives().step(commands, now_ns_, {&send_, 1});
    for (const can_frame& frame : send_.frames()) bus_.send(host_, frame);
  }
  void advance() {
    now_ns_ += kStepNs;
    bus_.advance(now_ns_);
    for (const auto& device : devices_) device->step(now_ns_);
    for (const auto& motor : motors_) {
      motor->velocity += (motor->torque + slope) / inertia * 1.0e-9 * static_cast<double>(kStepNs);
      motor->position += motor->velocity * 1.0e-9 * static_cast<double>(kStepNs);
    }
  }

  struct Received {
    can_frame frame{};
    std::int64_t stamp_ns = 0;
  };
  double period_;
  VirtualCan bus_;
  std::vector<Received> received_;
  std::size_t host_;
  std::int64_t now_ns_ = 0;
  std::vector<std::unique_ptr<DeviceMotor>> motors_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<odrive::OdriveParameters> odrives_;
  std::vector<cia402::Cia402Parameters> cia402s_;
  std::vector<vesc::VescParameters> vescs_;
  std::vector<damiao::DamiaoParameters> damiaos_;
  std::vector<cybergear::CybergearParameters> cybergears_;
  std::vector<ak::AkParameters> aks_;
  std::vector<moteus::MoteusParameters> moteuses_;
  std::optional<DriveSet> drives_;
  FrameBatch send_;
};

inline DriveParameters drive_parameters(std::uint64_t node) {
  return {.joint = "wheel_" + std::to_string(node),
          .node = node,
          .direction = node % 2 == 0 ? 1 : -1,
          .gear = 2.5,
          .torque_limit = 4,
          .velocity_limit = 40,
          .max_temperature = 90,
          .min_voltage = 18,
          .on_silence = SilenceReaction::kCoasts};
}

/// An axis that matches its drive.
struct OdrivePair {
  odrive::OdriveParameters drive;
  OdriveDeviceParameters device;
};

inline OdrivePair odrive_pair(std::uint8_t node, odrive::Firmware firmware = odrive::Firmware::k06) {
  OdrivePair pair{.drive = {.drive = drive_parameters(node), .torque_constant = 0.1}, .device = {}};
  pair.device.node = node;
  pair.device.firmware = firmware;
  pair.device.torque_constant = pair.drive.torque_constant;
  return pair;
}

inline OdriveDevice& add(DeviceRig& rig, const OdrivePair& pair) {
  rig.add_drive(pair.drive);
  return rig.add_device(std::make_unique<OdriveDevice>(pair.device, rig.bus(), rig.add_motor()));
}

struct VescPair {
  vesc::VescParameters drive;
  VescDeviceParameters device;
};

inline VescPair vesc_pair(std::uint8_t node) {
  VescPair pair{.drive = {.drive = drive_parameters(node), .pole_pairs = 7, .torque_constant = 0.1}, .device = {}};
  pair.device.node = node;
  return pair;
}

inline VescDevice& add(DeviceRig& rig, const VescPair& pair) {
  rig.add_drive(pair.drive);
  return rig.add_device(std::make_unique<VescDevice>(pair.device, rig.bus(), rig.add_motor()));
}

struct DamiaoPair {
  damiao::DamiaoParameters drive;
  DamiaoDeviceParameters device;
};

inline DamiaoPair damiao_pair(std::uint8_t node) {
  DamiaoPair pair{.drive = {.drive = drive_parameters(node)}, .device = {}};
  pair.drive.drive.min_voltage = 0;
  pair.drive.drive.on_silence = SilenceReaction::kUnknown;
  pair.drive.ranges = pair.device.ranges;
  pair.device.node = node;
  pair.device.answers = node + 16U;
  return pair;
}

inline DamiaoDevice& add(DeviceRig& rig, const DamiaoPair& pair) {
  rig.add_drive(pair.drive);
  return rig.add_device(std::make_unique<DamiaoDevice>(pair.device, rig.bus(), rig.add_motor()));
}

struct CybergearPair {
  cybergear::CybergearParameters drive;
  CybergearDeviceParameters device;
};

inline CybergearPair cybergear_pair(std::uint8_t node) {
  CybergearPair pair;
  pair.drive.drive = drive_parameters(node);
  pair.drive.drive.min_voltage = 0;
  pair.drive.drive.on_silence = SilenceReaction::kUnknown;
  pair.drive.motor_gear = 7.75;
  pair.drive.ranges = pair.device.ranges = {.position = 12.566, .velocity = 50, .torque = 12};
  pair.device.node = node;
  return pair;
}

inline CybergearDevice& add(DeviceRig& rig, const CybergearPair& pair) {
  rig.add_drive(pair.drive);
  return rig.add_device(std::make_unique<CybergearDevice>(pair.device, rig.bus(), rig.add_motor()));
}

struct AkPair {
  ak::AkParameters drive;
  AkDeviceParameters device;
};

inline AkPair ak_pair(std::uint8_t node) {
  AkPair pair;
  pair.drive.drive = drive_parameters(node);
  pair.drive.drive.min_voltage = 0;
  pair.drive.drive.on_silence = SilenceReaction::kKeeps;
  pair.drive.motor_gear = 9;
  pair.drive.ranges = pair.device.ranges;
  pair.device.node = node;
  return pair;
}

inline AkDevice& add(DeviceRig& rig, const AkPair& pair) {
  rig.add_drive(pair.drive);
  return rig.add_device(std::make_unique<AkDevice>(pair.device, rig.bus(), rig.add_motor()));
}

struct MoteusPair {
  moteus::MoteusParameters drive;
  MoteusDeviceParameters device;
};

inline MoteusPair moteus_pair(std::uint8_t node) {
  MoteusPair pair;
  pair.drive.drive = drive_parameters(node);
  pair.drive.drive.min_voltage = 0;
  pair.drive.drive.on_silence = SilenceReaction::kBrakes;
  pair.drive.motor_gear = 6;
  pair.drive.kp = 3000;
  pair.drive.kd = 30;
  pair.device.node = node;
  pair.device.gains = pair.drive.ranges_of_orders();
  return pair;
}

inline MoteusDevice& add(DeviceRig& rig, const MoteusPair& pair) {
  rig.add_drive(pair.drive);
  return rig.add_device(std::make_unique<MoteusDevice>(pair.device, rig.bus(), rig.add_motor()));
}

struct Cia402Pair {
  cia402::Cia402Parameters drive;
  Cia402DeviceParameters device;
};

inline Cia402Pair cia402_pair(std::uint8_t node) {
  Cia402Pair pair{.drive = {.drive = drive_parameters(node)}, .device = {}};
  pair.drive.drive.on_silence = SilenceReaction::kUnknown;
  pair.device.node = node;
  return pair;
}

inline Cia402Device& add(DeviceRig& rig, const Cia402Pair& pair) {
  rig.add_drive(pair.drive);
  return rig.add_device(
      std::make_unique<Cia402Device>(pair.device, rig.bus(), std::vector<DeviceMotor*>{&rig.add_motor()}));
}

}  // namespace robot_control
