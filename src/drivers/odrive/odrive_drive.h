#pragma once
/// The state machine of one ODrive axis (CANSimple) in torque mode, or in velocity mode (takes_speeds) with the torque
/// of the command as feed-forward.
///
///   heartbeat → version (no answer: 0.5) → address (0.6: serial number, a second drive) → watchdog, if its endpoints
///   are known → first position → ready → mode, zero input and limits in kZeroCycles cycles → closed loop → running
///
/// The zero input is sent in every cycle before closed loop, because the axis executes the last set-point that it has
/// received. That may be one of an earlier program. In closed loop the state of each heartbeat is judged: an axis may
/// become idle without an error. Errors are cleared before closed loop is requested. An ODrive whose watchdog expires
/// becomes idle: the joint coasts. Firmware 0.5 may report a position of zero until the axis is in closed loop, so
/// `running` begins with a position that came after this state.
///
/// An axis with torque brakes in a fault by its own loop of the speed. Its limit is then little above the speed at
/// which the fault came. With a failed encoder this loop may drive. The axis then releases its motor above that limit
/// (OVERSPEED, VELOCITY_LIMIT_VIOLATION). The driver sets the gain of an axis that takes torques, because torque mode
/// uses it as well. The earlier gain cannot be read, and the new one stays until the axis restarts.
///
/// The position is a float of turns, whose step grows with the number of turns. If the step exceeds max_position_step,
/// the position of the drive is set back by whole turns as soon as the axis has rested for kRestNs. The position of the
/// joint continues without a jump.

#include <cstdint>
#include <optional>

#include "drivers/drive/drive.h"
#include "drivers/odrive/odrive_messages.h"
#include "drivers/odrive/odrive_parameters.h"

namespace robot_control::odrive {

class OdriveDrive final : public Drive {
 public:
  static constexpr unsigned kTries = 6;  ///< All are lost once in 10⁶ at a loss of 5 % each way.
  static constexpr std::int64_t kRetryNs = 100'000'000;
  static constexpr unsigned kZeroCycles = 10;
  static constexpr std::int64_t kRestNs = 500'000'000;
  static constexpr double kRestSpeed = 0.05;      ///< rad/s of the motor
  static constexpr double kVelocityMargin = 1.5;  ///< Torque mode reduces the torque before the limit of the axis.

  OdriveDrive(const OdriveParameters& parameters, double period);

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept override;
  std::vector<PlannedFrames> plan() const override;

  Firmware firmware() const noexcept { return firmware_; }

 private:
  enum class Phase : std::uint8_t { kHeartbeat, kVersion, kAddress, kWatchdog, kPosition, kReady, kEnter, kRunning };

  void restart(bool reset, std::int64_t now_ns) noexcept override;
  void advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept override;
  void add_details(DriveStatus& status) const noexcept override;
  std::string code_words(const DriveStatus& status) const override;

  bool is_foreign_command(const can_frame& frame) const noexcept;
  void receive_heartbeat(const can_frame& frame, std::int64_t now_ns) noexcept;
  void receive_identity(const can_frame& frame) noexcept;
  void receive_estimates(const EncoderEstimates& estimates, std::int64_t now_ns) noexcept;
  void receive_measurements(const can_frame& frame, std::int64_t now_ns) noexcept;
  void receive_error_details(const can_frame& frame) noexcept;

  void enter(Phase phase) noexcept;
  void know_firmware(Firmware firmware) noexcept;
  bool clears(std::uint32_t error) const noexcept;
  void advance_identity(std::int64_t now_ns, FrameBatch& send) noexcept;
  void ask_watchdog(std::int64_t now_ns, FrameBatch& send) noexcept;
  void advance_power(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept;
  void request_measurements(std::int64_t now_ns, FrameBatch& send) noexcept;
  void keep_resolution(std::int64_t now_ns, FrameBatch& send) noexcept;
  void set_position(double position, FrameBatch& send) const noexcept;
  void clear_errors(std::int64_t now_ns, FrameBatch& send) noexcept;
  can_frame input(const DriveCommand& command) const noexcept;
  void send_mode(const DriveCommand& command, ControlMode control, double fastest, double torque,
                 FrameBatch& send) const noexcept;
  void send_brake(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept;
  void note_speed() noexcept;
  void send_idle(std::int64_t now_ns, FrameBatch& send) noexcept;
  bool due(std::int64_t& next_ns, std::int64_t interval_ns, std::int64_t now_ns) const noexcept;
  std::uint8_t node() const noexcept { return static_cast<std::uint8_t>(drive_parameters().node); }

  OdriveParameters parameters_;
  Phase phase_ = Phase::kHeartbeat;
  Firmware firmware_ = Firmware::kAny;
  bool reset_ = false;
  unsigned tries_ = 0;
  std::int64_t next_request_ns_ = 0;
  std::int64_t next_effort_ns_ = 0;
  std::int64_t next_slow_ns_ = 0;
  std::int64_t next_details_ns_ = 0;
  std::int64_t deadline_ns_ = 0;

  std::int64_t heartbeat_ns_ = 0;
  std::int64_t cleared_ns_ = 0;  // when the drive was last asked to clear its errors
  std::int64_t changed_ns_ = 0;  // when a heartbeat first had this state of the axis
  AxisState axis_state_ = AxisState::kUndefined;
  std::uint32_t axis_error_ = 0;
  std::array<std::uint64_t, 4> details_{};  // motor, encoder and controller of 0.5; disarm reason of 0.6
  std::uint64_t serial_number_ = 0;
  std::optional<bool> watchdog_enabled_;
  std::optional<double> watchdog_timeout_;

  double motor_position_ = 0;  // rad, of the drive
  double shift_ = 0;           // rad, the drive's zero since the first position
  double pending_shift_ = 0;   // rad, requested of the drive; 0: none
  std::int64_t moving_ns_ = 0;
  double fastest_ = 0;  // rad/s of the joint, of the last kBrakeTime before a fault
};

}  // namespace robot_control::odrive
