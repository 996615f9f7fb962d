#pragma once
/// The state machine of one VESC that is ordered currents, or speeds (takes_speeds).
///
///   first frame → CAN status messages 1, 4 and 5 → ready → running
///
/// Before `running` the drive is ordered the current 0 in each cycle, so that no order of an earlier program remains.
/// It cannot be asked for its configuration: what it does on silence is stated in the drive file.
///
/// The tachometer has few counts: 6 per electrical turn. Between two counts the position follows the speed that the
/// drive reports. Each message corrects kCorrected of what it lies beyond half a count of the tachometer. More than a
/// count is corrected at once. Without that share, each message that is late by 1 ms would be a step of the speed.
///
/// Way and speed are compared every kComparedCounts: a drive whose tachometer has another unit is refused.
///
/// The fault codes of a VESC are not on CAN. So a drive that gives no current for kReleasedNs is in fault where its
/// order needs one. Such an order is a current of at least kMinCurrent below the velocity limit, or a speed that is off
/// by kMaxLag of that limit. Then it does not obey again by itself until the reset.
///
/// In a fault it is ordered the speed zero, or a brake current, which needs no measurement of this program.

#include <cstdint>
#include <optional>

#include "drivers/drive/drive.h"
#include "drivers/vesc/vesc_messages.h"
#include "drivers/vesc/vesc_parameters.h"

namespace robot_control::vesc {

class VescDrive final : public Drive {
 public:
  static constexpr double kComparedCounts = 60;
  static constexpr double kUnitTolerance = 0.25;
  static constexpr double kCorrected = 0.05;
  static constexpr std::int64_t kReleasedNs = 100'000'000;
  static constexpr double kMinCurrent = 0.5;  ///< A; ten times the current below which the firmware gives none
  static constexpr double kNoCurrent = 0.1;   ///< A, one step of the message
  static constexpr double kMaxLag = 0.1;

  VescDrive(const VescParameters& parameters, double period);

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept override;
  std::vector<PlannedFrames> plan() const override;

 private:
  void restart(bool reset, std::int64_t now_ns) noexcept override;
  void advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept override;
  void add_details(DriveStatus& /*status*/) const noexcept override {}
  std::string code_words(const DriveStatus& status) const override;

  void receive_status(const Status& status, std::int64_t now_ns) noexcept;
  void receive_position(const Status5& status, std::int64_t now_ns) noexcept;
  void compare_units(double moved) noexcept;
  const char* missing_message(std::int64_t now_ns) const noexcept;  ///< null: none
  bool needs_current(const DriveCommand& command) const noexcept;
  void judge_release(const DriveCommand& command, std::int64_t now_ns) noexcept;
  can_frame order(const DriveCommand& command) const noexcept;
  can_frame brake(const DriveCommand& command) const noexcept;
  std::uint8_t node() const noexcept { return static_cast<std::uint8_t>(drive_parameters().node); }

  VescParameters parameters_;
  double count_;  // rad of the motor
  bool seen_ = false;
  bool running_ = false;
  std::int64_t status_ns_ = 0, temperature_ns_ = 0;  // when they were received; 0: not yet
  double velocity_ = 0;                              // rad/s, of the motor
  double current_ = 0;                               // A, without the sign
  std::optional<std::int64_t> counts_;               // continued over the overflow of 32 bits
  double position_ = 0;                              // rad, of the motor
  std::int64_t position_ns_ = 0;
  double compared_way_ = 0, compared_travel_ = 0;  // rad, by counts and by speed, since the last comparison
  std::int64_t current_ns_ = 0;                    // the last time with a current, or without the need of one
};

}  // namespace robot_control::vesc
