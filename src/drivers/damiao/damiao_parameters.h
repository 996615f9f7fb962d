#pragma once
/// DamiaoParameters are the statements of the drive file about one Damiao motor. Its shaft is the "motor" of
/// DriveParameters: `gear` counts the turns of the shaft per turn of the joint.

#include <cstdint>
#include <optional>

#include "drivers/drive/mit_codec.h"
#include "drivers/drive_parameters.h"

namespace robot_control::damiao {

struct DamiaoParameters {
  DriveParameters drive{};
  MitRanges ranges{};
  std::uint64_t answers = 0;  ///< identifier of its answers (MST_ID); 0: node + 16

  /// s without an order until the motor releases itself; written to the motor. It is short, because a leg that keeps
  /// its last order while the others fold may turn a robot over (docs/drivers.md).
  double timeout = 0.03;

  /// rad, of the joint, wherever a start or a reset may happen. The first angle must be nearer than half a turn of the
  /// rotor: else the zero of the motor is off by whole turns. None: not compared.
  std::optional<double> start_angle = std::nullopt;

  std::uint64_t place() const noexcept { return drive.node; }
};

inline Keys keys(DamiaoParameters& p) {
  return joined({keys(p.drive),
                 {
                     {"position_range", &p.ranges.position, "rad", 1, 1000},
                     {"velocity_range", &p.ranges.velocity, "rad/s", 0.1, 1000},
                     {"torque_range", &p.ranges.torque, "N·m", 0.1, 10000},
                     {"answers", &p.answers, {}, 0, 0x7FE, kOptional},
                     {"timeout", &p.timeout, "s", 0.01, 1, kOptional},
                     {"offset", &p.drive.offset, "rad", -1000, 1000, kOptional},
                     {"start_angle", &p.start_angle, "rad", -1000, 1000, kOptional},
                 }});
}

}  // namespace robot_control::damiao
