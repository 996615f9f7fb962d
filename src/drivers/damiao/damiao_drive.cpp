#include "drivers/damiao/damiao_drive.h"

#include <cmath>
#include <numbers>

#include "signals/formatted_text.h"

namespace robot_control::damiao {
namespace {

constexpr std::array kRead{Register::kControlMode,   Register::kGear,        Register::kPositionRange,
                           Register::kVelocityRange, Register::kTorqueRange, Register::kTimeout};
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

DriveParameters with_impedance(DriveParameters drive) {
  drive.takes_speeds = false;
  drive.is_absolute = true;
  drive.max_stiffness = MitRanges::kStiffness * drive.gear * drive.gear;
  drive.max_damping = MitRanges::kDamping * drive.gear * drive.gear;
  return drive;
}

}  // namespace

DamiaoDrive::DamiaoDrive(const DamiaoParameters& parameters, double period)
    : Drive(with_impedance(parameters.drive), period),
      parameters_(parameters),
      timeout_(static_cast<std::uint32_t>(std::lround(parameters.timeout / kTimeoutUnit))) {
  if (parameters_.answers == 0) parameters_.answers = node() + kMaxNode + 1;
}

std::vector<PlannedFrames> DamiaoDrive::plan() const {
  return {{.data_bytes = 8, .per_cycle = 2}};
}

void DamiaoDrive::restart(bool reset, std::int64_t /*now_ns*/) noexcept {
  phase_ = Phase::kRegisters;
  reset_ = reset;
  state_ = State::kOff;
  asked_ = tries_ = 0;
  operation_ = Operation::kRead;
  written_ = false;
  next_request_ns_ = 0;
}

void DamiaoDrive::receive(const can_frame& frame, std::int64_t now_ns) noexcept {
  if (!is_standard_data(frame)) return;
  if (commands(frame, node())) return fail(DriveCause::kForeignCommander, "", frame.can_id);
  if (frame.can_id != parameters_.answers || frame.len != CAN_MAX_DLEN) return;
  const RegisterAccess answer = decode_register(frame);
  if (phase_ == Phase::kRegisters && answer.node == node() && answer.operation == operation_ &&
      answer.number == kRead[asked_]) {
    return receive_register(answer);
  }
  if (answer.node == node() && is_access(answer.operation)) return;
  const Feedback feedback = decode_feedback(frame, parameters_.ranges);
  if (feedback.node != node()) return;
  state_ = feedback.state;
  accept_position(feedback.position, feedback.velocity, now_ns);
  accept_motor_torque(feedback.torque, now_ns);
  accept_temperature(std::fmax(feedback.transistors, feedback.rotor));
}

void DamiaoDrive::compare(const char* name, double found, double expected) noexcept {
  if (!(std::abs(found - expected) <= kRangeTolerance * expected)) fail(DriveCause::kDiffers, name, 0, found, expected);
}

void DamiaoDrive::receive_register(const RegisterAccess& answer) noexcept {
  tries_ = 0;
  next_request_ns_ = 0;
  switch (answer.number) {
    case Register::kControlMode:
      compare("control mode (CTRL_MODE)", answer.value, kMitMode);
      break;
    case Register::kGear:
      motor_gear_ = std::isfinite(answer.real()) ? std::fmax(1, answer.real()) : 1;
      break;
    case Register::kPositionRange:
      compare("position_range (PMAX)", answer.real(), parameters_.ranges.position);
      break;
    case Register::kVelocityRange:
      compare("velocity_range (VMAX)", answer.real(), parameters_.ranges.velocity);
      break;
    case Register::kTorqueRange:
      compare("torque_range (TMAX)", answer.real(), parameters_.ranges.torque);
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
    phase_ = Phase::kPosition;
  }
}

can_frame DamiaoDrive::request_register(std::int64_t now_ns) noexcept {
  set(DrivePhase::kStarting, sample().valid ? DriveCause::kIdentity : DriveCause::kFirstFrame);
  if (now_ns < next_request_ns_) return release();
  next_request_ns_ = now_ns + kRetryNs;
  if (!sample().valid) {
    tries_ = 0;
  } else if (tries_++ == kTries) {
    fail(DriveCause::kNoAnswer, "its registers");
  }
  return encode(kRegisterId, RegisterAccess{.node = static_cast<std::uint16_t>(node()),
                                            .operation = operation_,
                                            .number = kRead[asked_],
                                            .value = operation_ == Operation::kWrite ? timeout_ : 0});
}

can_frame DamiaoDrive::clear_error(std::int64_t now_ns) noexcept {
  if (now_ns < next_request_ns_) return release();
  next_request_ns_ = now_ns + kRetryNs;
  const bool clears = reset_ || state_ == State::kCommunicationLost;
  if (clears && may_clear()) return encode(node(), Request::kClear);
  fail(DriveCause::kDriveError, "", static_cast<std::uint64_t>(state_));
  return release();
}

void DamiaoDrive::check_start_angle() noexcept {
  if (!parameters_.start_angle) return;
  const double half_turn = std::numbers::pi / (motor_gear_ * drive_parameters().gear);
  const double angle = sample().joint.position;
  if (std::abs(angle - *parameters_.start_angle) <= half_turn) return;
  fail(DriveCause::kDiffers, "start_angle", 0, angle, *parameters_.start_angle);
}

void DamiaoDrive::advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept {
  const can_frame frame = disabled() ? release() : next_frame(command, now_ns);
  if (!disabled()) return send.add(frame);
  send.add(brakes_by_itself() ? order({.damping = command.brake_damping}) : release());
}

can_frame DamiaoDrive::next_frame(const DriveCommand& command, std::int64_t now_ns) noexcept {
  if (phase_ == Phase::kRunning && state_ != State::kOn) {
    fail(in_error() ? DriveCause::kDriveError : DriveCause::kReleased, "", static_cast<std::uint64_t>(state_));
    return release();
  }
  if (phase_ == Phase::kRegisters) return request_register(now_ns);
  if (in_error()) return clear_error(now_ns);
  if (phase_ == Phase::kPosition) {
    set(DrivePhase::kStarting, DriveCause::kFirstSample);
    if (!sample().valid) return release();
    check_start_angle();
    phase_ = Phase::kReady;
  }
  if (!command.enabled) {
    phase_ = Phase::kReady;
    set(DrivePhase::kReady, DriveCause::kEnable);
    return release();
  }
  if (phase_ == Phase::kReady) {
    phase_ = Phase::kEnable;
    deadline_ns_ = now_ns + kEnterNs;
  }
  if (phase_ == Phase::kEnable && state_ != State::kOn) {
    set(DrivePhase::kReady, DriveCause::kPower);
    if (now_ns > deadline_ns_) fail(DriveCause::kStaysOff);
    return encode(node(), Request::kEnable);
  }
  phase_ = Phase::kRunning;
  reset_ = false;
  set(DrivePhase::kRunning, DriveCause::kNone);
  return order(command);
}

can_frame DamiaoDrive::order(const DriveCommand& command) const noexcept {
  return encode_mit(static_cast<canid_t>(node()), parameters_.ranges,
                    {.position = motor_position(command.position),
                     .velocity = motor_speed(command.speed),
                     .stiffness = motor_gain(command.stiffness),
                     .damping = motor_gain(command.damping),
                     .torque = motor_torque(command.torque)});
}

std::string DamiaoDrive::code_words(const DriveStatus& status) const {
  if (status.cause == DriveCause::kForeignCommander)
    return formatted("0x%llX", static_cast<unsigned long long>(status.code));
  const bool of_state = status.cause == DriveCause::kDriveError || status.cause == DriveCause::kReleased;
  return of_state ? name_of(static_cast<State>(status.code)) : "";
}

}  // namespace robot_control::damiao
