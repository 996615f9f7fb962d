#include "drivers/cia402/cia402_device.h"

#include <algorithm>

#include "drivers/cia402/cia402_parameters.h"
#include "drivers/drive/can_front.h"

namespace robot_control {
namespace {

using namespace cia402;  // NOLINT(google-build-using-namespace): the objects of this device
using canopen::entry_of;
using canopen::NmtCommand;
using canopen::NmtState;
using canopen::SdoSide;

constexpr std::uint8_t kPdos = 4;
constexpr std::uint16_t kHostLost = 0x8130, kSensorFault = 0x7305, kSupplyTooLow = 0x3220;
constexpr ObjectAddress kControlword{0x6040, 0}, kStatusword{0x6041, 0}, kTarget{0x6071, 0}, kTargetVelocity{0x60FF, 0},
    kTorque{0x6077, 0}, kPosition{0x6064, 0}, kVelocity{0x606C, 0}, kErrorRegister{0x1001, 0};

}  // namespace

Cia402Device::Cia402Device(const Cia402DeviceParameters& parameters, VirtualCan& bus, std::vector<DeviceMotor*> motors)
    : Device(bus), parameters_(parameters) {
  for (DeviceMotor* motor : motors) axes_.push_back({.motor = motor});
  boot();
}

std::uint32_t Cia402Device::at(const ObjectAddress& object, unsigned axis) const {
  return objects_.value(on_axis(object, axis));
}

void Cia402Device::add_objects() {
  objects_ = {};
  objects_.add(kErrorRegister, 0, 1, false);
  objects_.add(kHeartbeatProducer, 0, 2, true);
  objects_.add({0x1018, 0}, 4, 1, false);
  objects_.add(kVendor, parameters_.vendor, 4, false);
  objects_.add(kProduct, parameters_.product, 4, false);
  objects_.add(kRevision, 1, 4, false);
  objects_.add(kSerialNumber, parameters_.node, 4, false);
  if (parameters_.has_reactions) {
    objects_.add(kHeartbeatConsumer, 0, 4, true);
    objects_.add(kErrorBehaviour, 0, 1, true);
  }
  for (unsigned axis = 0; axis < axes_.size(); ++axis) add_axis_objects(axis);
  add_pdos();
}

void Cia402Device::add_axis_objects(unsigned axis) {
  const auto add = [&](const ObjectAddress& object, std::uint32_t value, std::uint8_t bytes, bool writable) {
    objects_.add(on_axis(object, axis), value, bytes, writable);
  };
  add(kControlword, 0, 2, true);
  add(kStatusword, 0, 2, false);
  add(kModeOfOperation, 0, 1, true);
  add(kModeDisplay, 0, 1, false);
  add(kSupportedModes, parameters_.supported_modes, 4, false);
  add(kErrorCode, 0, 2, false);
  add(kTarget, 0, 2, true);
  add(kTargetVelocity, 0, 4, true);
  add(kMaxTorque, 3000, 2, true);
  add(kRatedTorque, static_cast<std::uint32_t>(std::lround(1000 * parameters_.rated_torque)), 4, false);
  add(kTorque, 0, 2, false);
  add(kTorqueSlope, 20000, 4, true);
  add(kPosition, 0, 4, false);
  add(kVelocity, 0, 4, false);
  add(kDcLinkVoltage, 48000, 4, false);
  add({0x608F, 1}, static_cast<std::uint32_t>(std::lround(parameters_.counts_per_turn)), 4, false);
  add({0x608F, 2}, 1, 4, false);
  if (parameters_.velocity_unit == kRpm) add(kVelocityUnit, 0x00B4'4700, 4, true);
  add(kPeriodValue, 1, 1, true);
  add(kPeriodIndex, 0xFD, 1, true);
  if (!parameters_.has_reactions) return;
  add(kAbortConnectionOption, 1, 2, true);
  add(kQuickStopOption, 2, 2, true);
  add(kFaultReactionOption, 2, 2, true);
}

void Cia402Device::add_pdos() {
  for (const PdoKind kind : {PdoKind::kReceive, PdoKind::kTransmit}) {
    for (std::uint8_t number = 1; number <= kPdos; ++number) {
      const Pdo pdo{.kind = kind, .number = number, .mapping = {}};
      const bool writable = !parameters_.fixed_mapping;
      const std::uint32_t off =
          parameters_.fixed_mapping && (number - 1) / 2 < static_cast<int>(axes_.size()) ? 0 : canopen::kPdoDisabled;
      objects_.add({pdo.parameters(), 0}, 2, 1, false);
      objects_.add({pdo.parameters(), 1}, pdo.cob_id(parameters_.node) | off | canopen::kPdoWithoutRtr, 4, writable);
      objects_.add({pdo.parameters(), 2}, kind == PdoKind::kTransmit ? canopen::kEverySync : canopen::kOnEvent, 1,
                   writable);
      objects_.add({pdo.mapping_index(), 0}, 0, 1, writable);
      for (std::uint8_t i = 1; i <= canopen::kMaxPdoEntries; ++i)
        objects_.add({pdo.mapping_index(), i}, 0, 4, writable);
    }
  }
  if (!parameters_.fixed_mapping) return;
  for (unsigned axis = 0; axis < axes_.size(); ++axis) {
    AxisPdos pdos = pdos_of(axis, parameters_.supported_modes == Cia402DeviceParameters::kSpeedModes);
    for (Pdo* pdo : {&pdos.command, &pdos.state, &pdos.velocity}) {
      objects_.set({pdo->mapping_index(), 0}, pdo->mapping.count);
      for (std::uint8_t i = 0; i < pdo->mapping.count; ++i) {
        objects_.set({pdo->mapping_index(), static_cast<std::uint8_t>(i + 1)}, pdo->mapping.entries[i].mapped());
      }
    }
  }
}

void Cia402Device::boot() {
  announced_ = false;
  nmt_ = NmtState::kPreOperational;
  host_ns_ = -1;
  for (Axis& axis : axes_) {
    axis = {.motor = axis.motor, .zero = axis.motor->position};
    axis.motor->torque = 0;
  }
  add_objects();
}

void Cia402Device::begin_fault() {
  if (fault() == DeviceFault::kOtherZero) axes_[0].zero += kOtherZero;
  if (fault() == DeviceFault::kReleased) axes_[0].power = PowerState::kSwitchOnDisabled;
  if (fault() == DeviceFault::kEncoder) fail(0, kSensorFault);
  if (fault() == DeviceFault::kUnderVoltage) fail(0, kSupplyTooLow);
  if (fault() == DeviceFault::kOff) {
    for (const Axis& axis : axes_) axis.motor->torque = 0;
  }
}

void Cia402Device::run(std::int64_t now_ns, double /*seconds*/) {
  const auto own = [this](double ns) { return static_cast<std::int64_t>(ns / (1 + 1.0e-6 * parameters_.clock_ppm)); };
  const std::int64_t heartbeat = own(1.0e6 * objects_.value(kHeartbeatProducer));
  if (!announced_ || (heartbeat > 0 && now_ns - heartbeat_ns_ >= heartbeat)) {
    transmit(canopen::encode_heartbeat({.node = parameters_.node, .state = announced_ ? nmt_ : NmtState::kBootUp}));
    announced_ = true;
    heartbeat_ns_ = now_ns;
  }
  const std::int64_t timeout = own(1.0e6 * (objects_.value(kHeartbeatConsumer) & 0xFFFFU));
  if (timeout > 0 && host_ns_ >= 0 && now_ns - host_ns_ > timeout) lose_host();
  for (unsigned axis = 0; axis < axes_.size(); ++axis) update_axis(axis);
}

void Cia402Device::lose_host() {
  host_ns_ = -1;
  transmit(canopen::encode_emergency({.node = parameters_.node, .code = kHostLost, .error_register = 0x11}));
  if (objects_.value(kErrorBehaviour) == 0) nmt_ = NmtState::kPreOperational;
  for (unsigned axis = 0; axis < axes_.size(); ++axis) {
    Axis& each = axes_[axis];
    if (each.power != PowerState::kOperationEnabled) continue;
    const std::uint32_t option = at(kAbortConnectionOption, axis);
    if (option == 1) fail(axis, kHostLost);
    if (option == 2) each.power = PowerState::kSwitchOnDisabled;
    if (option == 3) quick_stop(axis);
  }
}

double Cia402Device::max_torque(unsigned axis) const {
  return at(kMaxTorque, axis) * parameters_.rated_torque / 1000;
}

double Cia402Device::speed_torque(unsigned axis, double seconds) {
  Axis& own = axes_[axis];
  const double target = objects_.signed_value(on_axis(kTargetVelocity, axis)) * parameters_.velocity_unit;
  return own.speed_loop.step(target - own.motor->velocity, parameters_.brake_damping, max_torque(axis), seconds);
}

double Cia402Device::driven_torque(unsigned axis, double seconds) {
  Axis& own = axes_[axis];
  const double target = objects_.signed_value(on_axis(kTarget, axis)) * parameters_.rated_torque / 1000;
  const auto mode = static_cast<Mode>(at(kModeOfOperation, axis));
  if (mode == Mode::kCyclicVelocity || mode == Mode::kProfileVelocity) return speed_torque(axis, seconds);
  const double step = at(kTorqueSlope, axis) * parameters_.rated_torque / 1000 * seconds;
  if (mode == Mode::kTorque) {
    own.torque += std::clamp(target - own.torque, -step, step);
  } else {
    own.torque = mode == Mode::kCyclicTorque ? target : 0;
  }
  return std::clamp(own.torque, -max_torque(axis), max_torque(axis));
}

double Cia402Device::brake_torque(unsigned axis) {
  Axis& own = axes_[axis];
  double torque = -parameters_.brake_damping * own.motor->velocity;
  if (!own.holding && std::abs(own.motor->velocity) < parameters_.brake_hold_speed) {
    own.holding = true;
    own.held = own.motor->position;
    const bool stops = own.power == PowerState::kQuickStopActive;
    if (!stops) own.power = PowerState::kFault;
    if (stops && at(kQuickStopOption, axis) < 5) own.power = PowerState::kSwitchOnDisabled;
    if (own.power != PowerState::kQuickStopActive) return 0;
  }
  if (own.holding) torque += parameters_.brake_stiffness * (own.held - own.motor->position);
  return std::clamp(torque, -max_torque(axis), max_torque(axis));
}

void Cia402Device::update_axis(unsigned axis) {
  Axis& own = axes_[axis];
  const double seconds = 1.0e-9 * static_cast<double>(bus_ns() - own.updated_ns);
  own.updated_ns = bus_ns();
  const bool brakes = own.power == PowerState::kQuickStopActive || own.power == PowerState::kFaultReactionActive;
  if (own.power == PowerState::kOperationEnabled) {
    own.motor->torque = driven_torque(axis, seconds);
  } else {
    own.torque = 0;
    own.speed_loop.reset();
    own.motor->torque = brakes ? brake_torque(axis) : 0;
  }
}

void Cia402Device::refresh_objects(unsigned axis) {
  const Axis& own = axes_[axis];
  const auto set = [&](const ObjectAddress& object, double value) {
    objects_.set(on_axis(object, axis), static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(value))));
  };
  const double count = 2 * std::numbers::pi / parameters_.counts_per_turn;
  set(kPosition, (own.motor->position - own.zero) / count);
  set(kVelocity, own.motor->velocity / parameters_.velocity_unit);
  set(kTorque, 1000 * own.motor->torque / parameters_.rated_torque);
  set(kModeDisplay, objects_.signed_value(on_axis(kModeOfOperation, axis)));
  const bool follows = own.power == PowerState::kOperationEnabled;
  set(kStatusword, statusword_of(own.power) | StatusBits::kVoltageEnabled | StatusBits::kRemote |
                       (follows ? StatusBits::kFollowsCommand : 0));
}

