#pragma once
/// One Damiao motor in MIT mode (drivers/drive/mit/mit_drive.h).
///
/// The set-up reads registers and compares them with the drive file: a wrong range would scale every number. The
/// timeout is written where it differs, and read back: a motor that receives no order for that time releases itself.
/// The start clears the error of an earlier such time (kCommunicationLost).

#include <array>
#include <cstdint>

#include "drivers/damiao/damiao_messages.h"
#include "drivers/damiao/damiao_parameters.h"
#include "drivers/drive/mit/mit_drive.h"

namespace robot_control::damiao {

class DamiaoDrive final : public MitDrive {
 public:
  DamiaoDrive(const DamiaoParameters& parameters, double period);

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept override;
  std::vector<PlannedFrames> plan() const override;

 private:
  static constexpr std::array kRead{Register::kControlMode,   Register::kGear,        Register::kPositionRange,
                                    Register::kVelocityRange, Register::kTorqueRange, Register::kTimeout};

  void forget_motor() noexcept override;
  bool is_set_up() const noexcept override { return asked_ == kRead.size(); }
  can_frame set_up() noexcept override;
  void end_unanswered() noexcept override { fail(DriveCause::kNoAnswer, "its registers"); }
  bool is_on() const noexcept override { return state_ == State::kOn; }
  bool in_error() const noexcept override { return state_ > State::kOn; }
  std::uint64_t state_code() const noexcept override { return static_cast<std::uint64_t>(state_); }
  bool starts_from_error() const noexcept override { return state_ == State::kCommunicationLost; }
  can_frame clear() noexcept override { return encode(node(), Request::kClear); }
  can_frame enable() noexcept override { return encode(node(), Request::kEnable); }
  can_frame release() noexcept override { return encode(node(), Request::kRelease); }
  can_frame order(const MitCommand& command) noexcept override {
    return encode_mit(static_cast<canid_t>(node()), ranges(), command);
  }
  std::string code_words(const DriveStatus& status) const override;

  void receive_register(const RegisterAccess& answer) noexcept;

  canid_t answers_;        // identifier of its answers
  std::uint32_t timeout_;  // units of kTimeoutUnit
  State state_ = State::kOff;
  std::size_t asked_ = 0;  // place of the awaited register among those that are read
  Operation operation_ = Operation::kRead;
  bool written_ = false;
};

}  // namespace robot_control::damiao
