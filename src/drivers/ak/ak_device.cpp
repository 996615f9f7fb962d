#include "drivers/ak/ak_device.h"

#include "drivers/ak/ak_parameters.h"
#include "drivers/drive/can_front.h"

namespace robot_control {
namespace {

constexpr std::uint8_t kCoolMotor = 75;  // 35 °C with an offset of −40
constexpr std::uint8_t kHotMotor = 160;

}  // namespace

void AkDevice::boot() {
  release_motor();
  command_ = {};
}

ak::Error AkDevice::error() const {
  if (fault() == DeviceFault::kEncoder) return ak::Error::kEncoder;
  return fault() == DeviceFault::kUnderVoltage ? ak::Error::kUnderVoltage : ak::Error::kNone;
}

void AkDevice::receive(const can_frame& frame, std::int64_t /*now_ns*/) {
  if (!is_standard_data(frame) || frame.len != CAN_MAX_DLEN || frame.can_id != parameters_.node) return;
  if (const auto request = decode_request(frame)) {
    if (*request == MitRequest::kEnable) on_ = error() == ak::Error::kNone;
    if (*request == MitRequest::kRelease) on_ = false;
    if (*request == MitRequest::kSetZero) set_zero();
  } else {
    command_ = decode_mit(frame, parameters_.ranges);
  }
  ak::Reply reply{.node = parameters_.node, .position = position(), .velocity = velocity(), .torque = torque()};
  if (parameters_.reports_health)
    reply.health = {.temperature = fault() == DeviceFault::kHot ? kHotMotor : kCoolMotor, .error = error()};
  transmit(ak::encode(parameters_.ranges, reply));
}

void AkDevice::run(std::int64_t /*now_ns*/, double /*seconds*/) {
  if (error() != ak::Error::kNone) on_ = false;
  close_impedance(on_);
}

namespace {

AkDeviceParameters device_of(const ak::AkParameters& joint, const Brake& /*brake*/, double /*clock_ppm*/) {
  const DriveParameters& drive = joint.drive;
  return {.node = static_cast<std::uint8_t>(drive.node),
          .ranges = joint.ranges,
          .torque_limit = joint.ranges.torque,
          .zero = static_cast<double>(drive.direction) * drive.gear * drive.offset};
}

}  // namespace

std::unique_ptr<DeviceFront> make_ak_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<AkDevice>(file, std::move(setup), &device_of);
}

}  // namespace robot_control
