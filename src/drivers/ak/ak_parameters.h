#pragma once
/// AkParameters are the statements of the drive file about one AK motor of T-Motor (CubeMars).

#include <cstdint>

#include "drivers/drive/mit/mit_joint.h"

namespace robot_control::ak {

struct AkParameters : MitJoint {
  /// °C of a motor that sends 0. The manual says −40; TMotorCANControl reads the byte as it is.
  double temperature_offset = -40;

  std::uint64_t place() const noexcept { return drive.node; }
};

inline Keys keys(AkParameters& p) {
  return joined({mit_keys(p),
                 {
                     {"motor_gear", &p.motor_gear, "turns of the rotor per turn of the shaft", 1, 200},
                     {"temperature_offset", &p.temperature_offset, "°C", -100, 100, kOptional},
                 }});
}

}  // namespace robot_control::ak
