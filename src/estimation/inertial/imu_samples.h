#pragma once
/// Gyro and accelerometer samples as they come → their means over each step, in base axes.
///
///   gyro            (ω_k−1 + ω_k)/2 over the time between two samples. Steps without a sample take the last one; the
///                   step that brings the next one makes the trapezoid whole.
///   accelerometer   the last sample: it is a mean over the time before it (signals/sensor_frame.h)
/// A sample holds for three times the gap between the last two good ones, within kShortestHold … kLongestHold; then the
/// sensor is lost. Not finite, or beyond kGyroRange or kAccelerometerRange, is no sample.

#include <Eigen/Core>
#include <optional>

#include "estimation/tuning.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class ImuSamples {
 public:
  /// `base_from_imu`: rotation. `dt`: s since the last call, 0 at the first.
  void step(const SensorFrame& sensors, const Eigen::Matrix3d& base_from_imu, double dt) noexcept;

  /// Mean over the last step; empty: lost.
  const std::optional<Eigen::Vector3d>& gyro() const noexcept { return gyro_.mean; }
  /// Empty, too, where its samples keep coming more than kSlowAccelerometer apart: what happened between them is not
  /// known.
  std::optional<Eigen::Vector3d> accelerometer() const noexcept {
    return accelerometer_.gap > Tuning::kSlowAccelerometer ? std::nullopt : accelerometer_.mean;
  }
  bool new_gyro() const noexcept { return gyro_.fresh; }  ///< the last step brought a sample
  const Eigen::Vector3d& last_gyro() const noexcept { return gyro_.last; }
  /// rad/s, bias included; where the gyro is not lost. In the step that makes the trapezoid whole its mean is no rate,
  /// and the sample alone is.
  const Eigen::Vector3d& gyro_rate() const noexcept { return gyro_.catches_up ? gyro_.last : *gyro_.mean; }
  double gyro_unchanged() const noexcept { return gyro_unchanged_; }  ///< s, in which it repeated one sample
  double gyro_gap() const noexcept { return gyro_.gap; }              ///< s, between two samples
  bool refused() const noexcept { return refused_; }                  ///< the last step brought a sample that is none

 private:
  struct Channel {
    std::optional<Eigen::Vector3d> mean;
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    bool received = false;  ///< ever
    bool known = false;     ///< and not lost
    bool fresh = false;
    bool catches_up = false;
    double age = 0;       ///< s since the last sample
    double last_gap = 0;  ///< s between the last two
    double gap = 0;       ///< s, the shorter of the last two gaps: one lost sample makes no slow sensor
    double hold = Tuning::kShortestHold;
  };

  static void take(Channel& channel, const std::optional<Eigen::Vector3d>& sample, double dt, bool trapezoid) noexcept;

  Channel gyro_;
  double gyro_unchanged_ = 0;  ///< s
  Channel accelerometer_;
  bool refused_ = false;
};

}  // namespace robot_control
