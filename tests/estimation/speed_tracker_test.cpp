#include "estimation/wheels/speed_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/constants.h"

namespace robot_control {
namespace {

constexpr double kBandwidth = 20;

TEST(SpeedTracker, StaysAtAConstantSpeed) {
  SpeedTracker tracker(kBandwidth, kPeriod);
  tracker.reset(0.5);
  for (int i = 0; i < 1000; ++i) tracker.step(0.5 * kPeriod, kPeriod);
  EXPECT_NEAR(tracker.speed(), 0.5, 1e-12);
}

// Three poles of 2π·20 rad/s: after 0.5 s e^-63 of the error is left, times a small polynomial.
TEST(SpeedTracker, FollowsAConstantAccelerationWithoutLag) {
  SpeedTracker tracker(kBandwidth, kPeriod);
  const double acceleration = 2.0;
  double speed = 0;
  for (int i = 0; i < 500; ++i) {
    tracker.step((speed + acceleration * kPeriod / 2) * kPeriod, kPeriod);
    speed += acceleration * kPeriod;
  }
  EXPECT_NEAR(tracker.speed(), speed, 1e-9);
}

TEST(SpeedTracker, DoesNotCareHowTheTravelOfAGapWasSampled) {
  SpeedTracker tracker(kBandwidth, kPeriod);
  tracker.reset(0.5);
  tracker.step(0.5 * 7 * kPeriod, 7 * kPeriod);
  EXPECT_NEAR(tracker.speed(), 0.5, 1e-12);
}

// With 4096 counts and a wheel radius of 0.1 m a count is 0.153 mm, differenced 0.153 m/s.
TEST(SpeedTracker, SmoothsEncoderCountsToAFewPercentOfTheirQuantum) {
  SpeedTracker tracker(kBandwidth, kPeriod);
  const double count = 2 * std::numbers::pi / 4096 * 0.1;
  const double quantum = count / kPeriod;
  const double speed = 0.0371;
  tracker.reset(speed);
  double before = 0;
  double worst = 0;
  for (int i = 1; i <= 5000; ++i) {
    const double now = std::floor(speed * kPeriod * i / count) * count;
    tracker.step(now - before, kPeriod);
    before = now;
    worst = std::max(worst, std::abs(tracker.speed() - speed));
  }
  EXPECT_LT(worst, 0.15 * quantum);
}

}  // namespace
}  // namespace robot_control
