#pragma once
/// The battery's voltage at its terminals, where it has to feed the motors.
///
/// A source U₀ behind a resistance R. The motors draw the mechanical power P that they give (losses in copper and
/// gears are left out, so that a real battery sags more; P < 0: they charge it), everything else the current I₀:
///
///   U = U₀ − R I      I = P/U + I₀      U² − (U₀ − R I₀) U + R P = 0,  the greater root
///
/// More power than (U₀ − R I₀)²/(4 R) no such source gives; there U stays at half of U₀ − R I₀. The motors do not
/// notice; it does not run down.

#include <algorithm>
#include <cmath>

namespace robot_control {

inline constexpr double kIdleCurrent = 0.5;  ///< A, I₀: a small computer and its sensors, 12 W at 24 V

struct BatterySample {
  double voltage = 0;  ///< V
  double current = 0;  ///< A, positive when discharging
};

/// `open_voltage` U₀ > R I₀; `resistance` R ≥ 0, Ω; `power` P, W.
inline BatterySample battery_under_load(double open_voltage, double resistance, double power) noexcept {
  const double half = (open_voltage - resistance * kIdleCurrent) / 2;
  const double voltage = half + std::sqrt(std::max(0.0, half * half - resistance * power));
  return {.voltage = voltage, .current = power / voltage + kIdleCurrent};
}

}  // namespace robot_control
