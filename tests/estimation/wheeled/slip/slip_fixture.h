#pragma once
/// A body on wheels in the plane, and the data of wheels, gyro and accelerometer for the slip detector, in the form of
/// the estimator.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "estimation/wheeled/slip/slip_detector.h"
#include "estimation/wheeled/slip/wheel_slide.h"

namespace robot_control {

class SlidingBody {
 public:
  static constexpr double kStep = 0.005;  ///< s
  static constexpr double kBase = SlipParams{}.wheel_base;

  explicit SlidingBody(const SlipParams& params = {}, unsigned seed = 1)
      : params_(params), detector(params), random_(seed) {}

  /// Motion of the middle of the wheels.
  double speed = 0;              ///< m/s, ahead
  double lateral = 0;            ///< m/s, to the left, which wheels do not measure
  double rate = 0;               ///< rad/s
  double left = 0, right = 0;    ///< m/s, by which the treads are faster than the ground
  double noise = 0;              ///< m/s²/√Hz, of the accelerometer
  double error = 0;              ///< m/s², of the accelerometer ahead
  int gap = 1;                   ///< steps between two readings of the wheels
  int late = 0;                  ///< steps by which the wheels' stamps are late; < 0: early
  double yaw = 0, x = 0, y = 0;  ///< the truth: rad, m

 private:
  SlipParams params_;

 public:
  SlipDetector detector;

  /// Runs one step with these accelerations, m/s² and rad/s². True: the detector has a new point.
  bool step(double ahead = 0, double across = 0, double turning = 0) {
    const double middle_rate = rate + turning * kStep / 2;
    const double middle_speed = speed + ahead * kStep / 2;
    const double middle_lateral = lateral + across * kStep / 2;
    const double turned = middle_rate * kStep;
    const double c = std::cos(yaw + turned / 2);
    const double s = std::sin(yaw + turned / 2);
    x += kStep * (c * middle_speed - s * middle_lateral);
    y += kStep * (s * middle_speed + c * middle_lateral);
    yaw += turned;
    speed += ahead * kStep;
    lateral += across * kStep;
    rate += turning * kStep;
    const double white = noise / std::sqrt(kStep);
    MotionDifference::Sample sample;
    sample.dt = kStep;
    sample.acceleration = {ahead - middle_rate * middle_lateral - turning * params_.imu_y -
                               middle_rate * middle_rate * params_.imu_x + error + white * normal_(random_),
                           across + middle_rate * middle_speed + turning * params_.imu_x -
                               middle_rate * middle_rate * params_.imu_y + white * normal_(random_)};
    sample.turned = turned;
    sample.yaw = yaw;
    sample.yaw_rate = rate;
    left_ += kStep * (middle_speed - middle_rate * kBase / 2 + left);
    right_ += kStep * (middle_speed + middle_rate * kBase / 2 + right);
    turned_ += turned;
    if (++steps_ % gap == 0) {
      sample.both_sides_read = true;
      const double distance = (left_ + right_) / 2;
      sample.path = {std::cos(yaw - turned_ / 2) * distance, std::sin(yaw - turned_ / 2) * distance};
      sample.right_minus_left = right_ - left_;
      sample.distance = (std::abs(left_) + std::abs(right_)) / 2;
      wheels_ = {wheels_.x + sample.path.x, wheels_.y + sample.path.y};
      left_ = right_ = turned_ = 0;
    }
    read_ = sample.both_sides_read;
    return detector.step(stamped(sample));
  }

  bool read() const { return read_; }
  const Planar& wheels() const { return wheels_; }  ///< m, by wheels and gyro
  double wheel_speed() const { return speed + (left + right) / 2; }

 private:
  /// The sample with the stamps of the sensors' clocks.
  MotionDifference::Sample stamped(const MotionDifference::Sample& now) {
    samples_.push_back(now);
    const auto before = [&](int steps) {
      return static_cast<int>(samples_.size()) > steps ? samples_[samples_.size() - 1 - static_cast<std::size_t>(steps)]
                                                       : MotionDifference::Sample{.dt = kStep, .both_sides_read = true};
    };
    MotionDifference::Sample sample = before(std::max(0, -late));
    const MotionDifference::Sample wheels = before(std::max(0, late));
    sample.path = wheels.path;
    sample.right_minus_left = wheels.right_minus_left;
    sample.distance = wheels.distance;
    sample.both_sides_read = wheels.both_sides_read;
    return sample;
  }

  std::mt19937 random_;
  std::normal_distribution<double> normal_{0, 1};
  std::vector<MotionDifference::Sample> samples_;
  double left_ = 0, right_ = 0, turned_ = 0;
  int steps_ = 0;
  bool read_ = false;
  Planar wheels_;
};

/// The body stands, then drives at 0.5 m/s with noise of the data sheet for 20 s, in which the levels are learned.
struct SlipFixture : testing::Test {
  explicit SlipFixture(const SlipParams& params = {}) : body_(params) {
    body_.noise = params.accelerometer;
    body_.detector.restart_at_rest(0, {0, 0, 1}, {});
  }

  void evaluate(bool learns) {
    body_.detector.evaluate({.acceleration_variance = {1e-6, 1e-6}, .wheel_base = 0.003}, learns);
  }
  bool any_proven() const {
    return body_.detector.proven(SlipResidual::kAlong) || body_.detector.proven(SlipResidual::kAcross) ||
           body_.detector.proven(SlipResidual::kTurn);
  }
  /// Drives, judged at each point; returns the duration of proven slip, s.
  double drive(double seconds, double ahead = 0, double across = 0, double turning = 0) {
    double proven = 0;
    for (double t = 0; t < seconds - SlidingBody::kStep / 2; t += SlidingBody::kStep) {
      if (!body_.step(ahead, across, turning)) continue;
      evaluate(true);
      if (any_proven()) proven += Tuning::kPointInterval;
    }
    return proven;
  }
  void learn() {
    drive(0.5, 1.0);
    EXPECT_EQ(drive(20), 0);
  }
  /// s until `channel` proves slip; `longest` if it does not.
  double time_to_proof(SlipResidual::Channel channel, double longest, double ahead = 0, double across = 0) {
    for (double t = 0; t < longest; t += SlidingBody::kStep) {
      if (!body_.step(ahead, across)) continue;
      evaluate(false);
      if (body_.detector.proven(channel)) return t;
    }
    return longest;
  }

  SlidingBody body_;
};

}  // namespace robot_control
