#include "estimation/common/inertial/rate_tracker.h"

#include <random>

#include "estimation/wheeled/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

using Eigen::Vector3d;

// Two poles of 2π·20 rad/s: after 0.5 s e^-63 of the error is left, times a small polynomial.
TEST(RateTracker, FollowsAConstantAngularAccelerationWithoutLag) {
  RateTracker tracker(20, kPeriod);
  Vector3d rate = Vector3d::Zero();
  for (int i = 0; i < 500; ++i) {
    rate += kPeriod * Vector3d(1, -2, 4);
    tracker.step(rate, kPeriod);
  }
  EXPECT_LT((tracker.rate() - rate).norm(), 1e-9);
}

TEST(RateTracker, PassesOnWhatComesSlowerThanItsBandwidth) {
  RateTracker tracker(20, kPeriod);
  tracker.step({0, 0, 1}, 1.0);
  EXPECT_NEAR(tracker.rate().z(), 1, 1e-9);
}

// The reference is 10⁶ samples, each the mean of two neighbours of white noise: the deviation is known to below 1 %.
TEST(RateTracker, KnowsItsNoise) {
  for (const double bandwidth : {5.0, 20.0, 100.0, 500.0}) {
    RateTracker tracker(bandwidth, kPeriod);
    std::mt19937 random(1);
    std::normal_distribution<double> white;
    double last = 0, sum = 0;
    constexpr int kSamples = 1000000;
    for (int i = 0; i < kSamples; ++i) {
      const double next = white(random);
      tracker.step({0, 0, (next + last) / 2}, kPeriod);
      last = next;
      sum += tracker.rate().z() * tracker.rate().z();
    }
    EXPECT_NEAR(tracker.noise_gain() / (sum / kSamples), 1, 0.03) << bandwidth;
  }
  EXPECT_NEAR(RateTracker(1e6, kPeriod).noise_gain(), 0.5, 1e-9) << "of the mean of two samples itself";
}

class PublishedRate : public EstimatorFixture {};

// A gyro noise of 2.44e-4 rad/s/√Hz is 7.7 mrad/s per sample at 1 kHz. The mean of two has 5.5; behind the loop it is
// below 3.1.
TEST_F(PublishedRate, IsQuietOnAStraightDriveAndSaysHowQuiet) {
  robot_.noise.gyro = EstimatorParameters{}.gyro_noise;
  drive(0, 0, 1000);
  drive(0.5, 0, 3000);
  double square = 0, stated = 0;
  constexpr int kCycles = 5000;
  for (int i = 0; i < kCycles; ++i) {
    drive(0.5, 0, 1);
    square += state_.base.twist_base.angular[2] * state_.base.twist_base.angular[2];
    stated += state_.base.twist_covariance[35];
  }
  const double deviation = std::sqrt(square / kCycles);
  EXPECT_LT(deviation, 3.3e-3);
  EXPECT_NEAR(std::sqrt(stated / kCycles) / deviation, 1, 0.2) << "what it says of itself";
}

// The estimate is at rest until the window breaks, which takes at most 20 ms at 4 rad/s².
TEST_F(PublishedRate, FollowsATurnFromItsFirstCycleOn) {
  drive(0, 0, 1000);
  for (int i = 0; i < 1500; ++i) {
    drive(0.3, 1.0, 1);
    ASSERT_NEAR(state_.base.twist_base.angular[2], robot_.motion.rate.z(), 0.08) << "cycle " << i;
  }
  EXPECT_NEAR(state_.base.twist_base.angular[2], 1.0, 1e-3);
}

// With 4096 counts at 1 kHz the encoder's own speed jumps by 1.53 rad/s. Half a per cent of that is the loop's noise,
// RMS.
TEST_F(PublishedRate, DoesNotJumpWithTheCountsOfAWheel) {
  robot_.noise.counts = 4096;
  drive(0, 0, 1000);
  drive(0.5, 0.2, 3000);
  for (int i = 0; i < 2000; ++i) {
    drive(0.5, 0.2, 1);
    ASSERT_NEAR(state_.joint_velocity[0], 4.5, 0.03);
    ASSERT_NEAR(state_.joint_velocity[1], 5.5, 0.03);
  }
  drive(0, 0, 3000);
  EXPECT_NEAR(state_.joint_velocity[0], 0, 1e-6);
}

TEST_F(PublishedRate, SurvivesMissingSamplesOfAWheel) {
  drive(0.5, 0, 2000);
  SensorFrame missing = robot_.frame();
  for (int i = 0; i < 20; ++i) {
    robot_.drive(0.5, 0);
    missing = robot_.frame();
    missing.joints[0].position = std::nan("");
    missing.joints[1].position = 1e9;
    estimator_.step(missing, state_);
    ASSERT_NEAR(state_.joint_velocity[0], 5, 1e-3);
    ASSERT_NEAR(state_.joint_velocity[1], 5, 1e-3);
  }
  drive(0.5, 0, 1);
  EXPECT_NEAR(state_.joint_velocity[0], 5, 0.05);
}

}  // namespace robot_control::tests