void Cia402Device::quick_stop(unsigned axis) {
  Axis& own = axes_[axis];
  own.holding = false;
  own.power = at(kQuickStopOption, axis) == 0 ? PowerState::kSwitchOnDisabled : PowerState::kQuickStopActive;
}

void Cia402Device::fail(unsigned axis, std::uint16_t code) {
  Axis& own = axes_[axis];
  own.holding = false;
  own.power = at(kFaultReactionOption, axis) == 0 ? PowerState::kFault : PowerState::kFaultReactionActive;
  objects_.set(on_axis(kErrorCode, axis), code);
  objects_.set(kErrorRegister, 1);
  transmit(canopen::encode_emergency({.node = parameters_.node, .code = code, .error_register = 1}));
}

void Cia402Device::obey(unsigned axis, std::uint16_t controlword) {
  Axis& own = axes_[axis];
  const bool rising = (controlword & ~own.controlword & 0x80U) != 0;
  own.controlword = controlword;
  using enum PowerState;
  if (own.power == kFault) {
    if (rising && fault() != DeviceFault::kEncoder && fault() != DeviceFault::kUnderVoltage)
      own.power = kSwitchOnDisabled;
    return;
  }
  if (own.power == kFaultReactionActive || own.power == kNotReadyToSwitchOn) return;
  const bool powered = own.power == kOperationEnabled || own.power == kQuickStopActive;
  if ((controlword & 0x02U) == 0) {
    own.power = kSwitchOnDisabled;
  } else if ((controlword & 0x04U) == 0) {
    if (own.power == kOperationEnabled) quick_stop(axis);
    if (!powered) own.power = kSwitchOnDisabled;
  } else if (own.power == kQuickStopActive) {
    if ((controlword & 0x0FU) == 0x0F && at(kQuickStopOption, axis) >= 5) own.power = kOperationEnabled;
  } else if ((controlword & 0x01U) == 0) {
    own.power = kReadyToSwitchOn;
  } else if (own.power == kReadyToSwitchOn) {
    own.power = kSwitchedOn;
  } else if (own.power == kSwitchedOn || own.power == kOperationEnabled) {
    own.power = (controlword & 0x08U) != 0 ? kOperationEnabled : kSwitchedOn;
  }
}

