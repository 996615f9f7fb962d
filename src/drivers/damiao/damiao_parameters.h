#pragma once
/// DamiaoParameters are the statements of the drive file about one Damiao motor, with the members of MitJoint.

#include <cstdint>
#include <optional>

#include "drivers/drive/mit/mit_joint.h"

namespace robot_control::damiao {

struct DamiaoParameters {
  DriveParameters drive{};
  MitRanges ranges{};
  std::uint64_t answers = 0;  ///< identifier of its answers (MST_ID); 0: node + 16

  /// s without an order until the motor releases itself; written to the motor. It is short, because a leg that keeps
  /// its last order while the others fold may turn a robot over (docs/drivers.md).
  double timeout = 0.03;

  std::optional<double> start_angle = std::nullopt;

  std::uint64_t place() const noexcept { return drive.node; }
};

inline Keys keys(DamiaoParameters& p) {
  return joined({mit_keys(p),
                 {
                     {"answers", &p.answers, {}, 0, 0x7FE, kOptional},
                     {"timeout", &p.timeout, "s", 0.01, 1, kOptional},
                 }});
}

}  // namespace robot_control::damiao
