#pragma once
/// Vibration adds the vibration of a moving robot to its IMU. With the mean speed v of the drive wheels' rims and the
/// distance s that they have rolled,
///
///   measured = true + r·v·n(t) + r·b(s)
///
/// r  roughness
/// n  accelerometer_vibration, gyro_vibration: noise that is white up to kBandwidth (first order), so that its integral
///    over t has the variance (r v σ)²·t of white noise
/// b  accelerometer_slow_error: the errors of the accelerometer from floor, suspension and scale, an Ornstein–Uhlenbeck
///    process of the correlation length kLength along the path; it is constant while the robot stands
///
/// The axes are independent. The class is real-time safe.

#include <vector>

#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "drivers/mujoco/sensors/measurement.h"
#include "drivers/mujoco/sensors/normal_stream.h"

namespace robot_control {

/// A wheel that rolls on the floor.
struct Rim {
  std::size_t joint = 0;
  double radius = 0;  ///< m
};

class Vibration {
 public:
  static constexpr double kBandwidth =
      50;                                 ///< Hz; the recordings' IMUs sample at 100 Hz and show no higher frequencies
  static constexpr double kLength = 0.5;  ///< m; in the recordings, slow errors fall to half in 0.5 … 2 s

  /// `period` is in s. Without a rim nothing vibrates.
  Vibration(std::vector<Rim> rims, const Errors& errors, double period);

  void reset(std::uint64_t seed);

  /// Is called once per period with the exact speeds of the wheels.
  void step(Measurement& measurement) noexcept;

 private:
  std::vector<Rim> rims_;
  double period_;
  double follow_;                ///< gain of the low pass per period
  double gyro_, accelerometer_;  ///< standard deviation of a white sample at 1 m/s, r σ/√T
  double slow_;                  ///< m/s², r·accelerometer_slow_error
  NormalStream vibration_stream_, slow_stream_;
  Vector3 shaken_gyro_{}, shaken_accelerometer_{}, slow_error_{};
};

}  // namespace robot_control
