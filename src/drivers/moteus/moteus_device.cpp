#include "drivers/moteus/moteus_device.h"

#include <cmath>

#include "drivers/drive/can_front.h"
#include "drivers/moteus/moteus_parameters.h"

namespace robot_control {

using moteus::Mode;

namespace {

constexpr Mode kEnabling{3};
constexpr double kCoolBoard = 35, kHotBoard = 120;  // °C
constexpr double kSupply = 40, kLowSupply = 3.5;    // V
constexpr std::uint8_t kEncoderFault = 35, kUnderVoltage = 40;

}  // namespace

void MoteusDevice::boot() {
  release_motor();
  command_ = {};
  fault_code_ = 0;
}

void MoteusDevice::receive(const can_frame& frame, std::int64_t now_ns) {
  const auto request = moteus::decode_request(frame, parameters_.node, parameters_.gains);
  if (!request) return;
  moteus::Reply reply = state();
  reply.details = request->details;
  transmit(moteus::encode(parameters_.node, reply));
  order_ = *request;
  command_ = order_.command;
  ordered_ns_ = now_ns;
  if (order_.mode == Mode::kStopped) {
    mode_ = Mode::kStopped;
    fault_code_ = 0;
  } else if (mode_ == Mode::kStopped) {
    mode_ = kEnabling;
    enabled_ns_ = now_ns + kEnableNs;
  }
}

moteus::Reply MoteusDevice::state() const {
  const bool controls = mode_ == Mode::kPosition;
  return {.mode = static_cast<double>(mode_),
          .position = position(),
          .velocity = fault() == DeviceFault::kNotFinite ? std::nan("") : velocity(),
          .torque = torque(),
          .voltage = fault() == DeviceFault::kUnderVoltage ? kLowSupply : kSupply,
          .temperature = fault() == DeviceFault::kHot ? kHotBoard : kCoolBoard,
          .fault = static_cast<double>(fault_code_),
          .home = parameters_.home,
          .map_version = parameters_.map_version,
          .proportional = controls ? command_.stiffness * (position() - command_.position) : 0,
          .integral = controls ? parameters_.integral : 0,
          .derivative = controls ? command_.damping * (velocity() - command_.velocity) : 0};
}

void MoteusDevice::run(std::int64_t now_ns, double seconds) {
  if (mode_ == kEnabling && now_ns >= enabled_ns_) mode_ = Mode::kPosition;
  if (mode_ != Mode::kStopped && fault_remains()) {
    mode_ = Mode::kFault;
    fault_code_ = fault() == DeviceFault::kEncoder ? kEncoderFault : kUnderVoltage;
  }
  const double silence = 1.0e-9 * static_cast<double>(now_ns - ordered_ns_);
  if (mode_ == Mode::kPosition && silence > order_.timeout) mode_ = Mode::kTimeout;
  double limit = order_.max_torque;
  if (mode_ == Mode::kPosition) {
    command_.position += command_.velocity * seconds;
  } else if (mode_ == Mode::kTimeout) {
    command_ = {.damping = parameters_.damps_after_timeout ? command_.damping : 0};
    limit = kTimeoutTorque;
  }
  close_impedance(mode_ == Mode::kPosition || mode_ == Mode::kTimeout, limit);
}

namespace {

MoteusDeviceParameters device_of(const moteus::MoteusParameters& joint, const Brake& /*brake*/, double /*clock_ppm*/) {
  const DriveParameters& drive = joint.drive;
  return {.node = static_cast<std::uint8_t>(drive.node),
          .gains = joint.ranges_of_orders(),
          .zero = static_cast<double>(drive.direction) * drive.gear * drive.offset,
          .damps_after_timeout = drive.on_silence == SilenceReaction::kBrakes};
}

}  // namespace

std::unique_ptr<DeviceFront> make_moteus_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<MoteusDevice>(file, std::move(setup), &device_of);
}

}  // namespace robot_control