void Cia402Device::receive(const can_frame& frame, std::int64_t now_ns) {
  if (!is_standard_data(frame)) return;
  if (const auto nmt = canopen::decode_nmt(frame)) return receive_nmt(*nmt);
  if (frame.can_id == canopen::kSync && nmt_ == NmtState::kOperational) return send_states();
  if (const auto heartbeat = canopen::decode_heartbeat(frame)) {
    if (heartbeat->node == objects_.value(kHeartbeatConsumer) >> 16U) host_ns_ = now_ns;
  }
  if (nmt_ == NmtState::kStopped) return;
  if (const auto request = decode_sdo(SdoSide::kRequest, parameters_.node, frame)) return receive_sdo(*request);
  if (nmt_ == NmtState::kOperational) receive_command(frame);
}

void Cia402Device::receive_nmt(const canopen::NmtRequest& request) {
  if (request.node != 0 && request.node != parameters_.node) return;
  switch (request.command) {
    case NmtCommand::kStart:
      nmt_ = NmtState::kOperational;
      break;
    case NmtCommand::kStop:
      nmt_ = NmtState::kStopped;
      break;
    case NmtCommand::kEnterPreOperational:
      nmt_ = NmtState::kPreOperational;
      break;
    default:
      reboot();
  }
}

std::uint32_t Cia402Device::refusal(const canopen::SdoMessage& request) const {
  const std::uint16_t index = request.object.index;
  const bool mapping = (index >= 0x1600 && index < 0x1600 + kPdos) || (index >= 0x1A00 && index < 0x1A00 + kPdos);
  if (!mapping) return 0;
  const bool active = (objects_.value({static_cast<std::uint16_t>(index - 0x200), 1}) & canopen::kPdoDisabled) == 0;
  if (nmt_ != NmtState::kPreOperational || active) return 0x0800'0022;
  if (request.object.sub == 0) return 0;
  if (objects_.value({index, 0}) != 0) return 0x0800'0022;
  return objects_.has(entry_of(canopen::expedited_value(request)).object) ? 0 : 0x0604'0041;
}

