#include "drivers/damiao/damiao_drive.h"

#include <cmath>

#include "signals/formatted_text.h"

namespace robot_control::damiao {
namespace {

constexpr double kMitMode = 1;

const char* name_of(State state) noexcept {
  switch (state) {
    case State::kOff:
      return "off";
    case State::kOn:
      return "on";
    case State::kOverVoltage:
      return "over-voltage";
    case State::kUnderVoltage:
      return "under-voltage";
    case State::kOverCurrent:
      return "over-current";
    case State::kHotTransistors:
      return "transistors too hot";
    case State::kHotRotor:
      return "rotor too hot";
    case State::kCommunicationLost:
      return "communication lost";
    case State::kOverload:
      return "overload";
  }
  return "unknown";
}

}  // namespace

DamiaoDrive::DamiaoDrive(const DamiaoParameters& parameters, double period)
    : MitDrive({.drive = parameters.drive, .ranges = parameters.ranges, .start_angle = parameters.start_angle}, period),
      answers_(static_cast<canid_t>(parameters.answers != 0 ? parameters.answers : node() + kMaxNode + 1)),
      timeout_(static_cast<std::uint32_t>(std::lround(parameters.timeout / kTimeoutUnit))) {}

std::vector<PlannedFrames> DamiaoDrive::plan() const {
  return {{.data_bytes = 8, .per_cycle = 2}};
}

void DamiaoDrive::forget_motor() noexcept {
  state_ = State::kOff;
  asked_ = 0;
  operation_ = Operation::kRead;
  written_ = false;
}

void DamiaoDrive::receive(const can_frame& frame, std::int64_t now_ns) noexcept {
  if (!is_standard_data(frame)) return;
  if (commands(frame, node())) return fail(DriveCause::kForeignCommander, "", frame.can_id);
  if (frame.can_id != answers_ || frame.len != CAN_MAX_DLEN) return;
  const RegisterAccess answer = decode_register(frame);
  if (setting_up() && !is_set_up() && answer.node == node() && answer.operation == operation_ &&
      answer.number == kRead[asked_]) {
    return receive_register(answer);
  }
  if (answer.node == node() && is_access(answer.operation)) return;
  const Feedback feedback = decode_feedback(frame, ranges());
  if (feedback.node != node()) return;
  state_ = feedback.state;
  accept_position(feedback.position, feedback.velocity, now_ns);
  accept_motor_torque(feedback.torque, now_ns);
  accept_temperature(std::fmax(feedback.transistors, feedback.rotor));
}

void DamiaoDrive::receive_register(const RegisterAccess& answer) noexcept {
  accept_answer();
  switch (answer.number) {
    case Register::kControlMode:
      compare("control mode (CTRL_MODE)", answer.value, kMitMode);
      break;
    case Register::kGear:
      set_motor_gear(answer.real());
      break;
    case Register::kPositionRange:
      compare("position_range (PMAX)", answer.real(), ranges().position);
      break;
    case Register::kVelocityRange:
      compare("velocity_range (VMAX)", answer.real(), ranges().velocity);
      break;
    case Register::kTorqueRange:
      compare("torque_range (TMAX)", answer.real(), ranges().torque);
      break;
    case Register::kTimeout:
      if (operation_ == Operation::kWrite || answer.value == timeout_) break;
      if (written_) return fail(DriveCause::kRefused, "its timeout (TIMEOUT)");
      written_ = true;
      operation_ = Operation::kWrite;
      return;
  }
  if (operation_ == Operation::kWrite) {
    operation_ = Operation::kRead;
  } else if (++asked_ == kRead.size()) {
    know_reaction(SilenceReaction::kCoasts, ReactionEvidence::kRead);
  }
}

can_frame DamiaoDrive::set_up() noexcept {
  return encode(kRegisterId, RegisterAccess{.node = static_cast<std::uint16_t>(node()),
                                            .operation = operation_,
                                            .number = kRead[asked_],
                                            .value = operation_ == Operation::kWrite ? timeout_ : 0});
}

std::string DamiaoDrive::code_words(const DriveStatus& status) const {
  if (status.cause == DriveCause::kForeignCommander)
    return formatted("0x%llX", static_cast<unsigned long long>(status.code));
  const bool of_state = status.cause == DriveCause::kDriveError || status.cause == DriveCause::kReleased;
  return of_state ? name_of(static_cast<State>(status.code)) : "";
}

}  // namespace robot_control::damiao
