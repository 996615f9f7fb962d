#include "drivers/vesc/vesc_device.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/drive/can_front.h"
#include "drivers/vesc/vesc_parameters.h"

namespace robot_control {
namespace {

constexpr double kVescSupply = 24;  // V
constexpr double kVescLowSupply = 8;
constexpr double kResistance = 0.1;  // Ω, of the motor
constexpr double kCoolVesc = 35;     // °C
constexpr double kHotVesc = 120;

}  // namespace

VescDevice::VescDevice(const VescDeviceParameters& parameters, VirtualCan& bus, DeviceMotor& motor)
    : Device(bus),
      parameters_(parameters),
      motor_(motor),
      status_timer_(parameters.status_period, parameters.clock_ppm, 0.3 + 0.09 * parameters.node),
      temperature_timer_(parameters.temperature_period, parameters.clock_ppm, 0.1 + 0.07 * parameters.node),
      timeout_timer_(parameters.timeout, parameters.clock_ppm, 1) {}

void VescDevice::boot() {
  order_ = Order::kNone;
  zero_ = motor_.position;
  motor_.torque = 0;
}

void VescDevice::begin_fault() {
  if (fault() == DeviceFault::kOtherZero) zero_ += kOtherZero;
  if (fault() == DeviceFault::kReleased) released_ns_ = bus_ns() + kFaultNs;
  if (fault() == DeviceFault::kOff) motor_.torque = 0;
}

void VescDevice::obey(Order order, double value) {
  if (order != order_) speed_loop_.reset();
  order_ = order;
  value_ = value;
}

void VescDevice::receive(const can_frame& frame, std::int64_t now_ns) {
  if (!is_extended_data(frame)) return;
  const bool is_to_it = vesc::node_of(frame) == parameters_.node || vesc::node_of(frame) == vesc::kEveryNode;
  if (!is_to_it || !vesc::commands_motion(vesc::command_of(frame))) return;
  timeout_timer_.restart(now_ns);
  if (const auto order = vesc::decode<vesc::SetCurrent>(frame)) obey(Order::kCurrent, order->current);
  if (const auto order = vesc::decode<vesc::SetBrakeCurrent>(frame)) obey(Order::kBrake, order->current);
  if (const auto order = vesc::decode<vesc::SetSpeed>(frame))
    obey(Order::kSpeed, order->speed / parameters_.pole_pairs);
}

double VescDevice::driven_torque(double seconds) {
  const double limit = parameters_.max_current * parameters_.torque_constant;
  switch (order_) {
    case Order::kNone:
      return 0;
    case Order::kCurrent:
      return std::clamp(value_ * parameters_.torque_constant, -limit, limit);
    case Order::kBrake: {
      const double brake = std::min(limit, value_ * parameters_.torque_constant);
      return std::clamp(-parameters_.speed_gain * motor_.velocity, -brake, brake);
    }
    case Order::kSpeed:
      return speed_loop_.step(value_ - motor_.velocity, parameters_.speed_gain, limit, seconds);
  }
  return 0;
}

void VescDevice::run(std::int64_t now_ns, double seconds) {
  if (timeout_timer_.expired(now_ns)) obey(Order::kBrake, parameters_.brake_current);
  if (fault() == DeviceFault::kEncoder || fault() == DeviceFault::kUnderVoltage) released_ns_ = now_ns + kFaultNs;
  const bool released = now_ns < released_ns_;
  if (released) speed_loop_.reset();
  motor_.torque = released ? 0 : driven_torque(seconds);
  if (status_timer_.expired(now_ns)) send_statuses();
  if (temperature_timer_.expired(now_ns)) send_temperature();
}

void VescDevice::send_statuses() {
  const double current = motor_.torque / parameters_.torque_constant;
  const double duty = (kResistance * current + parameters_.torque_constant * motor_.velocity) / kVescSupply;
  send(vesc::Status{.speed = motor_.velocity * parameters_.pole_pairs,
                    .current = duty < 0 ? -current : current,
                    .duty = std::clamp(duty, -1.0, 1.0)});
  const double counts =
      (motor_.position - zero_) / (2 * std::numbers::pi) * parameters_.pole_pairs * parameters_.counts_per_turn;
  send(vesc::Status5{.tachometer = static_cast<std::int32_t>(static_cast<std::int64_t>(std::llround(counts))),
                     .voltage = fault() == DeviceFault::kUnderVoltage ? kVescLowSupply : kVescSupply});
}

void VescDevice::send_temperature() {
  send(vesc::Status4{.transistors = kCoolVesc, .motor = fault() == DeviceFault::kHot ? kHotVesc : kCoolVesc});
}

namespace {

constexpr double kVescCurrent = 10;  // A

/// Without a torque constant in the file the motor gives its greatest torque at kVescCurrent.
VescDeviceParameters device_of(const vesc::VescParameters& drive, const Brake& brake, double clock_ppm) {
  const double torque = drive.drive.torque_limit / drive.drive.gear;
  const double constant = drive.torque_constant > 0 ? drive.torque_constant : torque / kVescCurrent;
  return {.node = static_cast<std::uint8_t>(drive.drive.node),
          .pole_pairs = static_cast<double>(drive.pole_pairs),
          .torque_constant = constant,
          .max_current = torque / constant,
          .status_period = drive.status_period,
          .temperature_period = drive.temperature_period,
          .brake_current = drive.drive.on_silence == SilenceReaction::kBrakes ? torque / constant : 0,
          .speed_gain = motor_damping(drive.drive, brake),
          .clock_ppm = clock_ppm};
}

}  // namespace

std::unique_ptr<DeviceFront> make_vesc_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<VescDevice>(file, std::move(setup), &device_of);
}

}  // namespace robot_control
