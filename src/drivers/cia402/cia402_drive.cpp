#include "drivers/cia402/cia402_drive.h"

#include "drivers/wrapped_count.h"
#include "signals/formatted_text.h"

namespace robot_control::cia402 {
namespace {

using canopen::NmtCommand;
using canopen::NmtState;
using canopen::SdoClient;

constexpr std::int64_t kNmtNs = 100'000'000;      // between repetitions of a command that was not followed
constexpr std::int64_t kPowerNs = 3'000'000'000;  // more than a drive needs to release its brake
constexpr std::int64_t kVoltageNs = 100'000'000;  // between two readings
constexpr unsigned kResetCycles = 8;              // of one level of the bit that resets a fault
constexpr std::int64_t kResetNs = 200'000'000;    // between two resets of a fault, which needs time to be left

/// Returns the value of this object in a PDO that was decoded.
std::int64_t value_of(const Pdo& pdo, const std::array<std::int64_t, canopen::kMaxPdoEntries>& values,
                      const ObjectAddress& object) noexcept {
  for (std::size_t i = 0; i < pdo.mapping.count; ++i) {
    if (pdo.mapping.entries[i].object == object) return values[i];
  }
  return 0;
}

std::string hexadecimal(std::uint64_t value) {
  return formatted("0x%04llX", static_cast<unsigned long long>(value));
}

}  // namespace

Cia402Drive::Cia402Drive(const Cia402Parameters& parameters, std::uint8_t host, double period)
    : Drive(parameters.drive, period),
      parameters_(parameters),
      setup_(parameters, host, period),
      reader_(static_cast<std::uint8_t>(parameters.drive.node)) {}

void Cia402Drive::join(Cia402Drive& first, Cia402Drive& second) noexcept {
  first.second_axis_ = &second;
  second.first_axis_ = &first;
}

std::vector<PlannedFrames> Cia402Drive::plan() const {
  std::vector<PlannedFrames> plan{{.data_bytes = parameters_.drive.takes_speeds ? 6U : 4U, .per_cycle = 1},
                                  {.data_bytes = 8, .per_cycle = 1}};
  const bool velocity = parameters_.velocity_pdo == VelocityPdo::kTrue ||
                        (parameters_.velocity_pdo == VelocityPdo::kDerived && parameters_.velocity_has_room);
  if (velocity) plan.push_back({.data_bytes = 4, .per_cycle = 1.0 / kVelocitySyncs});
  plan.push_back({.data_bytes = 1, .per_second = 10});
  plan.push_back({.data_bytes = 8, .per_second = 2 * 1.0e9 / kVoltageNs});
  return plan;
}

void Cia402Drive::restart(bool reset, std::int64_t now_ns) noexcept {
  const bool first_runs =
      first_axis_ != nullptr && first_axis_->set_up() && first_axis_->status().state != DrivePhase::kFault;
  if (first_runs) first_axis_->begin(reset, now_ns);
  phase_ = Phase::kSetup;
  setup_.restart();
  reader_.cancel();
  reset_ = reset;
  power_ = PowerState::kUnknown;
  emergency_ = 0;
  counts_.reset();
  velocity_ = 0;
  velocity_ns_ = 0;
  next_nmt_ns_ = now_ns;
  reset_cycles_ = 0;
  has_voltage_ = true;
}

void Cia402Drive::receive(const can_frame& frame, std::int64_t now_ns) noexcept {
  if (!is_standard_data(frame)) return;
  const auto nmt = canopen::decode_nmt(frame);
  const auto sdo = canopen::decode_sdo(canopen::SdoSide::kRequest, node(), frame);
  if ((nmt && (nmt->node == 0 || nmt->node == node())) || (sdo && sdo->command == canopen::SdoCommand::kDownload) ||
      (set_up() && frame.can_id == setup_.pdos().command.cob_id(node()))) {
    return fail(DriveCause::kForeignCommander, "", frame.can_id);
  }
  setup_.receive(frame);
  reader_.receive(frame);
  receive_network(frame, now_ns);
  if (phase_ > Phase::kSetup) receive_state(frame, now_ns);
}

void Cia402Drive::receive_network(const can_frame& frame, std::int64_t now_ns) noexcept {
  if (const auto emergency = canopen::decode_emergency(frame); emergency && emergency->node == node()) {
    if (emergency->code != 0) emergency_ = emergency->code;
  }
  const auto heartbeat = canopen::decode_heartbeat(frame);
  if (!heartbeat || heartbeat->node != node()) return;
  if (phase_ == Phase::kRunning) {
    if (heartbeat->state == NmtState::kBootUp) fail(DriveCause::kRestarted);
    if (heartbeat->state != NmtState::kOperational) {
      fail(DriveCause::kReleased, "NMT state", static_cast<std::uint8_t>(heartbeat->state));
    }
  } else if (heartbeat->state == NmtState::kBootUp && !disabled()) {
    restart(reset_, now_ns);
  }
}

void Cia402Drive::receive_state(const can_frame& frame, std::int64_t now_ns) noexcept {
  std::array<std::int64_t, canopen::kMaxPdoEntries> values{};
  const AxisPdos& pdos = setup_.pdos();
  const auto own = [this](const PdoEntry& entry) {
    return on_axis(entry.object, static_cast<unsigned>(parameters_.axis));
  };
  if (sends_velocity() && decode_pdo(pdos.velocity, node(), frame, values)) {
    velocity_ =
        setup_.units().velocity(static_cast<std::int32_t>(value_of(pdos.velocity, values, own(kVelocityEntry))));
    velocity_ns_ = now_ns;
    return accept_velocity(velocity_);
  }
  if (!decode_pdo(pdos.state, node(), frame, values)) return;
  statusword_ = static_cast<std::uint16_t>(value_of(pdos.state, values, own(kStatuswordEntry)));
  power_ = power_state(statusword_);
  const auto raw = static_cast<std::int32_t>(value_of(pdos.state, values, own(kPositionEntry)));
  const double count = 2 * std::numbers::pi / setup_.units().counts_per_turn;
  counts_ = continued_count(counts_.value_or(raw), raw);
  const double position = count * static_cast<double>(*counts_);
  if (needs_velocity() && velocity_ns_ == 0) return judge_power();
  if (has_velocity(now_ns)) {
    accept_position(position, velocity_, now_ns);
  } else {
    accept_position(position, now_ns);
  }
  const auto torque = static_cast<std::int16_t>(value_of(pdos.state, values, own(kTorqueEntry)));
  accept_motor_torque(setup_.units().torque(torque), now_ns);
  judge_power();
}

void Cia402Drive::judge_power() noexcept {
  const bool fault = power_ == PowerState::kFault || power_ == PowerState::kFaultReactionActive;
  if (fault && (phase_ == Phase::kRunning || !reset_)) {
    fail(DriveCause::kDriveError, "", emergency_);
  } else if (phase_ == Phase::kRunning && power_ != PowerState::kOperationEnabled) {
    fail(DriveCause::kReleased, power_state_words(power_));
  }
}

void Cia402Drive::advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept {
  if (disabled()) {
    if (!set_up()) return;
    send_command(Controlword::kQuickStop, send);
    return read_error(now_ns, send);
  }
  const Cia402Drive* other = first_axis_ != nullptr ? first_axis_ : second_axis_;
  if (other != nullptr && other->disabled() && set_up()) return fail(DriveCause::kOtherAxis);
  if (first_axis_ != nullptr && set_up() && !first_axis_->set_up()) restart(reset_, now_ns);
  if (phase_ == Phase::kSetup) return advance_setup(now_ns, send);
  if (phase_ == Phase::kStart) {
    set(DrivePhase::kStarting, DriveCause::kFirstSample);
    if (second_axis_ == nullptr) send_nmt(NmtCommand::kStart, now_ns, send);
    if (!sample().valid) return;
    know_reaction(setup_.on_silence(),
                  setup_.on_silence() == SilenceReaction::kUnknown ? ReactionEvidence::kNone : ReactionEvidence::kRead);
    settle_reaction();
    phase_ = Phase::kReady;
  }
  advance_power(command, now_ns, send);
}

void Cia402Drive::advance_setup(std::int64_t now_ns, FrameBatch& send) noexcept {
  if (first_axis_ != nullptr && !first_axis_->set_up()) return set(DrivePhase::kStarting, DriveCause::kIdentity);
  if (!setup_.answered() && first_axis_ == nullptr) send_nmt(NmtCommand::kEnterPreOperational, now_ns, send);
  const DriveSetup::Result result = setup_.step(now_ns, send);
  if (result == DriveSetup::Result::kNoAnswer) return restart(reset_, now_ns);
  if (result == DriveSetup::Result::kRefused) {
    const SetupProblem& problem = setup_.problem();
    return fail(problem.cause, problem.subject, problem.code, problem.found, problem.expected);
  }
  if (result == DriveSetup::Result::kDone) phase_ = Phase::kStart;
  if (setup_.answered()) {
    set(DrivePhase::kStarting, DriveCause::kSetup, "", setup_.object());
  } else {
    set(DrivePhase::kStarting, DriveCause::kFirstFrame);
  }
}

void Cia402Drive::advance_power(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept {
  if (!command.enabled) {
    phase_ = Phase::kReady;
    set(DrivePhase::kReady, DriveCause::kEnable);
    return send_command(Controlword::kDisableVoltage, send);
  }
  if (phase_ == Phase::kReady) {
    phase_ = Phase::kPower;
    deadline_ns_ = now_ns + kPowerNs;
    next_reset_ns_ = now_ns + kResetCycles * period_ns_;
  }
  if (phase_ == Phase::kRunning) {
    if (needs_velocity() && !has_velocity(now_ns)) return fail(DriveCause::kSilent, "velocity");
    set(DrivePhase::kRunning, DriveCause::kNone);
    read_voltage(now_ns, send);
    return send_command(Controlword::kEnableOperation, send, command);
  }
  set(DrivePhase::kReady, DriveCause::kPower, power_state_words(power_));
  if (power_ == PowerState::kOperationEnabled) {
    phase_ = Phase::kRunning;
    reset_ = false;
    emergency_ = 0;
  } else if (now_ns > deadline_ns_) {
    return fail(DriveCause::kStaysOff, power_state_words(power_));
  }
  const bool resets = power_ == PowerState::kFault && resets_fault(now_ns);
  send_command(resets ? Controlword::kFaultReset : step_to_operation(power_), send);
}

bool Cia402Drive::resets_fault(std::int64_t now_ns) noexcept {
  if (now_ns >= next_reset_ns_) {
    next_reset_ns_ = now_ns + kResetNs;
    reset_cycles_ = kResetCycles;
    if (!may_clear()) fail(DriveCause::kDriveError, power_state_words(power_), emergency_);
  }
  if (disabled() || reset_cycles_ == 0) return false;
  --reset_cycles_;
  return true;
}

std::optional<std::uint32_t> Cia402Drive::read_object(const ObjectAddress& object, std::int64_t now_ns,
                                                      FrameBatch& send) noexcept {
  const ObjectAddress own = on_axis(object, static_cast<unsigned>(parameters_.axis));
  const SdoClient::Result result = read_ == own ? reader_.result() : SdoClient::Result::kIdle;
  if (result == SdoClient::Result::kDone) {
    reader_.cancel();
    return reader_.value();
  }
  if (result == SdoClient::Result::kIdle || result == SdoClient::Result::kNoAnswer) {
    read_ = own;
    reader_.read(own);
  }
  reader_.step(now_ns, send);
  return std::nullopt;
}

void Cia402Drive::read_error(std::int64_t now_ns, FrameBatch& send) noexcept {
  if (status().cause != DriveCause::kDriveError || emergency_ != 0) return;
  const auto code = read_object(kErrorCode, now_ns, send);
  if (code) emergency_ = static_cast<std::uint16_t>(*code);
}

void Cia402Drive::read_voltage(std::int64_t now_ns, FrameBatch& send) noexcept {
  if (!has_voltage_ || now_ns < next_voltage_ns_) return;
  const auto voltage = read_object(kDcLinkVoltage, now_ns, send);
  if (reader_.result() == SdoClient::Result::kAborted) has_voltage_ = false;
  if (!voltage) return;
  next_voltage_ns_ = now_ns + kVoltageNs;
  accept_voltage(dc_link_voltage(*voltage));
}

void Cia402Drive::send_command(std::uint16_t controlword, FrameBatch& send,
                               const DriveCommand& command) const noexcept {
  const Pdo& pdo = setup_.pdos().command;
  const auto axis = static_cast<unsigned>(parameters_.axis);
  std::array<std::int64_t, canopen::kMaxPdoEntries> values{};
  for (std::size_t i = 0; i < pdo.mapping.count; ++i) {
    const ObjectAddress& object = pdo.mapping.entries[i].object;
    if (object == on_axis(kControlwordEntry.object, axis)) values[i] = controlword;
    if (object == on_axis(kTargetTorqueEntry.object, axis))
      values[i] = setup_.units().raw_torque(motor_torque(command.torque));
    if (object == on_axis(kTargetVelocityEntry.object, axis))
      values[i] = setup_.units().raw_velocity(motor_speed(command.speed));
    if (object == on_axis(kModeOfOperation, axis)) values[i] = static_cast<std::int64_t>(setup_.mode());
  }
  send.add(encode_pdo(pdo, node(), values));
}

void Cia402Drive::send_nmt(NmtCommand command, std::int64_t now_ns, FrameBatch& send) noexcept {
  if (now_ns < next_nmt_ns_) return;
  next_nmt_ns_ = now_ns + kNmtNs;
  send.add(canopen::encode_nmt({.command = command, .node = node()}));
}

VelocitySource Cia402Drive::velocity_source() const noexcept {
  const VelocitySource source = setup_.velocity_source();
  return source == VelocitySource::kDrive && set_up() && velocity_ns_ == 0 ? VelocitySource::kNotSent : source;
}

std::string Cia402Drive::code_words(const DriveStatus& status) const {
  switch (status.cause) {
    case DriveCause::kDriveError:
      return hexadecimal(status.details[0]) + " (" +
             canopen::error_code_words(static_cast<std::uint16_t>(status.details[0])) + ")";
    case DriveCause::kLacks:
    case DriveCause::kRefused:
      if (status.code == 0) return "";
      return "(" + hexadecimal(status.code) + ": " + canopen::abort_words(static_cast<std::uint32_t>(status.code)) +
             ")";
    case DriveCause::kSetup:
      return formatted("%04llX:%02llX", static_cast<unsigned long long>(status.code >> 8U),
                       static_cast<unsigned long long>(status.code & 0xFFU));
    default:
      return status.code == 0 ? "" : hexadecimal(status.code);
  }
}

}  // namespace robot_control::cia402
