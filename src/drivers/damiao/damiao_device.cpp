#include "drivers/damiao/damiao_device.h"

#include "drivers/damiao/damiao_parameters.h"
#include "drivers/drive/can_front.h"

namespace robot_control {

using damiao::State;

namespace {

constexpr double kCoolMotor = 35;  // °C
constexpr double kHotMotor = 120;

}  // namespace

void DamiaoDevice::boot() {
  release_motor();
  timeout_ = 0;
}

void DamiaoDevice::receive(const can_frame& frame, std::int64_t now_ns) {
  if (!is_standard_data(frame) || frame.len != CAN_MAX_DLEN) return;
  if (frame.can_id == damiao::kRegisterId) return access(damiao::decode_register(frame));
  if (frame.can_id != parameters_.node) return;
  ordered_ns_ = now_ns;
  if (const auto request = damiao::decode_request(frame)) {
    obey(*request);
  } else {
    command_ = decode_mit(frame, parameters_.ranges);
  }
  send_feedback();
}

void DamiaoDevice::obey(damiao::Request request) {
  switch (request) {
    case damiao::Request::kClear:
      if (state_ > State::kOn && !fault_remains()) state_ = State::kOff;
      break;
    case damiao::Request::kEnable:
      if (state_ == State::kOff) {
        state_ = State::kOn;
        command_ = {};
      }
      break;
    case damiao::Request::kRelease:
      if (state_ == State::kOn) state_ = State::kOff;
      break;
    case damiao::Request::kSetZero:
      set_zero();
      break;
  }
}

std::uint32_t DamiaoDevice::value_of(damiao::Register number) const {
  const auto bits = [](double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); };
  switch (number) {
    case damiao::Register::kTimeout:
      return timeout_;
    case damiao::Register::kControlMode:
      return parameters_.mode;
    case damiao::Register::kGear:
      return bits(parameters_.gear);
    case damiao::Register::kPositionRange:
      return bits(parameters_.ranges.position);
    case damiao::Register::kVelocityRange:
      return bits(parameters_.ranges.velocity);
    case damiao::Register::kTorqueRange:
      return bits(parameters_.ranges.torque);
  }
  return 0;
}

void DamiaoDevice::access(const damiao::RegisterAccess& access) {
  if (access.node != parameters_.node) return;
  if (access.operation == damiao::Operation::kRefresh) return send_feedback();
  if (!parameters_.answers_registers) return;
  damiao::RegisterAccess answer = access;
  if (access.operation == damiao::Operation::kWrite) {
    if (access.number == damiao::Register::kTimeout && parameters_.takes_timeout) timeout_ = access.value;
  } else {
    answer.value = value_of(access.number);
  }
  transmit(damiao::encode(parameters_.answers, answer));
}

void DamiaoDevice::run(std::int64_t now_ns, double /*seconds*/) {
  if (fault() == DeviceFault::kEncoder) state_ = State::kOverload;
  if (fault() == DeviceFault::kUnderVoltage) state_ = State::kUnderVoltage;
  const double silence = 1.0e-9 * static_cast<double>(now_ns - ordered_ns_);
  if (state_ == State::kOn && timeout_ != 0 && silence > damiao::kTimeoutUnit * timeout_)
    state_ = State::kCommunicationLost;
  close_impedance(state_ == State::kOn);
}

void DamiaoDevice::send_feedback() {
  const double temperature = fault() == DeviceFault::kHot ? kHotMotor : kCoolMotor;
  transmit(damiao::encode(parameters_.answers, parameters_.ranges,
                          damiao::Feedback{.node = parameters_.node,
                                           .state = state_,
                                           .position = position(),
                                           .velocity = velocity(),
                                           .torque = torque(),
                                           .transistors = kCoolMotor,
                                           .rotor = temperature}));
}

namespace {

DamiaoDeviceParameters device_of(const damiao::DamiaoParameters& joint, const Brake& /*brake*/, double /*clock_ppm*/) {
  const DriveParameters& drive = joint.drive;
  return {.node = static_cast<std::uint8_t>(drive.node),
          .answers = static_cast<canid_t>(joint.answers != 0 ? joint.answers : drive.node + damiao::kMaxNode + 1),
          .ranges = joint.ranges,
          .torque_limit = joint.ranges.torque,
          .zero = static_cast<double>(drive.direction) * drive.gear * drive.offset};
}

}  // namespace

std::unique_ptr<DeviceFront> make_damiao_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<DamiaoDevice>(file, std::move(setup), &device_of);
}

}  // namespace robot_control
