#pragma once
/// A moteus controller as a device: its modes, the timeout of an order, and an error until it is stopped. Its control
/// closes the impedance at each step, about a target that moves on with the ordered velocity.
///
/// An order brings it into the mode position after kEnableNs. A timeout leaves it with the damping of the last order
/// and at most kTimeoutTorque, as shipped (servo.timeout_mode 12), or without torque. Only a request to stop ends that.
/// The reply to a frame holds the state before it.

#include <cstdint>

#include "drivers/drive/mit/mit_device.h"
#include "drivers/moteus/moteus_messages.h"

namespace robot_control {

struct MoteusDeviceParameters {
  std::uint8_t node = 1;
  MitRanges gains{.torque = 40, .stiffness = 500, .damping = 5};  ///< of the scale 1; torque of its current
  double integral = 0;                                            ///< N·m, that its integral has at once
  double zero = 0;                                                ///< rad, true position of its zero
  double home = 1;
  double map_version = 5;
  bool damps_after_timeout = true;
};

class MoteusDevice final : public MitDevice {
 public:
  static constexpr std::int64_t kEnableNs = 10'000'000;
  static constexpr double kTimeoutTorque = 5;  ///< N·m, servo.timeout_max_torque_Nm as shipped

  MoteusDevice(const MoteusDeviceParameters& parameters, VirtualCan& bus, DeviceMotor& motor)
      : MitDevice(bus, motor, parameters.zero, parameters.gains.torque), parameters_(parameters) {}

 private:
  void boot() override;
  void release() override { mode_ = moteus::Mode::kStopped; }
  void receive(const can_frame& frame, std::int64_t now_ns) override;
  void run(std::int64_t now_ns, double seconds) override;

  moteus::Reply state() const;

  MoteusDeviceParameters parameters_;
  moteus::Mode mode_ = moteus::Mode::kStopped;
  moteus::Request order_;  // the last one
  std::uint8_t fault_code_ = 0;
  std::int64_t ordered_ns_ = 0;
  std::int64_t enabled_ns_ = 0;  // in the mode position from then on
};

}  // namespace robot_control
