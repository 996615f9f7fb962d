#pragma once
/// How a moving robot shakes its IMU. With v the mean speed of the drive wheels' rims and s the way they have gone,
///
///   measured = true + r·v·n(t) + r·b(s)
///
/// r  roughness
/// n  accelerometer_vibration, gyro_vibration: noise that is white up to kBandwidth (first order), so that its integral
///    over t has the variance (r v σ)²·t as that of white noise
/// b  accelerometer_slow_error: what floor, suspension and scale add to the accelerometer: an Ornstein–Uhlenbeck walk
///    of the correlation length kLength along the way; it stands still when the robot does
///
/// Axes are independent. Real-time safe.

#include <vector>

#include "drivers/mujoco_plant_parameters.h"
#include "drivers/sensors/measurement.h"
#include "drivers/sensors/normal_stream.h"
#include "robot/robot_model.h"

namespace robot_control {

class Vibration {
 public:
  static constexpr double kBandwidth = 50;  ///< Hz: the recordings' IMUs sample at 100 Hz and say nothing of more
  static constexpr double kLength = 0.5;    ///< m: of the recordings' slow errors half is gone after 0.5 … 2 s

  /// `period` in s.
  Vibration(const RobotModel& robot, const Errors& errors, double period);

  void reset(std::uint64_t seed);

  /// Once per period; reads the exact speeds of the wheels.
  void step(Measurement& measurement) noexcept;

 private:
  struct Rim {
    std::size_t joint;
    double radius;
  };

  std::vector<Rim> rims_;
  double period_;
  double follow_;                ///< of the low pass, in a period
  double gyro_, accelerometer_;  ///< standard deviation of a white sample at 1 m/s, r σ/√T
  double slow_;                  ///< m/s², r·accelerometer_slow_error
  NormalStream vibration_stream_, slow_stream_;
  Vector3 shaken_gyro_{}, shaken_accelerometer_{}, slow_error_{};
};

}  // namespace robot_control
