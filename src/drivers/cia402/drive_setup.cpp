#include "drivers/cia402/drive_setup.h"

#include <algorithm>
#include <cmath>

namespace robot_control::cia402 {
namespace {

using canopen::entry_of;
using canopen::mapped;
using canopen::SdoClient;
using canopen::SdoWrite;

constexpr std::uint8_t kVelocityIndex = 2;  // of its PDO
constexpr unsigned kMaxModeReads = 200;     // until 6061 shows the mode that was written to 6060
constexpr double kSameTorque = 0.01;        // between the drive file and 6076

/// The period as value · 10^index s; a value of 0 if it is no such number.
struct Period {
  std::uint8_t value = 0;
  std::int8_t index = 0;
};

Period period_of(double seconds) {
  for (std::int8_t index = -3; index >= -6; --index) {
    const double value = seconds / std::pow(10.0, index);
    if (value <= 255 && std::abs(value - std::round(value)) < 1.0e-6 * value) {
      return {static_cast<std::uint8_t>(std::lround(value)), index};
    }
  }
  return {};
}

}  // namespace

DriveSetup::DriveSetup(const Cia402Parameters& parameters, std::uint8_t host, double period)
    : parameters_(parameters), client_(static_cast<std::uint8_t>(parameters.drive.node)) {
  pdos_ = pdos_of(static_cast<unsigned>(parameters_.axis), parameters_.drive.takes_speeds);
  read(kVendor, parameters_.vendor != 0 ? Use::kEqual : Use::kNone, false, "vendor (1018:1)",
       static_cast<std::uint32_t>(parameters_.vendor));
  read(kProduct, parameters_.product != 0 ? Use::kEqual : Use::kNone, parameters_.product == 0, "product (1018:2)",
       static_cast<std::uint32_t>(parameters_.product));
  write({0x6040, 0}, 0, 2, Use::kNone, true, "controlword (6040)");
  write({0x6071, 0}, 0, 2, Use::kNone, true, "target torque (6071)");
  if (parameters_.drive.takes_speeds) write({0x60FF, 0}, 0, 4, Use::kNone, true, "target velocity (60FF)");
  add_motor_steps(period);
  add_silence_steps(host);
  add_pdo_steps(0, "RPDO of controlword and target");
  add_pdo_steps(1, "TPDO of statusword, position and torque");
  read(kVelocityUnit, Use::kUnit, true, "unit of the velocity (60A9)");
  add_pdo_steps(kVelocityIndex, "TPDO of the velocity");
  restart();
}

void DriveSetup::read(const ObjectAddress& object, Use use, bool optional, const char* subject,
                      std::uint32_t expected) {
  steps_.push_back({.write = {.object = own(object), .value = expected},
                    .use = use,
                    .kind = Kind::kRead,
                    .optional = optional,
                    .subject = subject});
}

void DriveSetup::write(const ObjectAddress& object, std::uint32_t value, std::uint8_t bytes, Use use, bool optional,
                       const char* subject) {
  steps_.push_back({.write = {.object = own(object), .value = value, .bytes = bytes},
                    .use = use,
                    .kind = Kind::kWrite,
                    .optional = optional,
                    .subject = subject});
}

void DriveSetup::add_motor_steps(double period) {
  read(kSupportedModes, Use::kModes, true, "supported modes (6502)");
  write(kModeOfOperation, 0, 1, Use::kMode, false, "mode (6060)");
  read(kModeDisplay, Use::kMode, true, "mode display (6061)");
  read(kRatedTorque, Use::kRated, true, "rated torque (6076)");
  read(kMaxTorque, Use::kMaximum, true, "maximum torque (6072)");
  if (parameters_.torque_slope > 0) write(kTorqueSlope, 0, 4, Use::kSlope, false, "torque slope (6087)");
  read({0x608F, 1}, Use::kIncrements, true, "increments (608F:1)");
  read({0x608F, 2}, Use::kRevolutions, true, "revolutions (608F:2)");
  read({0x6091, 1}, Use::kMotorTurns, true, "motor revolutions (6091:1)");
  read({0x6091, 2}, Use::kShaftTurns, true, "shaft revolutions (6091:2)");
  read({0x6092, 1}, Use::kFeed, true, "feed (6092:1)");
  read({0x6092, 2}, Use::kFeedTurns, true, "shaft revolutions (6092:2)");
  if (const Period cycle = period_of(period); cycle.value != 0) {
    write(kPeriodValue, cycle.value, 1, Use::kNone, true, "period (60C2:1)");
    write(kPeriodIndex, static_cast<std::uint8_t>(cycle.index), 1, Use::kNone, true, "period (60C2:2)");
    read(kPeriodValue, Use::kEqual, true, "period (60C2:1)", cycle.value);
    read(kPeriodIndex, Use::kEqual, true, "period (60C2:2)", static_cast<std::uint8_t>(cycle.index));
  }
}

void DriveSetup::add_silence_steps(std::uint8_t host) {
  constexpr std::uint16_t kHeartbeatMs = 100;
  const auto timeout_ms = static_cast<std::uint16_t>(std::lround(1000 * parameters_.host_timeout));
  const auto set = [this](const ObjectAddress& object, std::int64_t value, std::uint8_t bytes, Use use,
                          const char* subject) {
    const auto raw = static_cast<std::uint32_t>(value);
    write(object, raw, bytes, Use::kNone, true, subject);
    if (use != Use::kNone) read(object, use, true, subject, raw);
  };
  set(kHeartbeatProducer, kHeartbeatMs, 2, Use::kNone, "heartbeat (1017)");
  set(kErrorBehaviour, 0, 1, Use::kNone, "error behaviour (1029)");
  set(kHeartbeatConsumer, canopen::heartbeat_consumer(host, timeout_ms), 4, Use::kConsumer, "host's heartbeat (1016)");
  set(kAbortConnectionOption, parameters_.abort_option, 2, Use::kAbortOption, "abort option (6007)");
  set(kQuickStopOption, parameters_.quick_stop_option, 2, Use::kQuickStop, "quick stop option (605A)");
  set(kFaultReactionOption, parameters_.fault_reaction, 2, Use::kFaultReaction, "fault reaction (605E)");
}

void DriveSetup::add_pdo_steps(std::uint8_t index, const char* subject) {
  const Pdo& own_pdo = pdo(index);
  const std::uint16_t parameters = own_pdo.parameters(), mapping = own_pdo.mapping_index();
  const std::size_t first = steps_.size();
  if (parameters_.pdos == PdoSource::kFixed) {
    read({mapping, 0}, Use::kMappingCount, false, subject);
    for (std::uint8_t i = 1; i <= canopen::kMaxPdoEntries; ++i) read({mapping, i}, Use::kMappingEntry, false, subject);
    read({parameters, 1}, Use::kCobId, false, subject, own_pdo.cob_id(client_.node()));
    if (index == kVelocityIndex) read({parameters, 2}, Use::kSyncs, true, subject);
  } else {
    const std::uint8_t type = index == kVelocityIndex              ? kVelocitySyncs
                              : own_pdo.kind == PdoKind::kTransmit ? canopen::kEverySync
                                                                   : canopen::kOnEvent;
    const canopen::PdoSetup setup = pdo_setup(own_pdo, client_.node(), type, 0);
    read({parameters, 1}, Use::kPresentCobId, false, subject);
    for (const SdoWrite& each : setup.all()) {
      const bool cob_id = each.object == ObjectAddress{parameters, 1};
      write(each.object, each.value, each.bytes, cob_id ? Use::kCobId : Use::kNone, false, subject);
    }
    for (const SdoWrite& each : setup.all().subspan(2)) {
      const bool cob_id = each.object == ObjectAddress{parameters, 1};
      read(each.object, cob_id ? Use::kCobId : Use::kEqual, false, subject, each.value);
    }
  }
  for (std::size_t i = first; i < steps_.size(); ++i) steps_[i].pdo = index;
}

void DriveSetup::restart() noexcept {
  next_ = 0;
  client_.cancel();
  problem_ = {};
  pdos_ = pdos_of(static_cast<unsigned>(parameters_.axis), parameters_.drive.takes_speeds);
  units_ = {.rated_torque = parameters_.rated_torque,
            .counts_per_turn = parameters_.counts_per_turn,
            .velocity_unit = parameters_.velocity_unit};
  velocity_ = VelocitySource::kDrive;
  if (parameters_.velocity_pdo == VelocityPdo::kOff) velocity_ = VelocitySource::kNotRequested;
  if (parameters_.velocity_pdo == VelocityPdo::kDerived && !parameters_.velocity_has_room)
    velocity_ = VelocitySource::kNoRoom;
  numerator_ = encoder_ = gear_ = feed_ = 0;
  repeats_ = 0;
  expects_host_ = false;
  abort_option_ = quick_stop_ = fault_reaction_ = -1;
}

std::uint64_t DriveSetup::object() const noexcept {
  if (next_ >= steps_.size()) return 0;
  const ObjectAddress& object = steps_[next_].write.object;
  return static_cast<std::uint64_t>(object.index) << 8U | object.sub;
}

DriveSetup::Result DriveSetup::step(std::int64_t now_ns, FrameBatch& send) noexcept {
  while (next_ < steps_.size() && problem_.cause == DriveCause::kNone) {
    const Step& step = steps_[next_];
    const bool skipped = (step.use == Use::kMappingEntry && step.write.object.sub > mapped_) ||
                         (step.use == Use::kSlope && mode_ != Mode::kTorque) ||
                         (step.pdo == kVelocityIndex && velocity_ != VelocitySource::kDrive);
    if (skipped) {
      ++next_;
      continue;
    }
    if (client_.result() == SdoClient::Result::kIdle) begin(step);
    client_.step(now_ns, send);
    const SdoClient::Result result = client_.result();
    if (result == SdoClient::Result::kPending) return Result::kPending;
    client_.cancel();
    if (result == SdoClient::Result::kNoAnswer) return Result::kNoAnswer;
    ++next_;
    const bool present = result == SdoClient::Result::kDone;
    if (!present && !step.optional) {
      refuse(step.kind == Kind::kRead ? DriveCause::kLacks : DriveCause::kRefused, step.subject, client_.abort_code());
    } else if (step.kind == Kind::kRead) {
      evaluate(step, present, client_.value());
    }
    if (step.pdo == kVelocityIndex) leave_velocity_out();
  }
  if (problem_.cause != DriveCause::kNone) return Result::kRefused;
  judge_pdos();
  return problem_.cause != DriveCause::kNone ? Result::kRefused : Result::kDone;
}

void DriveSetup::begin(const Step& step) noexcept {
  if (step.kind == Kind::kRead) return client_.read(step.write.object);
  SdoWrite write = step.write;
  if (step.use == Use::kCobId) write.value |= present_cob_id_ & canopen::kPdoWithoutRtr;
  if (step.use == Use::kMode) write.value = static_cast<std::uint8_t>(mode_);
  if (step.use == Use::kSlope) {
    write.value = static_cast<std::uint32_t>(std::lround(1000 * parameters_.torque_slope / units_.rated_torque));
  }
  client_.write(write);
}

void DriveSetup::evaluate(const Step& step, bool present, std::uint32_t value) noexcept {
  switch (step.use) {
    case Use::kEqual:
      if (present && value != step.write.value) refuse(DriveCause::kDiffers, step.subject, 0, value, step.write.value);
      break;
    case Use::kModes:
      judge_modes(present, value);
      break;
    case Use::kMode:
      if (!present || (value & 0xFFU) == static_cast<std::uint8_t>(mode_)) break;
      --next_;
      if (++repeats_ == kMaxModeReads) refuse(DriveCause::kDiffers, step.subject, 0, value, static_cast<double>(mode_));
      break;
    case Use::kRated:
    case Use::kMaximum:
      judge_torque(step, present, value);
      break;
    case Use::kIncrements:
    case Use::kMotorTurns:
    case Use::kFeed:
      numerator_ = present ? value : 0;
      break;
    case Use::kRevolutions:
      encoder_ = quotient(present, value);
      break;
    case Use::kShaftTurns:
      gear_ = quotient(present, value);
      break;
    case Use::kFeedTurns:
      feed_ = quotient(present, value);
      judge_counts();
      break;
    case Use::kUnit:
      judge_velocity_unit(present, value);
      break;
    case Use::kSyncs:
      // A velocity that comes on an event only would be silent at rest.
      if (parameters_.velocity_pdo == VelocityPdo::kDerived && (!present || value == 0 || value > kVelocitySyncs))
        velocity_ = VelocitySource::kNotMapped;
      break;
    case Use::kConsumer:
    case Use::kAbortOption:
    case Use::kQuickStop:
    case Use::kFaultReaction:
      judge_silence(step, present, value);
      break;
    default:
      judge_mapping(step, value);
  }
}

void DriveSetup::judge_modes(bool present, std::uint32_t modes) noexcept {
  const bool speeds = parameters_.drive.takes_speeds;
  const Mode cyclic = speeds ? Mode::kCyclicVelocity : Mode::kCyclicTorque;
  const Mode profile = speeds ? Mode::kProfileVelocity : Mode::kTorque;
  if (parameters_.mode != ModeChoice::kAny) {
    const bool is_cyclic =
        parameters_.mode == ModeChoice::kCyclicTorque || parameters_.mode == ModeChoice::kCyclicVelocity;
    mode_ = is_cyclic ? cyclic : profile;
  } else if (present && supports(modes, cyclic)) {
    mode_ = cyclic;
  } else if (present && supports(modes, profile)) {
    mode_ = profile;
  } else {
    refuse(DriveCause::kLacks,
           speeds ? "velocity mode in its supported modes (6502)" : "torque mode in its supported modes (6502)");
  }
}

void DriveSetup::judge_counts() noexcept {
  if (units_.counts_per_turn != 0) return;  // stated in the drive file
  const std::optional<double> counts = counts_per_turn({.encoder = encoder_, .gear = gear_, .feed = feed_});
  if (!counts) return refuse(DriveCause::kLacks, "feed constant (6092) beside its gear (6091); set counts_per_turn");
  if (*counts == 0) return refuse(DriveCause::kLacks, "increments per turn (608F); set counts_per_turn");
  units_.counts_per_turn = *counts;
}

void DriveSetup::judge_velocity_unit(bool present, std::uint32_t value) noexcept {
  if (units_.velocity_unit != 0) return;  // stated in the drive file
  const bool of_the_motor = gear_ == 0 || gear_ == 1;
  if (present && of_the_motor) units_.velocity_unit = velocity_unit(value);
  if (units_.velocity_unit != 0) return;
  if (parameters_.drive.takes_speeds)
    return refuse(DriveCause::kLacks, "unit of the velocity (60A9); set velocity_unit");
  units_.velocity_unit = kRpm;
  if (parameters_.velocity_pdo == VelocityPdo::kDerived && velocity_ == VelocitySource::kDrive)
    velocity_ = VelocitySource::kNoUnit;
}

void DriveSetup::leave_velocity_out() noexcept {
  if (parameters_.velocity_pdo != VelocityPdo::kDerived || problem_.cause == DriveCause::kNone) return;
  problem_ = {};
  velocity_ = VelocitySource::kNotMapped;
}

void DriveSetup::judge_torque(const Step& step, bool present, std::uint32_t value) noexcept {
  if (step.use == Use::kRated) {
    const double read = present ? rated_torque(value) : 0;
    const double stated = parameters_.rated_torque;
    if (stated == 0 && read == 0) return refuse(DriveCause::kLacks, "rated torque (6076); set rated_torque");
    if (stated != 0 && read != 0 && std::abs(read - stated) > kSameTorque * stated) {
      return refuse(DriveCause::kDiffers, step.subject, 0, read, stated);
    }
    units_.rated_torque = stated != 0 ? stated : read;
    return;
  }
  constexpr double kMaxRaw = 32767;  // ‰ in 6071
  const double needed = parameters_.drive.torque_limit / parameters_.drive.gear;
  const double maximum = std::fmin(present ? value & 0xFFFFU : kMaxRaw, kMaxRaw) * units_.rated_torque / 1000;
  if (maximum < (1 - kSameTorque) * needed) refuse(DriveCause::kDiffers, step.subject, 0, maximum, needed);
}

void DriveSetup::judge_silence(const Step& step, bool present, std::uint32_t value) noexcept {
  if (!present) return;
  const auto option = static_cast<std::int16_t>(value & 0xFFFFU);
  if (step.use == Use::kConsumer) expects_host_ = value == step.write.value;
  if (step.use == Use::kAbortOption) abort_option_ = option;
  if (step.use == Use::kQuickStop) quick_stop_ = option;
  if (step.use == Use::kFaultReaction) fault_reaction_ = option;
}

void DriveSetup::judge_mapping(const Step& step, std::uint32_t value) noexcept {
  if (step.use == Use::kPresentCobId) present_cob_id_ = value;
  if (step.use == Use::kCobId && (value & ~canopen::kPdoWithoutRtr) != step.write.value) {
    refuse(DriveCause::kDiffers, step.subject, 0, value, step.write.value);
  }
  canopen::PdoMapping& mapping = pdo(step.pdo).mapping;
  if (step.use == Use::kMappingCount) {
    mapped_ = static_cast<std::uint8_t>(std::min<std::uint32_t>(value & 0xFFU, canopen::kMaxPdoEntries));
    mapping = {};
  }
  if (step.use == Use::kMappingEntry) mapping.entries[mapping.count++] = entry_of(value);
}

void DriveSetup::judge_pdos() noexcept {
  const AxisPdos needed = pdos_of(static_cast<unsigned>(parameters_.axis), parameters_.drive.takes_speeds);
  judge_pdo(pdos_.command, needed.command, true);
  judge_pdo(pdos_.state, needed.state, false);
  if (velocity_ != VelocitySource::kDrive || problem_.cause != DriveCause::kNone) return;
  judge_pdo(pdos_.velocity, needed.velocity, false);
  leave_velocity_out();
}

void DriveSetup::judge_pdo(Pdo& found, const Pdo& needed, bool complete) noexcept {
  for (std::size_t i = 0; i < needed.mapping.count; ++i) {
    const PdoEntry& entry = needed.mapping.entries[i];
    if (mapped(found, entry) == nullptr) refuse(DriveCause::kLacks, "an entry of its PDO:", entry.mapped());
  }
  for (std::size_t i = 0; i < found.mapping.count; ++i) {
    PdoEntry& entry = found.mapping.entries[i];
    if (entry.bits == 0 || entry.bits > 32 || entry.bits % 8 != 0)
      refuse(DriveCause::kDiffers, "bits of an entry of its PDO", 0, entry.bits, 32);
    if (const PdoEntry* const known = mapped(needed, entry)) {
      entry = *known;
    } else if (complete && entry.object != own(kModeOfOperation)) {
      refuse(DriveCause::kDiffers, "its RPDO, which holds another object:", entry.mapped());
    }
  }
  if (found.mapping.bits() > 64) refuse(DriveCause::kDiffers, "bits of its PDO", 0, found.mapping.bits(), 64);
}

SilenceReaction DriveSetup::on_silence() const noexcept {
  if (!expects_host_) return SilenceReaction::kUnknown;
  const auto reaction_of = [](std::int64_t option) {
    if (option < 0) return SilenceReaction::kUnknown;
    if (option == 0) return SilenceReaction::kCoasts;
    return option < 5 ? SilenceReaction::kBrakes : SilenceReaction::kHolds;
  };
  switch (abort_option_) {
    case 1:
      return reaction_of(fault_reaction_);
    case 2:
      return SilenceReaction::kCoasts;
    case 3:
      return reaction_of(quick_stop_);
    default:
      return SilenceReaction::kUnknown;
  }
}

void DriveSetup::refuse(DriveCause cause, const char* subject, std::uint64_t code, double found,
                        double expected) noexcept {
  if (problem_.cause == DriveCause::kNone) problem_ = {cause, subject, code, found, expected};
}

}  // namespace robot_control::cia402
