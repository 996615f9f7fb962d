#include "drivers/moteus/moteus_device.h"

#include <cmath>

#include "drivers/drive/can_front.h"
#include "drivers/moteus/moteus_parameters.h"

namespace robot_control {

using moteus::Access;
using moteus::Mode;
using moteus::Register;

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

void MoteusDevice::write(Register number, double value) {
  switch (number) {
    case Register::kMode:
      ordered_ = static_cast<Mode>(std::isnan(value) ? 0 : static_cast<int>(value));
      command_ = {};
      timeout_ = kTimeout;
      return;
    case Register::kOrderPosition:
      command_.position = moteus::kTurn * value;
      return;
    case Register::kOrderVelocity:
      command_.velocity = moteus::kTurn * value;
      return;
    case Register::kOrderTorque:
      command_.torque = value;
      return;
    case Register::kStiffnessScale:
      command_.stiffness = value * parameters_.gains.stiffness;
      return;
    case Register::kDampingScale:
      command_.damping = value * parameters_.gains.damping;
      return;
    case Register::kMaxTorque:
      max_torque_ = value;
      return;
    case Register::kTimeout:
      timeout_ = value;
      return;
    default:
      return;
  }
}

void MoteusDevice::receive(const can_frame& frame, std::int64_t now_ns) {
  const canid_t id = frame.can_id & ~CAN_EFF_FLAG;
  if (id > 0xFFFF || (id & 0x7FU) != parameters_.node) return;
  const moteus::Reply state = this->state();
  const canid_t source = id >> 8U & 0x7FU;
  moteus::SubframeWriter reply(static_cast<canid_t>(parameters_.node) << 8U | source);
  moteus::SubframeReader reader(frame);
  bool orders = false;
  while (const auto subframe = reader.next()) {
    if (subframe->access == Access::kRead)
      reply.begin(Access::kReply, subframe->type, static_cast<Register>(subframe->first), subframe->count);
    for (unsigned i = 0; i < subframe->count; ++i) {
      const auto number = static_cast<Register>(subframe->first + i);
      if (subframe->access == Access::kWrite) {
        orders = orders || number == Register::kMode;
        write(number, value_of(*subframe, i));
      } else if (subframe->access == Access::kRead) {
        const moteus::ReplyField* field = moteus::field_of(subframe->first + i, subframe->type);
        reply.value(subframe->type, field == nullptr ? 0 : state.*field->member / field->scale);
      }
    }
  }
  if (orders) begin_order(now_ns);
  if ((id & moteus::kRequestsReply) != 0) transmit(reply.frame());
}

void MoteusDevice::begin_order(std::int64_t now_ns) {
  ordered_ns_ = now_ns;
  if (ordered_ == Mode::kStopped) {
    mode_ = Mode::kStopped;
    fault_code_ = 0;
  } else if (ordered_ == Mode::kPosition && mode_ == Mode::kStopped) {
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
  if (mode_ == Mode::kPosition && silence > timeout_) mode_ = Mode::kTimeout;
  double limit = max_torque_;
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
