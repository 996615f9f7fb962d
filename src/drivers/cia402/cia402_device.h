#pragma once
/// A CiA 402 drive as a device, with one or two axes and the modes CST, TQ, CSV and PV (without a ramp). It has NMT,
/// both heartbeats, an SDO server, SYNC, EMCY and the power state machine. The mapping of its PDOs may be written.
///
/// Source: CiA 301 and CiA 402-2. On the loss of the host's heartbeat (1016) it sends EMCY 8130, becomes
/// pre-operational, and each axis follows 6007. A quick stop follows 605A and a fault 605E: the axis is damped down to
/// brake_hold_speed, and then released or, with 605A of 5 … 8, held.

#include <cstdint>
#include <vector>

#include "drivers/cia402/canopen.h"
#include "drivers/cia402/drive_objects.h"
#include "drivers/cia402/drive_units.h"
#include "drivers/cia402/object_dictionary.h"
#include "drivers/cia402/power_state.h"
#include "drivers/drive/device.h"
#include "drivers/drive/speed_loop.h"

namespace robot_control {

struct Cia402DeviceParameters {
  static constexpr std::uint32_t kTorqueModes = 0x208, kSpeedModes = 0x104;  ///< of 6502: TQ and CST; PV and CSV

  std::uint8_t node = 1;
  std::uint32_t supported_modes = kTorqueModes;
  bool fixed_mapping = false;  ///< Its PDOs hold what its modes need and cannot be changed.
  bool has_reactions = true;   ///< 1016, 1029, 6007, 605A and 605E exist.
  double rated_torque = 2;     ///< N·m
  double counts_per_turn = 4096;
  double velocity_unit = cia402::kRpm;  ///< rad/s; 60A9 exists where it is rpm
  double brake_damping = 1;             ///< N·m·s/rad, of its own brake
  double brake_stiffness = 25;          ///< N·m/rad
  double brake_hold_speed = 0.2;        ///< rad/s
  std::uint32_t vendor = 0x1A5;
  std::uint32_t product = 0x402;
  double clock_ppm = 0;
};

class Cia402Device final : public Device {
 public:
  /// One axis per motor.
  Cia402Device(const Cia402DeviceParameters& parameters, VirtualCan& bus, std::vector<DeviceMotor*> motors);

  ObjectDictionary& objects() { return objects_; }
  cia402::PowerState power(std::size_t axis = 0) const { return axes_.at(axis).power; }
  canopen::NmtState nmt() const { return nmt_; }

 private:
  struct Axis {
    DeviceMotor* motor = nullptr;
    cia402::PowerState power = cia402::PowerState::kSwitchOnDisabled;
    std::uint16_t controlword = 0;
    double zero = 0;         // rad, true position of its zero
    double torque = 0;       // N·m, of TQ with its slope
    SpeedLoop speed_loop{};  // of CSV and PV
    double held = 0;         // rad, true position that a quick stop holds
    std::int64_t updated_ns = 0;
    bool holding = false;
  };

  void add_objects();
  void add_axis_objects(unsigned axis);
  void add_pdos();
  void boot() override;
  void begin_fault() override;  // one of a motor belongs to the first axis
  void receive(const can_frame& frame, std::int64_t now_ns) override;
  void run(std::int64_t now_ns, double seconds) override;
  void receive_nmt(const canopen::NmtRequest& request);
  void receive_sdo(const canopen::SdoMessage& request);
  void receive_command(const can_frame& frame);
  std::uint32_t refusal(const canopen::SdoMessage& request) const;
  void map(canopen::Pdo& pdo) const;
  bool enabled(const canopen::Pdo& pdo) const;
  void send_states();
  void lose_host();
  void update_axis(unsigned axis);
  void refresh_objects(unsigned axis);
  void obey(unsigned axis, std::uint16_t controlword);
  void quick_stop(unsigned axis);
  void fail(unsigned axis, std::uint16_t code);
  double driven_torque(unsigned axis, double seconds);
  double speed_torque(unsigned axis, double seconds);
  double brake_torque(unsigned axis);
  double max_torque(unsigned axis) const;
  std::uint32_t at(const canopen::ObjectAddress& object, unsigned axis) const;

  Cia402DeviceParameters parameters_;
  std::vector<Axis> axes_;
  ObjectDictionary objects_;
  canopen::NmtState nmt_ = canopen::NmtState::kPreOperational;
  std::uint32_t syncs_ = 0;  // that were received
  bool announced_ = false;   // The boot-up message was sent.
  std::int64_t heartbeat_ns_ = 0;
  std::int64_t host_ns_ = -1;  // last heartbeat of the host; −1: none yet
};

}  // namespace robot_control
