#pragma once
/// The units of a CiA 402 drive. Raw values of its objects are converted here alone; everything else has SI units.
///
/// Torque: raw · rated torque / 1000. Position: raw · 2π / counts per turn. Velocity: raw · the maker's unit, for
/// instance 2π/60 rad/s for rpm. All belong to the motor's shaft. Conversions to raw values round, saturate, and make 0
/// of NaN. Source: CiA 402-2: 6071, 6076, 6077, 6064, 606C, 6079, 60C2.

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "drivers/line/wire_layout.h"

namespace robot_control::cia402 {

struct DriveUnits {
  double rated_torque = 1;                           ///< N·m
  double counts_per_turn = 4096;                     ///< of 6064
  double velocity_unit = 2 * std::numbers::pi / 60;  ///< rad/s of one raw unit of 606C; the default is kRpm

  double torque(std::int16_t raw) const noexcept { return raw * rated_torque / 1000; }
  double position(std::int32_t raw) const noexcept { return raw * (2 * std::numbers::pi / counts_per_turn); }
  double velocity(std::int32_t raw) const noexcept { return raw * velocity_unit; }

  std::int16_t raw_torque(double torque) const noexcept {
    return static_cast<std::int16_t>(saturated(1000 * torque / rated_torque, 16));
  }
  std::int32_t raw_velocity(double velocity) const noexcept {
    return static_cast<std::int32_t>(saturated(velocity / velocity_unit, 32));
  }
};

/// The objects from which the unit of 6064 follows, each as its ratio; 0: the drive has none.
struct ScalingObjects {
  double encoder = 0;  ///< 608F, increments per turn of the motor
  double gear = 0;     ///< 6091, turns of the motor per turn of the shaft
  double feed = 0;     ///< 6092, units of 6064 per turn of the shaft
};

/// Returns the units of 6064 per turn of the motor, feed / gear. Makers leave what they do not use at 1: a feed of 1 or
/// none means increments of the encoder. Returns 0 if nothing is known, and nothing if a gear without a feed makes it
/// ambiguous. Source: CiA 402-2: 608F, 6091, 6092.
inline std::optional<double> counts_per_turn(const ScalingObjects& objects) noexcept {
  const double gear = objects.gear == 0 ? 1 : objects.gear;
  if (objects.feed != 0 && objects.feed != 1) return objects.feed / gear;
  if (gear != 1) return std::nullopt;
  return objects.encoder;
}

inline constexpr double kRpm = 2 * std::numbers::pi / 60;  ///< rad/s

/// Returns the rad/s of one raw unit of 606C by 60A9. From the highest byte down, 60A9 holds a power of ten, the unit
/// of the way and the unit of the time. Returns 0 for others than revolutions per minute or per second. Source: CiA
/// 303-2.
inline double velocity_unit(std::uint32_t raw_60a9) noexcept {
  constexpr std::uint32_t kPerMinute = 0xB447, kPerSecond = 0xB403;
  const std::uint32_t unit = raw_60a9 >> 8U & 0xFFFFU;
  if (unit != kPerMinute && unit != kPerSecond) return 0;
  return std::pow(10.0, static_cast<std::int8_t>(raw_60a9 >> 24U)) * (unit == kPerMinute ? kRpm : 60 * kRpm);
}

inline double rated_torque(std::uint32_t raw_6076) noexcept {
  return raw_6076 / 1000.0;  // mN·m
}

inline double dc_link_voltage(std::uint32_t raw_6079) noexcept {
  return raw_6079 / 1000.0;  // mV
}

}  // namespace robot_control::cia402
