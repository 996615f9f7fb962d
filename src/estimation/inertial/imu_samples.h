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

#include "estimation/tuning.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class ImuSamples {
 public:
  /// `base_from_imu` is a rotation. `dt` is the time in s since the last call, 0 in the first.
  void step(const SensorFrame& sensors, const Eigen::Matrix3d& base_from_imu, double dt) noexcept;

  /// Returns the mean over the last step; empty: the gyro is lost.
  const std::optional<Eigen::Vector3d>& gyro() const noexcept { return gyro_.mean; }
  /// Returns the mean over the last step; empty if the sensor is lost or its samples come more than kSlowAccelerometer
  /// apart.
  std::optional<Eigen::Vector3d> accelerometer() const noexcept {
    return accelerometer_.gap > Tuning::kSlowAccelerometer ? std::nullopt : accelerometer_.mean;
  }
  bool new_gyro() const noexcept { return gyro_.fresh; }  ///< The last step brought a sample.
  const Eigen::Vector3d& last_gyro() const noexcept { return gyro_.last; }
  /// Returns the rate in rad/s, bias included; the gyro must not be lost. The mean of a step that completes a trapezoid
  /// is no rate, and the sample is returned instead.
  const Eigen::Vector3d& gyro_rate() const noexcept { return gyro_.catches_up ? gyro_.last : *gyro_.mean; }
  double gyro_unchanged() const noexcept { return gyro_unchanged_; }  ///< s for which the gyro has repeated one sample
  double gyro_gap() const noexcept { return gyro_.gap; }              ///< s between two samples
  bool refused() const noexcept { return refused_; }                  ///< The last step brought an invalid sample.

 private:
  struct Channel {
    std::optional<Eigen::Vector3d> mean;
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    bool received = false;  ///< A sample was received in this run.
    bool known = false;     ///< The sensor is not lost.
    bool fresh = false;
    bool catches_up = false;
    double age = 0;       ///< s since the last sample
    double last_gap = 0;  ///< s between the last two
    double gap = 0;       ///< s, the shorter of the last two gaps, so that one lost sample does not make a slow sensor
    double hold = Tuning::kMinHoldTime;
  };

  static void accept(Channel& channel, const std::optional<Eigen::Vector3d>& sample, double dt,
                     bool trapezoid) noexcept;

  Channel gyro_;
  double gyro_unchanged_ = 0;  ///< s
  Channel accelerometer_;
  bool refused_ = false;
};

}  // namespace robot_control