void Cia402Device::receive_sdo(const canopen::SdoMessage& request) {
  const std::uint32_t refused = request.command == canopen::SdoCommand::kDownload ? refusal(request) : 0;
  for (unsigned axis = 0; axis < axes_.size(); ++axis) refresh_objects(axis);
  const canopen::SdoMessage answer = objects_.answer(request, refused);
  for (unsigned axis = 0; axis < axes_.size(); ++axis) {
    const bool written = answer.command == canopen::SdoCommand::kDownload;
    if (written && request.object == on_axis(kControlword, axis)) {
      obey(axis, static_cast<std::uint16_t>(canopen::expedited_value(request)));
    }
  }
  transmit(encode_sdo(SdoSide::kResponse, parameters_.node, answer));
}

void Cia402Device::map(Pdo& pdo) const {
  const auto count = objects_.value({pdo.mapping_index(), 0});
  for (std::uint8_t i = 1; i <= count && i <= canopen::kMaxPdoEntries; ++i) {
    pdo.mapping.entries[pdo.mapping.count++] = entry_of(objects_.value({pdo.mapping_index(), i}));
  }
}

bool Cia402Device::enabled(const Pdo& pdo) const {
  return (objects_.value({pdo.parameters(), 1}) & canopen::kPdoDisabled) == 0 &&
         objects_.value({pdo.mapping_index(), 0}) > 0;
}

