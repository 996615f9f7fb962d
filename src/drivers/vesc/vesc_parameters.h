#pragma once
/// VescParameters are the statements of the drive file about one VESC.

#include <cstdint>

#include "drivers/drive_parameters.h"

namespace robot_control::vesc {

struct VescParameters {
  DriveParameters drive{};
  std::uint64_t pole_pairs = 0;     ///< of the motor: half of the motor poles in its maker's tool
  double torque_constant = 0;       ///< N·m/A, of the motor; 0: unknown, so that no torque is ordered or measured
  double status_period = 0.002;     ///< s between the CAN status messages 1 and 5, as set in the drive (rate 1)
  double temperature_period = 0.1;  ///< s between the CAN status messages 4, as set in the drive (rate 2)

  std::uint64_t place() const noexcept { return drive.node; }
};

inline Keys keys(VescParameters& p) {
  return joined({keys(p.drive),
                 {
                     {"pole_pairs", &p.pole_pairs, {}, 1, 100},
                     {"torque_constant", &p.torque_constant, "N·m/A", 1.0e-4, 100, kOptional | kZeroIsOff},
                     {"status_period", &p.status_period, "s", 0.001, 0.1, kOptional},
                     {"temperature_period", &p.temperature_period, "s", 0.001, 1, kOptional},
                 }});
}

}  // namespace robot_control::vesc
