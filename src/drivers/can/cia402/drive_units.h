#pragma once
/// The units of a CiA 402 drive. Raw values of its objects are converted here alone; everything else has SI units.
///
/// Torque: raw · rated torque / 1000. Position: raw · 2π / counts per turn. Velocity: raw · the maker's unit, for
/// instance 2π/60 rad/s for rpm. All belong to the motor's shaft. Conversions to raw values round, saturate, and make 0
/// of NaN. Source: CiA 402-2: 6071, 6076, 6077, 6064, 606C, 6079, 60C2.

#include <cmath>
#include <cstdint>
#include <numbers>

#include "drivers/can/wire_layout.h"

namespace robot_control::cia402 {

struct DriveUnits {
  double rated_torque = 1;                           ///< N·m
  double counts_per_turn = 4096;                     ///< of 6064
  double velocity_unit = 2 * std::numbers::pi / 60;  ///< rad/s of one raw unit of 606C; the default is 1 rpm

  double torque(std::int16_t raw) const noexcept { return raw * rated_torque / 1000; }
  double position(std::int32_t raw) const noexcept { return raw * (2 * std::numbers::pi / counts_per_turn); }
  double velocity(std::int32_t raw) const noexcept { return raw * velocity_unit; }

  std::int16_t raw_torque(double torque) const noexcept {
    return static_cast<std::int16_t>(saturated(1000 * torque / rated_torque, 16));
  }
};

inline double rated_torque(std::uint32_t raw_6076) noexcept {
  return raw_6076 / 1000.0;  // mN·m
}

inline double dc_link_voltage(std::uint32_t raw_6079) noexcept {
  return raw_6079 / 1000.0;  // mV
}

}  // namespace robot_control::cia402
