#pragma once
/// Converts samples of gyro and accelerometer to their means over each step, in base axes.
///
///   gyro            (ω_k−1 + ω_k)/2 over the time between two samples; steps without a sample use the last one, and
///                   the step with the next sample completes the trapezoid
///   accelerometer   the last sample, which is a mean over the time before it (signals/sensor_frame.h)
/// A sample holds for three times the gap between the last two good ones, within kMinHoldTime … kMaxHoldTime. After
/// that the sensor is lost. A value that is not finite, or beyond kGyroRange or kAccelerometerRange, is no sample.

#include <Eigen/Core>
#include <optional>

#include "estimation/common/tuning.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// Holds what the IMU shows in one step.
struct ImuReading {
  std::optional<Vector3> gyro;           ///< rad/s, mean over the step, bias included; empty: lost
  std::optional<Vector3> accelerometer;  ///< m/s², mean; empty: lost, or its samples come > kSlowAccelerometer apart
  Vector3 rate{};                        ///< rad/s, bias included: the mean, or the sample that completes a trapezoid
  Vector3 sample{};                      ///< rad/s, last sample of the gyro
  bool fresh_gyro = false;               ///< The step brought a sample of the gyro.
  bool refused = false;                  ///< The step brought an invalid sample.
  double gyro_gap = 0;                   ///< s between two samples
  double gyro_unchanged = 0;             ///< s for which the gyro has repeated one sample
};

class ImuSamples {
 public:
  /// `base_from_imu` is a rotation. `dt` is the time in s since the last call, 0 in the first.
  ImuReading step(const SensorFrame& sensors, const Eigen::Matrix3d& base_from_imu, double dt) noexcept;

 private:
  struct Channel {
    Vector3 last{};
    bool received = false;    ///< A sample was received in this run.
    bool known = false;       ///< The sensor is not lost.
    bool catches_up = false;  ///< The last step completed a trapezoid.
    double age = 0;           ///< s since the last sample
    double last_gap = 0;      ///< s between the last two
    double gap = 0;           ///< s, shorter one of the last two gaps: a lost sample does not make a slow sensor
    double hold = Tuning::kMinHoldTime;

    /// Returns the mean over the step.
    std::optional<Vector3> step(const std::optional<Vector3>& sample, double dt, bool trapezoid) noexcept;
  };

  Channel gyro_;
  Channel accelerometer_;
  double gyro_unchanged_ = 0;  ///< s
};

}  // namespace robot_control
