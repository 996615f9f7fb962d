#include "drivers/odrive/odrive_device.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "drivers/drive/can_front.h"
#include "drivers/odrive/odrive_errors.h"
#include "drivers/odrive/odrive_messages_05.h"
#include "drivers/odrive/odrive_messages_06.h"

namespace robot_control {
namespace {

using namespace odrive;  // NOLINT(google-build-using-namespace): the messages of this device

constexpr double kVelocityGain = 0.16 / kTurn;  // N·m/(rad/s), the maker's default
constexpr double kVelocityTolerance = 1.2;      // of the limit, the maker's default
constexpr double kSupply = 24;                  // V
constexpr double kLowSupply = 8;
constexpr double kAmbientTemperature = 35;  // °C
constexpr double kHotMotor = 120;
constexpr std::uint32_t kMissingEstimate06 = 0x8, kEncoderFailed05 = 0x100, kMotorFailed05 = 0x40;
constexpr std::uint32_t kVelocityLimit06 = 0x8000, kControllerFailed05 = 0x200, kOverspeed05 = 0x1;
constexpr std::uint32_t kNoResponse05 = 0x4;
constexpr std::uint64_t kUnknownSupply05 = 0x8000'0000;

}  // namespace

OdriveDevice::OdriveDevice(const OdriveDeviceParameters& parameters, VirtualCan& bus, DeviceMotor& motor)
    : Device(bus),
      parameters_(parameters),
      motor_(motor),
      heartbeat_timer_(parameters.heartbeat_period, parameters.clock_ppm, 0.1 + 0.07 * parameters.node),
      estimates_timer_(parameters.estimates_period, parameters.clock_ppm, 0.3 + 0.09 * parameters.node),
      effort_timer_(parameters.effort_period, parameters.clock_ppm, 0.5 + 0.03 * parameters.node),
      watchdog_timer_(parameters.watchdog_timeout, parameters.clock_ppm, 1) {}

void OdriveDevice::boot() {
  state_ = AxisState::kIdle;
  clear_errors();
  disarm_reason_ = 0;
  mode_ = {.control = ControlMode::kPosition};
  gains_.reset();
  input_torque_ = input_velocity_ = 0;
  zero_ = motor_.position;
  motor_.torque = 0;
}

void OdriveDevice::begin_fault() {
  if (fault() == DeviceFault::kOtherZero || fault() == DeviceFault::kSlipped) zero_ += kOtherZero;
  if (fault() == DeviceFault::kReleased) state_ = AxisState::kIdle;
  if (fault() == DeviceFault::kOff) motor_.torque = 0;
  report_fault();
}

void OdriveDevice::report_fault() {
  if (fault() == DeviceFault::kEncoder) {
    encoder_error_ = kNoResponse05;
    fail(is_06() ? kMissingEstimate06 : kEncoderFailed05);
  }
  if (fault() == DeviceFault::kUnderVoltage) {
    motor_error_ = kUnknownSupply05;
    fail(is_06() ? kUnderVoltage06 : kMotorFailed05);
  }
}

void OdriveDevice::clear_errors() {
  error_ = encoder_error_ = controller_error_ = 0;
  motor_error_ = 0;
}

void OdriveDevice::fail(std::uint32_t error) {
  error_ |= error;
  if (state_ == AxisState::kClosedLoopControl) disarm_reason_ = error;
  state_ = AxisState::kIdle;
  motor_.torque = 0;
}

void OdriveDevice::run(std::int64_t now_ns, double seconds) {
  const bool watched = !is_06() || state_ == AxisState::kClosedLoopControl;
  if (watched && watchdog_timer_.expired(now_ns)) fail(is_06() ? kWatchdogExpired06 : kWatchdogExpired05);
  if (state_ == AxisState::kClosedLoopControl && std::abs(motor_.velocity) > kVelocityTolerance * velocity_limit_) {
    controller_error_ = kOverspeed05;
    fail(is_06() ? kVelocityLimit06 : kControllerFailed05);
  }
  const bool closed = state_ == AxisState::kClosedLoopControl;
  if (!closed) speed_loop_.reset();
  motor_.torque = closed ? (fault() == DeviceFault::kSlipped ? -1 : 1) * driven_torque(seconds) : 0;
  if (heartbeat_timer_.expired(now_ns)) send_heartbeat();
  if (estimates_timer_.expired(now_ns)) send_estimates();
  if (effort_timer_.expired(now_ns)) is_06() ? send_torques() : send_current();
}

double OdriveDevice::driven_torque(double seconds) {
  const double maximum = current_limit_ * parameters_.torque_constant;
  if (mode_.input != InputMode::kPassthrough) return 0;
  if (mode_.control == ControlMode::kVelocity) {
    const double error = std::clamp(input_velocity_, -velocity_limit_, velocity_limit_) - motor_.velocity;
    if (gains_) return std::clamp(input_torque_ + gains_->gain * error, -maximum, maximum);
    return speed_loop_.step(error, parameters_.speed_gain, maximum, seconds, input_torque_);
  }
  if (mode_.control != ControlMode::kTorque) return 0;
  const double gain = gains_ ? gains_->gain : kVelocityGain;
  const double fast = gain * (velocity_limit_ - motor_.velocity);
  const double slow = gain * (-velocity_limit_ - motor_.velocity);
  return std::clamp(std::clamp(input_torque_, std::min(slow, fast), std::max(slow, fast)), -maximum, maximum);
}

double OdriveDevice::measured_position() const {
  const double count = kTurn / parameters_.counts_per_turn;
  return count * std::round((motor_.position - zero_) / count);
}

void OdriveDevice::send_heartbeat() {
  if (is_06()) return send(v06::Heartbeat{.error = error_, .state = state_});
  send(v05::Heartbeat{.error = error_,
                      .state = state_,
                      .motor_error = motor_error_ != 0,
                      .encoder_error = encoder_error_ != 0,
                      .controller_error = controller_error_ != 0});
}

void OdriveDevice::send_estimates() {
  const double velocity =
      fault() == DeviceFault::kNotFinite ? std::numeric_limits<double>::quiet_NaN() : motor_.velocity;
  send(EncoderEstimates{.position = measured_position(), .velocity = velocity});
}

void OdriveDevice::send_current() {
  const double current = motor_.torque / parameters_.torque_constant;
  send(Iq{.setpoint = current, .measured = current});
}

void OdriveDevice::send_torques() {
  send(v06::Torques{.target = input_torque_, .estimate = motor_.torque});
}

void OdriveDevice::receive(const can_frame& frame, std::int64_t now_ns) {
  if (is_extended(frame) || node_of(frame) != parameters_.node) return;
  if (state_ == AxisState::kClosedLoopControl || !is_06()) watchdog_timer_.restart(now_ns);
  is_remote_request(frame) ? receive_request(frame) : receive_command(frame);
}

void OdriveDevice::receive_request(const can_frame& frame) {
  const bool low = fault() == DeviceFault::kUnderVoltage;
  if (requests<EncoderEstimates>(frame)) send_estimates();
  if (requests<Iq>(frame)) send_current();
  if (requests<BusVoltageCurrent>(frame)) send(BusVoltageCurrent{.voltage = low ? kLowSupply : kSupply, .current = 1});
  if (!is_06()) {
    if (requests<v05::MotorError>(frame)) send(v05::MotorError{.error = motor_error_});
    if (requests<v05::EncoderError>(frame)) send(v05::EncoderError{.error = encoder_error_});
    if (requests<v05::ControllerError>(frame)) send(v05::ControllerError{.error = controller_error_});
    return;
  }
  if (requests<v06::Version>(frame)) {
    send(v06::Version{
        .protocol = 2, .hardware_major = 4, .hardware_minor = 4, .firmware_minor = 6, .firmware_revision = 10});
  }
  if (requests<v06::Address>(frame)) {
    send(v06::Address{.node = parameters_.node, .serial_number = parameters_.serial_number});
  }
  if (requests<v06::Error>(frame)) send(v06::Error{.active = error_, .disarm_reason = disarm_reason_});
  if (requests<v06::Torques>(frame)) send_torques();
  if (requests<v06::Temperature>(frame)) {
    send(v06::Temperature{.transistors = kAmbientTemperature,
                          .motor = fault() == DeviceFault::kHot ? kHotMotor : kAmbientTemperature});
  }
}

void OdriveDevice::receive_command(const can_frame& frame) {
  if (const auto wanted = decode<SetAxisState>(frame)) {
    const bool closes = wanted->state == AxisState::kClosedLoopControl && error_ == 0;
    if (closes && state_ != AxisState::kClosedLoopControl) watchdog_timer_.restart(now_ns());
    state_ = closes ? AxisState::kClosedLoopControl : AxisState::kIdle;
    if (closes) report_fault();
  }
  if (const auto mode = decode<SetControllerMode>(frame)) mode_ = *mode;
  if (const auto gains = decode<SetVelocityGains>(frame)) gains_ = gains;
  if (const auto input = decode<SetInputTorque>(frame)) input_torque_ = input->torque;
  if (const auto input = decode<SetInputVelocity>(frame)) {
    input_velocity_ = input->velocity;
    input_torque_ = input->torque;
  }
  if (const auto limits = decode<SetLimits>(frame)) {
    velocity_limit_ = limits->velocity;
    current_limit_ = limits->current;
  }
  if (decode<Estop>(frame)) fail(is_06() ? kEstopRequested06 : kEstopRequested05);
  if (is_06()) {
    if (decode<v06::ClearErrors>(frame)) clear_errors();
    if (const auto position = decode<v06::SetAbsolutePosition>(frame)) zero_ = motor_.position - position->position;
    receive_sdo(frame);
    return;
  }
  if (decode<v05::ClearErrors>(frame)) clear_errors();
  if (const auto count = decode<v05::SetLinearCount>(frame)) {
    zero_ = motor_.position - kTurn * count->position / parameters_.counts_per_turn;
  }
}

void OdriveDevice::receive_sdo(const can_frame& frame) {
  const auto sdo = decode<v06::RxSdo>(frame);
  if (!sdo || sdo->opcode != v06::RxSdo::kRead) return;
  if (sdo->endpoint == parameters_.enable_watchdog_endpoint) {
    send(v06::TxSdo{.endpoint = sdo->endpoint, .value = parameters_.watchdog_timeout > 0});
  }
  if (sdo->endpoint == parameters_.watchdog_timeout_endpoint) {
    const auto timeout = static_cast<float>(parameters_.watchdog_timeout);
    send(v06::TxSdo{.endpoint = sdo->endpoint, .value = std::bit_cast<std::uint32_t>(timeout)});
  }
}

namespace {

constexpr double kOdriveWatchdog = 0.1;  // s, where the drive file says that it coasts on silence

OdriveDeviceParameters device_of(const OdriveParameters& drive, const Brake& brake, double clock_ppm) {
  return {.node = static_cast<std::uint8_t>(drive.drive.node),
          .firmware = drive.firmware == Firmware::k05 ? Firmware::k05 : Firmware::k06,
          .serial_number = drive.serial_number != 0 ? drive.serial_number : 1 + drive.drive.node,
          .torque_constant = drive.torque_constant,
          .counts_per_turn = drive.counts_per_turn,
          .heartbeat_period = drive.heartbeat_period,
          .estimates_period = drive.estimates_period,
          .effort_period = drive.effort_period,
          .watchdog_timeout = drive.drive.on_silence == SilenceReaction::kCoasts ? kOdriveWatchdog : 0,
          .enable_watchdog_endpoint = static_cast<std::uint16_t>(drive.enable_watchdog_endpoint),
          .watchdog_timeout_endpoint = static_cast<std::uint16_t>(drive.watchdog_timeout_endpoint),
          .speed_gain = motor_damping(drive.drive, brake),
          .clock_ppm = clock_ppm};
}

}  // namespace

std::unique_ptr<DeviceFront> make_odrive_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<OdriveDevice>(file, std::move(setup), &device_of);
}

}  // namespace robot_control
