#pragma once
/// One CyberGear or RobStride motor in its operation control mode, which is the MIT mode
/// (drivers/drive/mit/mit_drive.h).
///
/// The set-up reads the mode, and the limit of the torque: one above torque_range shows that the motor is of another
/// type. It writes the timeout, and reads it back. Older firmware has none, and keeps its last order for ever. Such a
/// motor is refused, unless the drive file accepts that with `on_silence: keeps`.
///
/// The ranges follow from the type, and cannot be read. So its velocities are compared with its positions
/// (drivers/drive/mit/motion_scale.h).

#include <array>
#include <cstdint>

#include "drivers/cybergear/cybergear_messages.h"
#include "drivers/cybergear/cybergear_parameters.h"
#include "drivers/drive/mit/mit_drive.h"

namespace robot_control::cybergear {

class CybergearDrive final : public MitDrive {
 public:
  CybergearDrive(const CybergearParameters& parameters, double period);

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept override;
  std::vector<PlannedFrames> plan() const override;

 private:
  static constexpr std::array kRead{Parameter::kRunMode, Parameter::kTorqueLimit, Parameter::kTimeout};
  static constexpr unsigned kWrites = 5;  // of the timeout; all are lost once in 10⁶ at a loss of 5 %

  void forget_motor() noexcept override;
  bool is_set_up() const noexcept override { return asked_ == kRead.size(); }
  can_frame set_up() noexcept override;
  void end_unanswered() noexcept override;
  bool is_on() const noexcept override { return mode_ == Mode::kRun && faults_ == 0; }
  bool in_error() const noexcept override { return faults_ != 0 || details_ != 0; }
  std::uint64_t state_code() const noexcept override;
  can_frame clear() noexcept override;
  can_frame enable() noexcept override { return encode_request(Type::kEnable, number()); }
  can_frame release() noexcept override { return encode_request(Type::kRelease, number()); }
  can_frame order(const MitCommand& command) noexcept override { return encode_order(number(), ranges(), command); }
  std::string code_words(const DriveStatus& status) const override;

  void receive_parameter(const ParameterAccess& answer) noexcept;
  void end_set_up(bool takes_timeout) noexcept;
  std::uint8_t number() const noexcept { return static_cast<std::uint8_t>(node()); }

  std::uint32_t timeout_;  // units of kTimeoutUnit
  Mode mode_ = Mode::kReset;
  std::uint8_t faults_ = 0;
  std::uint32_t details_ = 0;  // of a frame kFaults, until they are cleared
  std::size_t asked_ = 0;      // place of the awaited parameter among those that are read
  bool writes_ = false;        // The next request writes the timeout.
  unsigned written_ = 0;
};

}  // namespace robot_control::cybergear
