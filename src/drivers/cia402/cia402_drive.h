#pragma once
/// The state machine of one axis of a CiA 402 drive in a torque mode, or in a velocity mode (takes_speeds).
///
///   pre-operational → objects (drive_setup.h) → NMT start → first TPDO → ready → shutdown → switch on →
///   enable operation → running
///
/// Each step of the power state machine waits for the statusword of the one before. In `running` the axis receives
/// controlword and target in each cycle, and answers each SYNC (drive_set.h). In a fault the controlword requests
/// a quick stop. A velocity with a PDO of its own replaces that of the position's PDO before it. One that the drive
/// file demands is judged for silence by itself; any other one is used while it comes. The error of a drive is reset
/// with the operator's reset alone.

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/cia402/cia402_parameters.h"
#include "drivers/cia402/drive_setup.h"
#include "drivers/cia402/power_state.h"
#include "drivers/drive/drive.h"
#include "drivers/drive/drive_set.h"

namespace robot_control::cia402 {

class Cia402Drive final : public Drive {
 public:
  Cia402Drive(const Cia402Parameters& parameters, std::uint8_t host, double period);

  /// Joins the two axes of one node, before the first step: the first one is set up first, and the second one starts
  /// the node. A fault of one is a fault of both, and a reset of one starts both again.
  static void join(Cia402Drive& first, Cia402Drive& second) noexcept;

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept override;
  std::vector<PlannedFrames> plan() const override;

  Mode mode() const noexcept { return setup_.mode(); }

 private:
  enum class Phase : std::uint8_t { kSetup, kStart, kReady, kPower, kRunning };

  void restart(bool reset, std::int64_t now_ns) noexcept override;
  void advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept override;
  void add_details(DriveStatus& status) const noexcept override { status.details[0] = emergency_; }
  VelocitySource velocity_source() const noexcept override;
  std::string code_words(const DriveStatus& status) const override;

  void receive_network(const can_frame& frame, std::int64_t now_ns) noexcept;
  void receive_state(const can_frame& frame, std::int64_t now_ns) noexcept;
  void judge_power() noexcept;
  void advance_setup(std::int64_t now_ns, FrameBatch& send) noexcept;
  void advance_power(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept;
  /// Returns whether the bit that resets a fault is to be set. Fails if no request to clear it is left.
  bool resets_fault(std::int64_t now_ns) noexcept;
  /// Returns the value in the cycle in which its answer has arrived, and requests it before.
  std::optional<std::uint32_t> read_object(const ObjectAddress& object, std::int64_t now_ns, FrameBatch& send) noexcept;
  void read_error(std::int64_t now_ns, FrameBatch& send) noexcept;
  void read_voltage(std::int64_t now_ns, FrameBatch& send) noexcept;
  /// Without a command the target is 0.
  void send_command(std::uint16_t controlword, FrameBatch& send, const DriveCommand& command = {}) const noexcept;
  void send_nmt(canopen::NmtCommand command, std::int64_t now_ns, FrameBatch& send) noexcept;
  bool needs_velocity() const noexcept { return parameters_.velocity_pdo == VelocityPdo::kTrue; }
  bool sends_velocity() const noexcept { return setup_.velocity_source() == VelocitySource::kDrive; }
  bool has_velocity(std::int64_t now_ns) const noexcept {
    return velocity_ns_ != 0 && now_ns - velocity_ns_ <= max_silence_ns();
  }
  bool set_up() const noexcept { return phase_ > Phase::kSetup; }
  std::uint8_t node() const noexcept { return static_cast<std::uint8_t>(drive_parameters().node); }

  Cia402Parameters parameters_;
  Cia402Drive* first_axis_ = nullptr;
  Cia402Drive* second_axis_ = nullptr;
  DriveSetup setup_;
  canopen::SdoClient reader_;  // of the error code and of the voltage
  Phase phase_ = Phase::kSetup;
  bool reset_ = false;
  std::uint16_t statusword_ = 0;
  PowerState power_ = PowerState::kUnknown;
  std::uint16_t emergency_ = 0;
  std::optional<std::int64_t> counts_;  // position, continued over the overflow of 32 bits
  double velocity_ = 0;                 // rad/s of the motor, from its PDO
  std::int64_t velocity_ns_ = 0;        // when it was received; 0: not yet
  std::int64_t next_nmt_ns_ = 0;
  std::int64_t deadline_ns_ = 0;
  unsigned reset_cycles_ = 0;  // for which the bit that resets a fault stays set
  std::int64_t next_reset_ns_ = 0;
  ObjectAddress read_{};  // requested of the reader
  bool has_voltage_ = true;
  std::int64_t next_voltage_ns_ = 0;
};

/// Returns the drives of these joints with their host. Two axes of one node belong together.
DriveSet cia402_drives(const std::vector<Cia402Parameters>& joints, std::uint8_t host_node, double period);

}  // namespace robot_control::cia402
