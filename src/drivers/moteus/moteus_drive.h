#pragma once
/// One moteus controller of mjbots in its mode position, which closes an impedance (drivers/drive/mit/mit_drive.h).
///
/// Each order carries its own timeout. After it the controller enters the mode timeout, and obeys nothing but a request
/// to stop. The drive file states what the controller does there, which is its setting servo.timeout_mode.
///
/// The set-up reads the version of the registers, and what the position is relative to. A position of the output has no
/// turns of the rotor. Its start_angle may be off by half a turn of the output.
///
/// The gains cannot be read. So the controller is enabled with orders whose greatest torque is 0, and whose target is
/// beside its position. It reports the parts of the torque that it would apply. They show kp, kd, an integral, and a
/// limit of its steps. It counts as enabled when they agree with the drive file within kTolerance.
///
/// Each order requests the mode position. So the damping that follows a fault also enables a controller that restarted.

#include <cstdint>

#include "drivers/drive/mit/mit_drive.h"
#include "drivers/moteus/moteus_messages.h"
#include "drivers/moteus/moteus_parameters.h"

namespace robot_control::moteus {

class MoteusDrive final : public MitDrive {
 public:
  static constexpr double kMapVersion = 5;
  static constexpr double kTolerance = 0.2;  ///< of a gain: the target moves on until the reply
  static constexpr unsigned kTrials = 50;    ///< replies that may disagree

  MoteusDrive(const MoteusParameters& parameters, double period);

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept override;
  std::vector<PlannedFrames> plan() const override;

 private:
  void forget_motor() noexcept override;
  bool is_set_up() const noexcept override { return identified_; }
  can_frame set_up() noexcept override { return stop(true); }
  void end_unanswered() noexcept override { fail(DriveCause::kNoAnswer, "the version of its registers"); }
  bool is_on() const noexcept override { return is_in(Mode::kPosition) && gains_agree_; }
  bool in_error() const noexcept override { return is_in(Mode::kFault); }
  std::uint64_t state_code() const noexcept override;
  can_frame clear() noexcept override { return stop(false); }
  can_frame enable() noexcept override;
  can_frame release() noexcept override { return stop(false); }
  can_frame order(const MitCommand& command) noexcept override;
  std::string code_words(const DriveStatus& status) const override;

  can_frame stop(bool details) const noexcept { return encode(node(), ranges(), {.details = details}); }
  bool is_in(Mode mode) const noexcept { return reply_.mode == static_cast<double>(mode); }
  void identify(const Reply& reply) noexcept;
  void judge_gains(const Reply& reply) noexcept;

  double motor_gear_;
  double timeout_;  // s
  Reply reply_;     // the last one
  MitCommand trial_;
  bool identified_ = false;
  bool gains_agree_ = false;
  unsigned trials_ = 0;
};

}  // namespace robot_control::moteus
