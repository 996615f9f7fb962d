#include "drivers/odrive/odrive_drive.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "drivers/odrive/odrive_errors.h"
#include "drivers/odrive/odrive_messages_05.h"
#include "drivers/odrive/odrive_messages_06.h"

namespace robot_control::odrive {
namespace {

constexpr std::int64_t kSlowNs = 100'000'000;     // of temperature and voltage
constexpr std::int64_t kAddressNs = 20'000'000;   // in which a second drive would have answered
constexpr std::int64_t kEnterNs = 3'000'000'000;  // more than any axis needs to enter closed loop
constexpr std::int64_t kModeNs = 10'000'000;      // between repetitions of the mode in which a drive brakes
constexpr double kMaxHeartbeats = 6.5;            // Five lost ones in a row happen once in 10⁶ at a loss of 5 %.
constexpr double kBrakeTime = 0.1;                // s, in which no brake halves the speed from the limit
constexpr double kMinSpeed = 0.1;                 // of the limit, below which a speed is no runaway

/// Commands that move an axis or change how it moves: Estop, Set_Axis_State, Set_Controller_Mode, Set_Input_Pos, _Vel
/// and _Torque, Set_Limits, Start_Anticogging, three of trajectories, Reboot, Clear_Errors, and those of position and
/// gains.
constexpr std::array kMotionCommands{0x02, 0x07, 0x0B, 0x0C, 0x0D, 0x0E, 0x0F, 0x10,
                                     0x11, 0x12, 0x13, 0x16, 0x18, 0x19, 0x1A, 0x1B};

/// Returns the distance to the next float of this many turns, in rad.
double float_step(double position) noexcept {
  const auto turns = static_cast<float>(std::abs(position) / kTurn);
  return kTurn * (std::nextafter(turns, std::numeric_limits<float>::max()) - turns);
}

/// Returns the axis errors MOTOR_FAILED, ENCODER_FAILED, CONTROLLER_FAILED of a heartbeat of 0.5 with these flags.
std::uint32_t parts_in_error(const can_frame& frame) noexcept {
  const auto heartbeat = decode<v05::Heartbeat>(frame).value_or(v05::Heartbeat{});
  return (heartbeat.motor_error ? 0x40U : 0U) | (heartbeat.encoder_error ? 0x100U : 0U) |
         (heartbeat.controller_error ? 0x200U : 0U);
}

DriveParameters with_sample_period(DriveParameters drive, double period) {
  drive.sample_period = period;
  drive.takes_effort = drive.takes_speeds;
  drive.effort_is_rare = !drive.takes_speeds;  // The drive gives other torques than those of the command.
  return drive;
}

}  // namespace

OdriveDrive::OdriveDrive(const OdriveParameters& parameters, double period)
    : Drive(with_sample_period(parameters.drive, parameters.estimates_period), period), parameters_(parameters) {}

std::vector<PlannedFrames> OdriveDrive::plan() const {
  std::vector<PlannedFrames> plan{{.data_bytes = parameters_.drive.takes_speeds ? 8U : 4U, .per_cycle = 1}};
  if (parameters_.estimates_period > 0) {
    plan.push_back({.data_bytes = 8, .per_second = 1 / parameters_.estimates_period});
  } else {
    plan.push_back({.data_bytes = 0, .per_cycle = 1});
    plan.push_back({.data_bytes = 8, .per_cycle = 1});
  }
  constexpr double kSlowRate = 2 * 1.0e9 / kSlowNs;
  const bool requests = parameters_.effort_period == 0;
  const double efforts = requests ? parameters_.effort_rate : 1 / parameters_.effort_period;
  plan.push_back({.data_bytes = 0, .per_second = kSlowRate + (requests ? efforts : 0)});
  plan.push_back({.data_bytes = 8, .per_second = efforts + kSlowRate + 1 / parameters_.heartbeat_period});
  return plan;
}

void OdriveDrive::restart(bool reset, std::int64_t now_ns) noexcept {
  enter(Phase::kHeartbeat);
  reset_ = reset;
  firmware_ = Firmware::kAny;
  axis_state_ = AxisState::kUndefined;
  axis_error_ = 0;
  details_ = {};
  serial_number_ = 0;
  watchdog_enabled_.reset();
  watchdog_timeout_.reset();
  pending_shift_ = 0;
  heartbeat_ns_ = moving_ns_ = now_ns;
  cleared_ns_ = 0;
}

void OdriveDrive::enter(Phase phase) noexcept {
  phase_ = phase;
  tries_ = 0;
  next_request_ns_ = 0;
}

void OdriveDrive::know_firmware(Firmware firmware) noexcept {
  firmware_ = firmware;
  enter(firmware == Firmware::k06 ? Phase::kAddress : Phase::kPosition);
  if (parameters_.firmware == Firmware::kAny || parameters_.firmware == firmware) return;
  fail(DriveCause::kDiffers, "firmware", 0, firmware == Firmware::k05 ? 0.5 : 0.6,
       firmware == Firmware::k05 ? 0.6 : 0.5);
}

/// An axis with a watchdog reports at each start that it expired: no host was there.
bool OdriveDrive::clears(std::uint32_t error) const noexcept {
  const std::uint32_t expired = firmware_ == Firmware::k06 ? kWatchdogExpired06 : kWatchdogExpired05;
  return phase_ != Phase::kRunning && (reset_ || error == expired);
}

bool OdriveDrive::due(std::int64_t& next_ns, std::int64_t interval_ns, std::int64_t now_ns) const noexcept {
  if (now_ns < next_ns) return false;
  next_ns = now_ns + interval_ns;
  return true;
}

/// A command needs no data: a remote request under its identifier is one, too.
bool OdriveDrive::is_foreign_command(const can_frame& frame) const noexcept {
  if (std::ranges::find(kMotionCommands, command_of(frame)) != kMotionCommands.end()) return true;
  if (firmware_ == Firmware::k05) return command_of(frame) == v06::Address::kCommand.number;  // there Set_Axis_Node_ID
  const auto sdo = firmware_ == Firmware::k06 ? decode<v06::RxSdo>(frame) : std::nullopt;
  return sdo && sdo->opcode == v06::RxSdo::kWrite;
}

void OdriveDrive::receive(const can_frame& frame, std::int64_t now_ns) noexcept {
  if ((frame.can_id & ~(CAN_SFF_MASK | CAN_RTR_FLAG)) != 0 || node_of(frame) != node()) return;
  if (is_foreign_command(frame)) return fail(DriveCause::kForeignCommander, "", frame.can_id & CAN_SFF_MASK);
  receive_heartbeat(frame, now_ns);
  receive_identity(frame);
  if (const auto estimates = decode<EncoderEstimates>(frame)) receive_estimates(*estimates, now_ns);
  receive_measurements(frame, now_ns);
  receive_error_details(frame);
}

void OdriveDrive::receive_heartbeat(const can_frame& frame, std::int64_t now_ns) noexcept {
  const auto heartbeat = decode<v06::Heartbeat>(frame);  // Error and state are at the same place in 0.5.
  if (!heartbeat) return;
  heartbeat_ns_ = now_ns;
  if (axis_state_ != heartbeat->state) changed_ns_ = now_ns;
  axis_state_ = heartbeat->state;
  axis_error_ = heartbeat->error;
  if (phase_ == Phase::kHeartbeat) enter(Phase::kVersion);
  if (firmware_ == Firmware::k05) axis_error_ |= parts_in_error(frame);
}

void OdriveDrive::receive_identity(const can_frame& frame) noexcept {
  if (const auto version = decode<v06::Version>(frame); version && phase_ == Phase::kVersion) {
    know_firmware(Firmware::k06);
  }
  if (firmware_ != Firmware::k06) return;
  if (const auto address = decode<v06::Address>(frame)) {
    if (serial_number_ != 0 && address->serial_number != serial_number_) return fail(DriveCause::kTwoDrives);
    serial_number_ = address->serial_number;
  }
  if (const auto answer = decode<v06::TxSdo>(frame)) {
    if (answer->endpoint == parameters_.enable_watchdog_endpoint) watchdog_enabled_ = (answer->value & 0xFFU) != 0;
    if (answer->endpoint == parameters_.watchdog_timeout_endpoint) {
      watchdog_timeout_ = double{std::bit_cast<float>(answer->value)};
    }
  }
}

void OdriveDrive::receive_estimates(const EncoderEstimates& estimates, std::int64_t now_ns) noexcept {
  const double position = estimates.position;
  if (pending_shift_ != 0 &&
      std::abs(position + pending_shift_ - motor_position_) < std::abs(position - motor_position_)) {
    shift_ += pending_shift_;
    pending_shift_ = 0;
  }
  motor_position_ = position;
  if (!(std::abs(estimates.velocity) < kRestSpeed)) moving_ns_ = now_ns;
  accept_position(position + shift_, estimates.velocity, now_ns);
}

void OdriveDrive::receive_measurements(const can_frame& frame, std::int64_t now_ns) noexcept {
  if (const auto iq = decode<Iq>(frame); iq && firmware_ == Firmware::k05) {
    accept_motor_torque(iq->measured * parameters_.torque_constant, now_ns);
  }
  if (const auto bus = decode<BusVoltageCurrent>(frame)) accept_voltage(bus->voltage);
  if (firmware_ != Firmware::k06) return;
  if (const auto torques = decode<v06::Torques>(frame)) accept_motor_torque(torques->estimate, now_ns);
  if (const auto temperature = decode<v06::Temperature>(frame)) {
    const double motor = std::isfinite(temperature->motor) ? temperature->motor : temperature->transistors;
    accept_temperature(std::fmax(temperature->transistors, motor));
  }
}

void OdriveDrive::receive_error_details(const can_frame& frame) noexcept {
  if (firmware_ == Firmware::k06) {
    if (const auto error = decode<v06::Error>(frame)) details_[3] = error->disarm_reason;
    return;
  }
  if (const auto error = decode<v05::MotorError>(frame)) details_[0] = error->error;
  if (const auto error = decode<v05::EncoderError>(frame)) details_[1] = error->error;
  if (const auto error = decode<v05::ControllerError>(frame)) details_[2] = error->error;
}

void OdriveDrive::advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept {
  if (status().state == DrivePhase::kRunning) note_speed();
  if (disabled()) {
    send.add(brakes_by_itself() ? encode(node(), SetInputVelocity{}) : input({}));
    brakes_by_itself() ? send_brake(command, now_ns, send) : send_idle(now_ns, send);
    if (due(next_details_ns_, kSlowNs, now_ns)) {
      send.add(request<v06::Error>(node()));
      if (firmware_ == Firmware::k05) {
        send.add(request<v05::EncoderError>(node()));
        send.add(request<v05::ControllerError>(node()));
      }
    }
    return;
  }
  // An axis in closed loop has the torque of an earlier program, whose watchdog these frames feed.
  if (phase_ < Phase::kPosition) send.add(input({}));
  if (phase_ == Phase::kHeartbeat) return set(DrivePhase::kStarting, DriveCause::kFirstFrame);
  const auto max_silence = static_cast<std::int64_t>(1.0e9 * kMaxHeartbeats * parameters_.heartbeat_period);
  if (now_ns - heartbeat_ns_ > max_silence) {
    if (phase_ == Phase::kRunning) return fail(DriveCause::kSilent, "heartbeat");
    return restart(reset_, now_ns);
  }
  if (axis_error_ != 0 && phase_ > Phase::kVersion && !clears(axis_error_)) {
    return fail(DriveCause::kDriveError, "", axis_error_);
  }
  if (phase_ == Phase::kRunning && axis_state_ != AxisState::kClosedLoopControl) {
    return fail(DriveCause::kReleased, "axis state", static_cast<std::uint32_t>(axis_state_));
  }
  if (phase_ < Phase::kPosition) return advance_identity(now_ns, send);
  request_measurements(now_ns, send);
  keep_resolution(now_ns, send);
  advance_power(command, now_ns, send);
}

void OdriveDrive::advance_identity(std::int64_t now_ns, FrameBatch& send) noexcept {
  set(DrivePhase::kStarting, DriveCause::kIdentity);
  if (phase_ == Phase::kWatchdog) return ask_watchdog(now_ns, send);
  const Phase next = parameters_.watchdog_timeout_endpoint != 0 ? Phase::kWatchdog : Phase::kPosition;
  if (phase_ == Phase::kAddress && serial_number_ != 0 && now_ns >= next_request_ns_ - kRetryNs + kAddressNs) {
    if (parameters_.serial_number != 0 && serial_number_ != parameters_.serial_number) {
      return fail(DriveCause::kDiffers, "serial number", serial_number_);
    }
    return enter(next);
  }
  if (!due(next_request_ns_, kRetryNs, now_ns)) return;
  if (tries_++ < kTries) {
    send.add(phase_ == Phase::kVersion ? request<v06::Version>(node()) : request<v06::Address>(node()));
  } else if (phase_ == Phase::kVersion) {
    know_firmware(Firmware::k05);
  } else if (parameters_.serial_number != 0) {
    fail(DriveCause::kNoAnswer, "its serial number (Address)");
  } else {
    enter(next);  // Early versions of 0.6 have no such message.
  }
}

void OdriveDrive::ask_watchdog(std::int64_t now_ns, FrameBatch& send) noexcept {
  if (watchdog_enabled_ && watchdog_timeout_) {
    if (*watchdog_enabled_) {
      if (!(*watchdog_timeout_ <= parameters_.max_watchdog_timeout)) {
        return fail(DriveCause::kDiffers, "watchdog_timeout", 0, *watchdog_timeout_, parameters_.max_watchdog_timeout);
      }
      know_reaction(SilenceReaction::kCoasts, ReactionEvidence::kRead);
    } else {
      know_reaction(SilenceReaction::kUnknown, ReactionEvidence::kRead);
    }
    return enter(Phase::kPosition);
  }
  if (!due(next_request_ns_, kRetryNs, now_ns)) return;
  if (tries_++ == kTries) return fail(DriveCause::kNoAnswer, "the watchdog's endpoints");
  for (const std::uint64_t endpoint : {parameters_.enable_watchdog_endpoint, parameters_.watchdog_timeout_endpoint}) {
    send.add(encode(node(), v06::RxSdo{.endpoint = static_cast<std::uint16_t>(endpoint)}));
  }
}

void OdriveDrive::advance_power(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept {
  const bool running = phase_ == Phase::kRunning && command.enabled;
  send.add(input(running ? command : DriveCommand{}));
  if (phase_ == Phase::kPosition) {
    set(DrivePhase::kStarting, DriveCause::kFirstSample);
    if (!sample().valid) return;
    settle_reaction();
    return enter(Phase::kReady);
  }
  if (!command.enabled) {
    if (axis_state_ == AxisState::kClosedLoopControl || phase_ != Phase::kReady) send_idle(now_ns, send);
    if (phase_ != Phase::kReady) enter(Phase::kReady);
    return set(DrivePhase::kReady, DriveCause::kEnable);
  }
  if (phase_ == Phase::kReady) {
    enter(Phase::kEnter);
    deadline_ns_ = now_ns + kEnterNs;
  }
  if (phase_ == Phase::kRunning) return set(DrivePhase::kRunning, DriveCause::kNone);
  set(DrivePhase::kReady, DriveCause::kPower, "in closed loop; axis state", static_cast<std::uint32_t>(axis_state_));
  if (tries_ < kZeroCycles) {
    ++tries_;
    const DriveParameters& drive = drive_parameters();
    const ControlMode control = drive.takes_speeds ? ControlMode::kVelocity : ControlMode::kTorque;
    const double fastest = parameters_.motor_velocity_limit > 0 ? parameters_.motor_velocity_limit
                                                                : kVelocityMargin * drive.velocity_limit * drive.gear;
    send_mode(command, control, fastest, drive.torque_limit, send);
  } else if (axis_state_ == AxisState::kClosedLoopControl && axis_error_ == 0) {
    if (sample().stamp_ns <= changed_ns_) return;
    reset_ = false;
    enter(Phase::kRunning);
  } else if (now_ns > deadline_ns_) {
    fail(DriveCause::kStaysOff, "axis state", static_cast<std::uint32_t>(axis_state_));
  } else if (axis_error_ != 0) {
    clear_errors(now_ns, send);
  } else if (due(next_request_ns_, kRetryNs, now_ns)) {
    send.add(encode(node(), SetAxisState{.state = AxisState::kClosedLoopControl}));
  }
}

/// A heartbeat that came before the last request does not show whether it was followed.
void OdriveDrive::clear_errors(std::int64_t now_ns, FrameBatch& send) noexcept {
  if (heartbeat_ns_ <= cleared_ns_) return;
  if (!may_clear()) return fail(DriveCause::kDriveError, "", axis_error_);
  cleared_ns_ = now_ns;
  send.add(encode(node(), v06::ClearErrors{}));
}

/// A velocity also sets the torque, so that a zero one leaves nothing of an earlier program.
can_frame OdriveDrive::input(const DriveCommand& command) const noexcept {
  const double torque = motor_torque(command.torque);
  if (!drive_parameters().takes_speeds) return encode(node(), SetInputTorque{.torque = torque});
  return encode(node(), SetInputVelocity{.velocity = motor_speed(command.speed), .torque = torque});
}

/// `fastest` is the limit of the motor's speed, `torque` that of the joint. Without an integrator the gain of the speed
/// is the damping of a brake. In torque mode the drive gives gain · (fastest − speed) at most, so with this gain it has
/// its whole torque up to the joint's limit.
void OdriveDrive::send_mode(const DriveCommand& command, ControlMode control, double fastest, double torque,
                            FrameBatch& send) const noexcept {
  const DriveParameters& drive = drive_parameters();
  const double damping = drive.torque_limit / ((kVelocityMargin - 1) * drive.velocity_limit);
  if (!drive.takes_speeds) {
    const double gain = std::fmax(damping, command.brake_damping) / (drive.gear * drive.gear);
    send.add(encode(node(), SetVelocityGains{.gain = gain}));
  }
  send.add(encode(node(), SetControllerMode{.control = control}));
  send.add(
      encode(node(), SetLimits{.velocity = fastest, .current = torque / drive.gear / parameters_.torque_constant}));
}

/// The brake closes the drive's own loop, and the encoder may be the cause of the fault. A drive that exceeds its limit
/// of the speed releases its motor. The limit is therefore little above the speed at which the fault came.
void OdriveDrive::send_brake(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept {
  if (!due(next_request_ns_, kModeNs, now_ns)) return;
  const DriveParameters& drive = drive_parameters();
  const double torque = drive.takes_speeds ? drive.torque_limit : command.brake_torque;
  send_mode(command, ControlMode::kVelocity, kVelocityMargin * drive.gear * fastest_, torque, send);
}

void OdriveDrive::note_speed() noexcept {
  const double limit = drive_parameters().velocity_limit;
  const double kept = std::exp2(-1.0e-9 * static_cast<double>(period_ns_) / kBrakeTime) * fastest_;
  fastest_ = std::clamp(std::abs(sample().joint.velocity), std::fmax(kept, kMinSpeed * limit), limit);
}

void OdriveDrive::send_idle(std::int64_t now_ns, FrameBatch& send) noexcept {
  if (due(next_request_ns_, kRetryNs, now_ns)) send.add(encode(node(), SetAxisState{}));
}

void OdriveDrive::request_measurements(std::int64_t now_ns, FrameBatch& send) noexcept {
  if (parameters_.estimates_period == 0) send.add(request<EncoderEstimates>(node()));
  if (parameters_.effort_period == 0 &&
      due(next_effort_ns_, std::llround(1.0e9 / parameters_.effort_rate), now_ns + period_ns_ / 2)) {
    send.add(firmware_ == Firmware::k06 ? request<v06::Torques>(node()) : request<Iq>(node()));
  }
  if (!due(next_slow_ns_, kSlowNs, now_ns)) return;
  send.add(request<BusVoltageCurrent>(node()));
  if (firmware_ == Firmware::k06) send.add(request<v06::Temperature>(node()));
}

void OdriveDrive::keep_resolution(std::int64_t now_ns, FrameBatch& send) noexcept {
  if (float_step(motor_position_) <= parameters_.max_position_step || now_ns - moving_ns_ < kRestNs) return;
  pending_shift_ = kTurn * std::round(motor_position_ / kTurn);
  moving_ns_ = now_ns;  // The next attempt, if this one is lost, follows after another rest.
  set_position(motor_position_ - pending_shift_, send);
}

void OdriveDrive::set_position(double position, FrameBatch& send) const noexcept {
  if (firmware_ == Firmware::k06) return send.add(encode(node(), v06::SetAbsolutePosition{.position = position}));
  const double counts = std::round(position / kTurn * parameters_.counts_per_turn);
  send.add(encode(node(), v05::SetLinearCount{.position = static_cast<std::int32_t>(counts)}));
}

void OdriveDrive::add_details(DriveStatus& status) const noexcept {
  std::copy(details_.begin(), details_.end(), status.details.begin());
  status.details.back() = firmware_ == Firmware::k06 ? 1 : 0;
}

std::string OdriveDrive::code_words(const DriveStatus& status) const {
  using enum DriveCause;
  if (status.cause == kDriveError) return error_words(status.code, status.details);
  constexpr std::array kWithCode{kPower, kReleased, kStaysOff, kForeignCommander, kDiffers};
  const bool has_code = std::ranges::find(kWithCode, status.cause) != kWithCode.end();
  return has_code && (status.code != 0 || status.cause != kDiffers) ? std::to_string(status.code) : "";
}

}  // namespace robot_control::odrive
