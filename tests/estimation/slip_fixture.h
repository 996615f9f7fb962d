#pragma once
/// A body on wheels in the plane, and what wheels, gyro and accelerometer bring of it to the slip statistic, as the
/// estimator brings it.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimation/slip/slip_correction.h"
#include "estimation/slip/slip_statistic.h"

namespace robot_control {

class SlidingBody {
 public:
  static constexpr double kStep = 0.005;  ///< s
  static constexpr double kBase = SlipStatisticParams{}.wheel_base;

  explicit SlidingBody(const SlipStatisticParams& params = {}, unsigned seed = 1)
      : params_(params), statistic(params), random_(seed) {
    statistic.restart();
  }

  /// Of the middle of the wheels.
  double speed = 0;              ///< m/s, ahead
  double aside = 0;              ///< m/s, to the left, which wheels do not measure
  double rate = 0;               ///< rad/s
  double left = 0, right = 0;    ///< m/s, by which the treads are faster than the ground
  double noise = 0;              ///< m/s²/√Hz, of the accelerometer
  double error = 0;              ///< m/s², of the accelerometer ahead
  int gap = 1;                   ///< steps between two readings of the wheels
  double yaw = 0, x = 0, y = 0;  ///< the truth: rad, m

 private:
  SlipStatisticParams params_;

 public:
  SlipStatistic statistic;

  /// One step with these accelerations, m/s² and rad/s². True: the statistic has a new point.
  bool step(double ahead = 0, double across = 0, double turning = 0) {
    const double middle_rate = rate + turning * kStep / 2;
    const double middle_speed = speed + ahead * kStep / 2;
    const double middle_aside = aside + across * kStep / 2;
    const double turned = middle_rate * kStep;
    const double c = std::cos(yaw + turned / 2);
    const double s = std::sin(yaw + turned / 2);
    x += kStep * (c * middle_speed - s * middle_aside);
    y += kStep * (s * middle_speed + c * middle_aside);
    yaw += turned;
    speed += ahead * kStep;
    aside += across * kStep;
    rate += turning * kStep;
    const double white = noise / std::sqrt(kStep);
    SlipStatistic::Sample sample;
    sample.dt = kStep;
    sample.acceleration = {ahead - middle_rate * middle_aside - turning * params_.aside -
                               middle_rate * middle_rate * params_.ahead + error + white * normal_(random_),
                           across + middle_rate * middle_speed + turning * params_.ahead -
                               middle_rate * middle_rate * params_.aside + white * normal_(random_)};
    sample.turned = turned;
    sample.yaw = yaw;
    sample.rate = rate;
    left_ += kStep * (middle_speed - middle_rate * kBase / 2 + left);
    right_ += kStep * (middle_speed + middle_rate * kBase / 2 + right);
    turned_ += turned;
    if (++steps_ % gap == 0) {
      sample.read = true;
      const double way = (left_ + right_) / 2;
      sample.way = {std::cos(yaw - turned_ / 2) * way, std::sin(yaw - turned_ / 2) * way};
      sample.across = right_ - left_;
      sample.path = (std::abs(left_) + std::abs(right_)) / 2;
      wheels_ = {wheels_.x + sample.way.x, wheels_.y + sample.way.y};
      left_ = right_ = turned_ = 0;
    }
    read_ = sample.read;
    return statistic.step(sample);
  }

  bool read() const { return read_; }
  const Planar& wheels() const { return wheels_; }  ///< m, by wheels and gyro
  double wheel_speed() const { return speed + (left + right) / 2; }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0, 1};
  double left_ = 0, right_ = 0, turned_ = 0;
  int steps_ = 0;
  bool read_ = false;
  Planar wheels_;
};

/// Stands, then drives at 0.5 m/s with noise of the data sheet for 20 s, in which the levels are learned.
class SlipFixture : public testing::Test {
 protected:
  explicit SlipFixture(const SlipStatisticParams& params = {}) : body_(params) {
    body_.noise = params.accelerometer;
    body_.statistic.stand(0, {0, 0, 1});
  }

  void judge(bool learns) {
    body_.statistic.judge({.acceleration = {1e-6, 1e-6}, .base = 0.003, .bias = 1e-5}, learns);
  }
  bool any_proven() const {
    return body_.statistic.proven(SlipStatistic::kAlong) || body_.statistic.proven(SlipStatistic::kAcross) ||
           body_.statistic.proven(SlipStatistic::kTurn);
  }
  /// Judged at each point; s in which slip was proven.
  double drive(double seconds, double ahead = 0, double across = 0, double turning = 0) {
    double proven = 0;
    for (double t = 0; t < seconds - SlidingBody::kStep / 2; t += SlidingBody::kStep) {
      if (!body_.step(ahead, across, turning)) continue;
      judge(true);
      if (any_proven()) proven += SlipStatistic::kGrid;
    }
    return proven;
  }
  void learn() {
    drive(0.5, 1.0);
    EXPECT_EQ(drive(20), 0);
  }
  /// s until `channel` proves slip; `longest` if it does not.
  double time_to_proof(SlipStatistic::Channel channel, double longest, double ahead = 0, double across = 0) {
    for (double t = 0; t < longest; t += SlidingBody::kStep) {
      if (!body_.step(ahead, across)) continue;
      judge(false);
      if (body_.statistic.proven(channel)) return t;
    }
    return longest;
  }

  SlidingBody body_;
};

}  // namespace robot_control
