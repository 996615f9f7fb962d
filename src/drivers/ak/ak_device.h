#pragma once
/// An AK motor as a device. Its control closes the impedance at each step. It answers each frame at once.
///
/// It keeps its last order for ever, also while it is released, and carries it out when it is enabled. An error
/// releases it, and ends with its cause.

#include <cstdint>

#include "drivers/ak/ak_messages.h"
#include "drivers/drive/mit/mit_device.h"

namespace robot_control {

struct AkDeviceParameters {
  std::uint8_t node = 1;
  MitRanges ranges{.position = 12.5, .velocity = 50, .torque = 65};
  double torque_limit = 65;    ///< N·m, of its current
  double zero = 0;             ///< rad, true position of its zero
  bool reports_health = true;  ///< newer firmware
};

class AkDevice final : public MitDevice {
 public:
  AkDevice(const AkDeviceParameters& parameters, VirtualCan& bus, DeviceMotor& motor)
      : MitDevice(bus, motor, parameters.zero, parameters.torque_limit), parameters_(parameters) {}

 private:
  void boot() override;
  void release() override { on_ = false; }
  void receive(const can_frame& frame, std::int64_t now_ns) override;
  void run(std::int64_t now_ns, double seconds) override;

  ak::Error error() const;

  AkDeviceParameters parameters_;
  bool on_ = false;
};

}  // namespace robot_control
