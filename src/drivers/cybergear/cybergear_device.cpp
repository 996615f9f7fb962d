#include "drivers/cybergear/cybergear_device.h"

#include <bit>

#include "drivers/cybergear/cybergear_parameters.h"
#include "drivers/drive/can_front.h"

namespace robot_control {

using cybergear::Mode;
using cybergear::Parameter;
using cybergear::Type;

namespace {

constexpr double kCoolMotor = 35;  // °C
constexpr double kHotMotor = 120;
constexpr std::uint8_t kUnderVoltage = 1U << 0U, kEncoder = 1U << 3U;  // bits of Feedback::faults

}  // namespace

void CybergearDevice::boot() {
  release_motor();
  faults_ = 0;
  timeout_ = 0;
}

std::uint8_t CybergearDevice::lasting_faults() const {
  return fault() == DeviceFault::kEncoder ? kEncoder : fault() == DeviceFault::kUnderVoltage ? kUnderVoltage : 0;
}

void CybergearDevice::begin_fault() {
  MitDevice::begin_fault();
  if (lasting_faults() == 0) return;
  const std::uint64_t details = lasting_faults() == kEncoder ? 1U << 7U : 1U << 2U;
  transmit(word_frame(cybergear::encode({.type = Type::kFaults, .data = parameters_.node, .target = parameters_.host}),
                      details, 8));
}

void CybergearDevice::receive(const can_frame& frame, std::int64_t now_ns) {
  const auto id = cybergear::identifier_of(frame);
  if (!id || id->target != parameters_.node) return;
  ordered_ns_ = now_ns;
  const auto host = static_cast<std::uint8_t>(id->data & 0xFFU);
  switch (id->type) {
    case Type::kOrder:
      command_ = cybergear::decode_order(frame, parameters_.ranges);
      return send_feedback(parameters_.host);
    case Type::kEnable:
      if (mode_ != Mode::kRun && faults_ == 0) {
        mode_ = Mode::kRun;
        command_ = {};
      }
      break;
    case Type::kRelease:
      mode_ = Mode::kReset;
      if (frame.data[0] == 1) faults_ = lasting_faults();
      break;
    case Type::kSetZero:
      set_zero();
      break;
    case Type::kRead:
      return read(host, cybergear::decode_parameter(frame).index);
    case Type::kWrite:
      if (const auto access = cybergear::decode_parameter(frame);
          access.index == Parameter::kTimeout && parameters_.has_timeout && parameters_.takes_timeout) {
        timeout_ = access.value;
      }
      break;
    default:
      return;
  }
  send_feedback(host);
}

void CybergearDevice::read(std::uint8_t host, Parameter index) {
  if (!parameters_.answers_parameters) return;
  cybergear::ParameterAccess answer{.index = index};
  switch (index) {
    case Parameter::kRunMode:
      answer.value = parameters_.run_mode;
      break;
    case Parameter::kTorqueLimit:
      answer.value = std::bit_cast<std::uint32_t>(parameters_.torque_limit);
      break;
    case Parameter::kTimeout:
      if (!parameters_.has_timeout) return;
      answer.value = timeout_;
      break;
  }
  transmit(cybergear::encode({.type = Type::kRead, .data = parameters_.node, .target = host}, answer));
}

void CybergearDevice::run(std::int64_t now_ns, double /*seconds*/) {
  faults_ |= lasting_faults();
  const double silence = 1.0e-9 * static_cast<double>(now_ns - ordered_ns_);
  if (faults_ != 0 || (timeout_ != 0 && silence > cybergear::kTimeoutUnit * timeout_)) mode_ = Mode::kReset;
  close_impedance(mode_ == Mode::kRun);
}

void CybergearDevice::send_feedback(std::uint8_t host) {
  transmit(cybergear::encode(host, parameters_.ranges,
                             {.node = parameters_.node,
                              .mode = mode_,
                              .faults = faults_,
                              .position = position(),
                              .velocity = velocity(),
                              .torque = torque(),
                              .temperature = fault() == DeviceFault::kHot ? kHotMotor : kCoolMotor}));
}

namespace {

CybergearDeviceParameters device_of(const cybergear::CybergearParameters& joint, const Brake& /*brake*/,
                                    double /*clock_ppm*/) {
  const DriveParameters& drive = joint.drive;
  return {.node = static_cast<std::uint8_t>(drive.node),
          .ranges = joint.ranges,
          .torque_limit = static_cast<float>(joint.ranges.torque),
          .zero = static_cast<double>(drive.direction) * drive.gear * drive.offset};
}

}  // namespace

std::unique_ptr<DeviceFront> make_cybergear_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<CybergearDevice>(file, std::move(setup), &device_of);
}

}  // namespace robot_control
