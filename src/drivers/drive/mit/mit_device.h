#pragma once
/// A MitDevice is the common part of all simulated motors in MIT mode. It has their zero and the last order. It closes
/// the impedance of that order at each step, within the motor's own limit of the torque.

#include <algorithm>
#include <limits>

#include "drivers/drive/device.h"
#include "drivers/drive/mit/mit_codec.h"

namespace robot_control {

class MitDevice : public Device {
 protected:
  /// `zero` in rad is the true position of its zero, `torque_limit` in N·m that of its current.
  MitDevice(VirtualCan& bus, DeviceMotor& motor, double zero, double torque_limit)
      : Device(bus), motor_(motor), zero_(zero), torque_limit_(torque_limit) {}

  /// Leaves the state in which the motor has torque.
  virtual void release() = 0;

  void begin_fault() override {
    if (fault() == DeviceFault::kOtherZero) zero_ += kOtherZero;
    if (fault() == DeviceFault::kReleased || fault() == DeviceFault::kOff) release_motor();
  }
  void release_motor() {
    release();
    motor_.torque = 0;
  }
  void set_zero() { zero_ = motor_.position; }
  /// `limit` in N·m is that of the order.
  void close_impedance(bool has_torque, double limit = std::numeric_limits<double>::infinity()) {
    const double torque = mit_torque(command_, position(), velocity());
    const double maximum = std::min(torque_limit_, limit);
    motor_.torque = has_torque ? std::clamp(torque, -maximum, maximum) : 0;
  }

  double position() const { return motor_.position - zero_; }  ///< rad, from its zero
  double velocity() const { return motor_.velocity; }          ///< rad/s
  double torque() const { return motor_.torque; }              ///< N·m
  /// Returns whether it reports an error that cannot be cleared.
  bool fault_remains() const { return fault() == DeviceFault::kEncoder || fault() == DeviceFault::kUnderVoltage; }

  MitCommand command_;

 private:
  DeviceMotor& motor_;
  double zero_;
  double torque_limit_;
};

}  // namespace robot_control
