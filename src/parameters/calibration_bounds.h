#pragma once
/// What a calibration of wheels and gyro may be; beyond, it is a typing error, a broken file or another robot.

namespace robot_control {

/// Right over left radius: a worn or half-flat tyre makes 2 %, and new tyres of one size differ by below 1 %.
inline constexpr double kRadiusRatioMin = 0.95;
inline constexpr double kRadiusRatioMax = 1.05;

/// Effective over the model's wheel base: the width of the tyres makes ± 10 %, what a skid steer scrubs beyond
/// Coulomb's multiplier ± 30 %.
inline constexpr double kWheelBaseFactorMin = 0.7;
inline constexpr double kWheelBaseFactorMax = 1.3;

/// rad/s, each axis: 57 °/s, while the worst consumer gyro has 20 °/s.
inline constexpr double kGyroBiasMax = 1.0;

}  // namespace robot_control
