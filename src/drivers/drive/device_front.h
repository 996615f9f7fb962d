#pragma once
/// A DeviceFront is the other end of a driver's line: simulated devices with the motors of a simulated robot. The
/// driver sees them through the messages on the line alone.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "signals/joint.h"

namespace robot_control {

class DeviceFront {
 public:
  virtual ~DeviceFront() = default;

  /// Returns the number of joints with a device, the first ones of the robot.
  virtual std::size_t size() const = 0;

  /// Returns the virtual time.
  virtual std::int64_t now_ns() const = 0;

  /// Runs the devices for one period, with what the driver sent since the last call. Their own messages reach the
  /// driver at the end. `joints` hold the true position and velocity of each joint at the beginning.
  virtual void run(std::span<const JointSample> joints) = 0;

  /// Returns the mean torque of a joint over the last call of `run`, N·m.
  virtual double torque(std::size_t joint) const = 0;

  /// From now on a device has a fault. Returns the problem with the list of words; "" if there is none.
  virtual std::string inject(std::string_view component, std::string_view kind) = 0;
};

}  // namespace robot_control
