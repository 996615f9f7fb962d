#pragma once
/// MoteusParameters are the statements of the drive file about one moteus controller.

#include <cstdint>

#include "drivers/drive/mit/mit_joint.h"
#include "drivers/moteus/moteus_messages.h"

namespace robot_control::moteus {

struct MoteusParameters : MitJoint {
  static constexpr bool kSendsVoltage = true;

  /// The frames hold floating-point numbers, so their ranges bound nothing.
  MoteusParameters() { ranges = {.position = 1.0e4, .velocity = 1.0e4, .torque = 1.0e4}; }

  double kp = 0;  ///< N·m per turn, servo.pid_position.kp of the controller, of which an order uses a part
  double kd = 0;  ///< N·m·s per turn, servo.pid_position.kd, likewise

  /// s without an order until the controller leaves its mode; a part of each order. It is as short as that of a Damiao
  /// motor, for the same reason (docs/drivers.md).
  double timeout = 0.03;

  std::uint64_t place() const noexcept { return drive.node; }

  /// Returns the ranges with the gains of the scale 1, and the torque that no order exceeds.
  MitRanges ranges_of_orders() const noexcept {
    return {.position = ranges.position,
            .velocity = ranges.velocity,
            .torque = drive.torque_limit / drive.gear,
            .stiffness = kp / kTurn,
            .damping = kd / kTurn};
  }
};

inline Keys keys(MoteusParameters& p) {
  return joined({keys(p.drive),
                 zero_keys(p),
                 {
                     {"kp", &p.kp, "N·m per turn of the output", 1, 1.0e6},
                     {"kd", &p.kd, "N·m·s per turn of the output", 0.01, 1.0e5},
                     {"motor_gear", &p.motor_gear, "turns of the rotor per turn of the output", 1, 200},
                     {"timeout", &p.timeout, "s", 0.01, 1, kOptional},
                 }});
}

}  // namespace robot_control::moteus
