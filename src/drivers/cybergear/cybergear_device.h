#pragma once
/// A CyberGear or RobStride motor as a device: orders, requests, the parameters that its driver reads, and the timeout.
/// Its control closes the impedance at each step. It answers each frame at once.
///
/// A fault releases the motor until it is cleared, and is also sent once with its details. A reboot forgets the
/// timeout, which was not stored.

#include <cstdint>

#include "drivers/cybergear/cybergear_messages.h"
#include "drivers/drive/mit/mit_device.h"

namespace robot_control {

struct CybergearDeviceParameters {
  std::uint8_t node = 1;
  std::uint8_t host = 0;  ///< CAN_MASTER, the party to which it answers an order
  MitRanges ranges{.position = 12.566, .velocity = 30, .torque = 12};
  std::uint32_t run_mode = 0;
  float torque_limit = 12;         ///< N·m
  double zero = 0;                 ///< rad, true position of its zero
  bool has_timeout = true;         ///< else it does not answer a request for it
  bool takes_timeout = true;       ///< else it keeps its value
  bool answers_parameters = true;  ///< of all kinds
};

class CybergearDevice final : public MitDevice {
 public:
  CybergearDevice(const CybergearDeviceParameters& parameters, VirtualCan& bus, DeviceMotor& motor)
      : MitDevice(bus, motor, parameters.zero, double{parameters.torque_limit}), parameters_(parameters) {}

 private:
  void boot() override;
  void release() override { mode_ = cybergear::Mode::kReset; }
  void begin_fault() override;
  void receive(const can_frame& frame, std::int64_t now_ns) override;
  void run(std::int64_t now_ns, double seconds) override;

  void read(std::uint8_t host, cybergear::Parameter index);
  void send_feedback(std::uint8_t host);
  std::uint8_t lasting_faults() const;

  CybergearDeviceParameters parameters_;
  cybergear::Mode mode_ = cybergear::Mode::kReset;
  std::uint8_t faults_ = 0;
  std::uint32_t timeout_ = 0;  // units of kTimeoutUnit
  std::int64_t ordered_ns_ = 0;
};

}  // namespace robot_control
