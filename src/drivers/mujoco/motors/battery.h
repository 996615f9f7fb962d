#pragma once
/// battery_under_load computes the battery's voltage at its terminals while it feeds the motors.
///
/// The battery is a source U₀ behind a resistance R. The motors draw their mechanical power P; P < 0 charges the
/// battery. Losses in copper and gears are left out, so that the voltage of a real battery falls further. All other
/// devices draw the current I₀:
///
///   U = U₀ − R I      I = P/U + I₀      U² − (U₀ − R I₀) U + R P = 0,  the greater root
///
/// The source cannot give more power than (U₀ − R I₀)²/(4 R); beyond that U stays at half of U₀ − R I₀. The motors are
/// not limited by the battery, and it does not discharge.

#include <algorithm>
#include <cmath>

namespace robot_control {

inline constexpr double kIdleCurrent = 0.5;  ///< A, I₀: a small computer and its sensors, 12 W at 24 V

struct BatterySample {
  double voltage = 0;  ///< V
  double current = 0;  ///< A, positive when discharging
};

/// `open_voltage` is U₀ > R I₀ in V, `resistance` is R ≥ 0 in Ω, `power` is P in W.
inline BatterySample battery_under_load(double open_voltage, double resistance, double power) noexcept {
  const double half = (open_voltage - resistance * kIdleCurrent) / 2;
  const double voltage = half + std::sqrt(std::max(0.0, half * half - resistance * power));
  return {.voltage = voltage, .current = power / voltage + kIdleCurrent};
}

}  // namespace robot_control
