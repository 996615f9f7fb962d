#pragma once
/// A WheeledState is the part of the state that only machines on wheels have.

#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_control {

/// The values are indices of WheeledState::confidence, nis and rejected. The last two are assumptions about the contact
/// with the ground, which are always trusted. Wheels do not slide sideways, and the robot neither sinks nor flies.
enum SensorIndex : std::size_t {
  kLeftEncoder = 0,
  kRightEncoder = 1,
  kGyro = 2,
  kAccelerometer = 3,
  kLateralContact = 4,
  kVerticalContact = 5,
};
inline constexpr std::size_t kWheeledSensors = 6;

/// Bits of WheeledState::slip: how the wheels contradict the accelerometer.
enum SlipReason : std::uint64_t {
  kSlipSpinning = 1u << 0,  ///< The wheels turn faster than the ground passes.
  kSlipStalled = 1u << 1,   ///< The wheels turn slower than the ground passes, or stand.
  kSlipBlocked = 1u << 2,   ///< The wheels turn, and the robot has stood for a second.
};

/// The estimated calibration of wheels and gyro relative to DriveTrain, with standard deviations.
struct WheelCalibration {
  double radius_ratio = 1;            ///< right over left radius, relative to the model's
  double wheel_base_factor = 1;       ///< effective wheel base over the model's
  double radius_ratio_deviation = 0;  ///< standard deviation; 0: not estimated
  double wheel_base_deviation = 0;    ///< standard deviation of wheel_base_factor; 0: not estimated
};

/// Odometry from the wheels and the model's dimensions, without gyro and calibration, for comparison.
struct WheelOdometry {
  double x = 0, y = 0;  ///< m, odom axes
  double yaw = 0;       ///< rad
  double linear = 0;    ///< m/s, base x
  double angular = 0;   ///< rad/s, base z
};

struct WheeledState {
  WheelCalibration calibration;
  WheelOdometry odometry;
  std::array<double, kWheeledSensors> confidence{};  ///< 0 (not used) … 1 (agrees fully), by SensorIndex
  std::array<double, kWheeledSensors>
      nis{};  ///< normalised innovation squared per degree of freedom, smoothed; ideal 1
  std::array<std::uint64_t, kWheeledSensors>
      rejected{};             ///< comparisons of this run that were beyond their gate and not used
  std::uint64_t slip = 0;     ///< SlipReason bits
  double residual_level = 0;  ///< residual of wheels minus accelerometer over the sensors' noise; 0: none
};

}  // namespace robot_control