void Cia402Device::receive_command(const can_frame& frame) {
  for (std::uint8_t number = 1; number <= kPdos; ++number) {
    Pdo pdo{.kind = PdoKind::kReceive, .number = number, .mapping = {}};
    if (frame.can_id != pdo.cob_id(parameters_.node) || !enabled(pdo)) continue;
    map(pdo);
    std::array<std::int64_t, canopen::kMaxPdoEntries> values{};
    if (!decode_pdo(pdo, parameters_.node, frame, values)) continue;
    for (std::size_t i = 0; i < pdo.mapping.count; ++i) {
      objects_.set(pdo.mapping.entries[i].object, static_cast<std::uint32_t>(values[i]));
    }
    for (unsigned axis = 0; axis < axes_.size(); ++axis) {
      const bool commands = std::ranges::find(pdo.mapping.entries, on_axis(kControlword, axis), &PdoEntry::object) !=
                            pdo.mapping.entries.end();
      if (commands) obey(axis, static_cast<std::uint16_t>(at(kControlword, axis)));
    }
  }
}

void Cia402Device::send_states() {
  for (unsigned axis = 0; axis < axes_.size(); ++axis) {
    update_axis(axis);
    refresh_objects(axis);
  }
  ++syncs_;
  for (std::uint8_t number = 1; number <= kPdos; ++number) {
    Pdo pdo{.kind = PdoKind::kTransmit, .number = number, .mapping = {}};
    if (!enabled(pdo)) continue;
    const std::uint32_t type = objects_.value({pdo.parameters(), 2});
    if (type == 0 || type > canopen::kMaxSyncs || syncs_ % type != 0) continue;
    map(pdo);
    std::array<std::int64_t, canopen::kMaxPdoEntries> values{};
    for (std::size_t i = 0; i < pdo.mapping.count; ++i) values[i] = objects_.value(pdo.mapping.entries[i].object);
    transmit(encode_pdo(pdo, parameters_.node, values));
  }
}

namespace {

Cia402DeviceParameters device_of(const Cia402Parameters& drive, const Brake& brake, double clock_ppm) {
  Cia402DeviceParameters device;
  device.node = static_cast<std::uint8_t>(drive.drive.node);
  device.fixed_mapping = drive.pdos == PdoSource::kFixed;
  device.rated_torque = drive.rated_torque != 0 ? drive.rated_torque : drive.drive.torque_limit / drive.drive.gear;
  if (drive.counts_per_turn != 0) device.counts_per_turn = drive.counts_per_turn;
  if (drive.velocity_unit != 0) device.velocity_unit = drive.velocity_unit;
  if (drive.vendor != 0) device.vendor = static_cast<std::uint32_t>(drive.vendor);
  if (drive.product != 0) device.product = static_cast<std::uint32_t>(drive.product);
  device.brake_damping = motor_damping(drive.drive, brake);
  device.brake_stiffness = brake.stiffness / (drive.drive.gear * drive.drive.gear);
  device.brake_hold_speed = brake.hold_speed * drive.drive.gear;
  if (drive.drive.takes_speeds) device.supported_modes = Cia402DeviceParameters::kSpeedModes;
  device.clock_ppm = clock_ppm;
  return device;
}

}  // namespace

std::unique_ptr<DeviceFront> make_cia402_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<Cia402Device>(file, std::move(setup), &device_of);
}

}  // namespace robot_control
