#pragma once
/// A Damiao motor as a device: orders of the MIT mode, its requests, the registers that its driver reads, and the
/// timeout. Its control closes the impedance at each step. It answers each order and each request at once.
///
/// An error releases the motor until it is cleared. kEncoder stands for an overload, since errors of the encoder have
/// no code. A reboot forgets the timeout, which was not stored.

#include <cstdint>

#include "drivers/damiao/damiao_messages.h"
#include "drivers/drive/mit/mit_device.h"

namespace robot_control {

struct DamiaoDeviceParameters {
  std::uint8_t node = 1;
  canid_t answers = 17;                                              ///< MST_ID
  MitRanges ranges{.position = 12.5, .velocity = 45, .torque = 54};  ///< PMAX, VMAX, TMAX
  float gear = 9;
  std::uint32_t mode = 1;     ///< CTRL_MODE
  double torque_limit = 54;   ///< N·m, of its current
  double zero = 0;            ///< rad, true position of its zero
  bool takes_timeout = true;  ///< else it answers a write to TIMEOUT, and keeps its value
  bool answers_registers = true;
};

class DamiaoDevice final : public MitDevice {
 public:
  DamiaoDevice(const DamiaoDeviceParameters& parameters, VirtualCan& bus, DeviceMotor& motor)
      : MitDevice(bus, motor, parameters.zero, parameters.torque_limit), parameters_(parameters) {}

 private:
  void boot() override;
  void release() override { state_ = damiao::State::kOff; }
  void receive(const can_frame& frame, std::int64_t now_ns) override;
  void run(std::int64_t now_ns, double seconds) override;

  void obey(damiao::Request request);
  void access(const damiao::RegisterAccess& access);
  std::uint32_t value_of(damiao::Register number) const;
  void send_feedback();

  DamiaoDeviceParameters parameters_;
  damiao::State state_ = damiao::State::kOff;
  std::uint32_t timeout_ = 0;  // units of kTimeoutUnit
  std::int64_t ordered_ns_ = 0;
};

}  // namespace robot_control
