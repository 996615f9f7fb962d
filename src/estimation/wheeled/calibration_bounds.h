#pragma once
/// A calibration of wheels and gyro outside these bounds is a typing error, a broken file or that of another robot.

namespace robot_control {

/// Ratio of right over left radius: a worn or half-flat tyre makes 2 %, new tyres of one size differ by less than 1 %.
inline constexpr double kRadiusRatioMin = 0.95;
inline constexpr double kRadiusRatioMax = 1.05;

/// Ratio of the effective over the model's wheel base. The width of the tyres makes ± 10 %, deviations from Coulomb's
/// scrub of a skid steer ± 30 %.
inline constexpr double kWheelBaseFactorMin = 0.7;
inline constexpr double kWheelBaseFactorMax = 1.3;

/// rad/s of each axis, which is 57 °/s; the worst consumer gyro has 20 °/s.
inline constexpr double kGyroBiasMax = 1.0;

}  // namespace robot_control
