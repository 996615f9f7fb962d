#pragma once
/// The gyro's bias from the rests so far, and whether the robot rests: judged by wheels and gyro alone, because a
/// motor's hum shakes the accelerometer of a robot that stands.
///
/// Rest is a window of kWindow in which no side travelled further than `tolerance`, and in which the gyro's mean is
/// that of the window before within `steady`. The first window after a stop, in which the body still rocks, only begins
/// the comparison. A robot that stood kReopened windows with another bias than is known has another bias.

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "signals/geometry.h"

namespace robot_control {

struct RestBiasParams {
  double tolerance = 0.00025;  ///< m
  double steady = 0.01;        ///< rad/s, standstill_speed
  double noise = 2.44e-4;      ///< rad/s/√Hz
  double walk = 8.7e-6;        ///< rad/s/√s
  double initial = 0.05;       ///< rad/s
};

class RestBias {
 public:
  static constexpr double kWindow = 0.5;          ///< s
  static constexpr std::uint64_t kReopened = 20;  ///< windows; nothing turns a robot so evenly on wheels that stand
  static constexpr double kLargest = 1.0;         ///< rad/s; a rest with more is none
  static constexpr double kInstability = 1.0e-4;  ///< rad/s, what a mean of any length may be off by (20 °/h)

  explicit RestBias(const RestBiasParams& params, const Vector3& bias = {}) noexcept
      : params_(params), bias_(bias), variance_(params.initial * params.initial) {}

  /// `bias` rad/s: known from before.
  void reset(const Vector3& bias) noexcept;

  struct Sample {
    double dt = 0;
    std::optional<Vector3> gyro;           ///< rad/s, base axes, mean over dt
    std::optional<Vector3> accelerometer;  ///< m/s², likewise
    double left = 0, right = 0;            ///< m, travel in this step
  };
  void step(const Sample& sample) noexcept;

  bool resting() const noexcept { return quiet_ >= 2 && different_ == 0; }
  double rested() const noexcept { return resting() ? static_cast<double>(quiet_) * kWindow : 0; }  ///< s
  /// A window of rest ended in this step; by which the heading seemed to turn in it, bias removed. rad
  bool window_ended() const noexcept { return ended_; }
  double turned() const noexcept { return turned_; }
  const std::optional<Vector3>& force() const noexcept { return force_; }  ///< m/s², its accelerometer's mean
  bool learned() const noexcept { return learned_; }                       ///< since the reset a rest was seen
  const Vector3& bias() const noexcept { return bias_; }                   ///< rad/s
  double variance() const noexcept { return variance_; }                   ///< (rad/s)², of every axis

 private:
  struct Mean {
    double time = 0;
    Vector3 sum{};
    void add(const std::optional<Vector3>& value, double dt) noexcept;
    std::optional<Vector3> over(double window) const noexcept;  ///< empty: known for less than half of it
  };

  void begin_window() noexcept;
  void close() noexcept;
  void learn(const Vector3& mean) noexcept;

  RestBiasParams params_;
  Vector3 bias_{};
  double variance_ = 0;
  bool learned_ = false;
  bool moved_ = false;  ///< since the reset
  double time_ = 0;
  Mean gyro_;
  Mean accelerometer_;
  double left_ = 0, right_ = 0;
  Vector3 before_{};
  std::uint64_t quiet_ = 0;      ///< windows in a row
  std::uint64_t different_ = 0;  ///< of these, with another bias
  bool ended_ = false;
  double turned_ = 0;
  std::optional<Vector3> force_;
};

}  // namespace robot_control
