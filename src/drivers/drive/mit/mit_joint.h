#pragma once
/// MitJoint holds the statements of the drive file that all dialects of the MIT mode have. The shaft of the motor is
/// the "motor" of DriveParameters: `gear` counts the turns of the shaft per turn of the joint.

#include <optional>

#include "drivers/drive/mit/mit_codec.h"
#include "drivers/drive_parameters.h"

namespace robot_control {

struct MitJoint {
  DriveParameters drive{};
  MitRanges ranges{};
  double motor_gear = 1;  ///< turns of the rotor per turn of the shaft

  /// rad, of the joint, wherever a start or a reset may happen. The first angle must be nearer than half a turn of the
  /// rotor: else the zero of the motor is off by whole turns. None: not compared.
  std::optional<double> start_angle = std::nullopt;
};

/// Returns the keys about the zero of a motor.
template <class Joint>
Keys zero_keys(Joint& joint) {
  return {
      {"offset", &joint.drive.offset, "rad", -1000, 1000, kOptional},
      {"start_angle", &joint.start_angle, "rad", -1000, 1000, kOptional},
  };
}

/// Returns the keys of a struct with these members, whose ranges scale the numbers on the bus.
template <class Joint>
Keys mit_keys(Joint& joint) {
  return joined({keys(joint.drive),
                 {
                     {"position_range", &joint.ranges.position, "rad", 1, 1000},
                     {"velocity_range", &joint.ranges.velocity, "rad/s", 0.1, 1000},
                     {"torque_range", &joint.ranges.torque, "N·m", 0.1, 10000},
                 },
                 zero_keys(joint)});
}

}  // namespace robot_control
