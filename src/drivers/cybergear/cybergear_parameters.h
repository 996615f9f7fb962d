#pragma once
/// CybergearParameters are the statements of the drive file about one CyberGear or RobStride motor.

#include <cstdint>

#include "drivers/drive/mit/mit_joint.h"

namespace robot_control::cybergear {

struct CybergearParameters : MitJoint {
  /// s without an order until the motor releases itself; written to the motor. It is as short as that of a Damiao
  /// motor, for the same reason (docs/drivers.md).
  double timeout = 0.03;

  std::uint64_t place() const noexcept { return drive.node; }
};

inline Keys keys(CybergearParameters& p) {
  return joined({mit_keys(p),
                 {
                     {"stiffness_range", &p.ranges.stiffness, "N·m/rad", 1, 1.0e5, kOptional},
                     {"damping_range", &p.ranges.damping, "N·m·s/rad", 0.01, 1.0e4, kOptional},
                     {"motor_gear", &p.motor_gear, "turns of the rotor per turn of the shaft", 1, 200},
                     {"timeout", &p.timeout, "s", 0.01, 1, kOptional},
                 }});
}

}  // namespace robot_control::cybergear
