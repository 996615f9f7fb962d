#include "estimation/yaw_fusion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace robot_control {
namespace {

constexpr double kPeriod = 1e-3;

/// Healthy case: 0.5 m/s, 0.2 rad/s, both sources agree, the bias is known to 1e-3 rad/s.
class YawFusionTest : public testing::Test {
 protected:
  YawFusionTest() {
    sources_.turn_wheels = sources_.turn_gyro = 0.2 * kPeriod;
    sources_.travel = 2 * 0.5 * kPeriod;
    sources_.dt = kPeriod;
    sources_.bias_variance = 1e-6;
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) fusion_.step(sources_);
  }
  YawFusion fusion_{YawFusionParameters{}};
  YawSources sources_;
};

// q_w = (0.02 / 0.5)² · 1 = 1.6e-3, q_g = 1e-6 + 1e-6 · 0.2 + 1e-6 · 10 = 1.12e-5.
// After 10 s the smoothed speed is within e^-20 of 1 m/s.
TEST_F(YawFusionTest, WeighsByNoiseDensities) {
  run(10000);
  EXPECT_NEAR(fusion_.gain(), 1.6e-3 / (1.6e-3 + 1.12e-5), 1e-9);
}

TEST_F(YawFusionTest, FusedTurnLiesBetweenItsSources) {
  run(1000);
  sources_.turn_wheels = 0.21 * kPeriod;
  run(1);
  EXPECT_GT(fusion_.turn(), 0.2 * kPeriod);
  EXPECT_LT(fusion_.turn(), 0.21 * kPeriod);
}

TEST_F(YawFusionTest, AgreementIsFullConfidence) {
  run(1000);
  EXPECT_NEAR(fusion_.confidence(), 1, 1e-12);
  EXPECT_FALSE(fusion_.slip());
}

// q_w / (2 · 0.05) = 0.016: one standard deviation is 0.127 rad/s, three are 0.38.
TEST_F(YawFusionTest, ConfidenceFallsWithDisagreement) {
  run(5000);
  double last = 1.0;
  for (const double difference : {0.05, 0.1, 0.2, 0.3}) {
    sources_.turn_wheels = (0.2 + difference) * kPeriod;
    run(1000);
    EXPECT_LT(fusion_.confidence(), last) << difference;
    EXPECT_FALSE(fusion_.slip()) << difference;
    last = fusion_.confidence();
  }
  sources_.turn_wheels = (0.2 + 0.5) * kPeriod;
  run(1000);
  EXPECT_LT(fusion_.confidence(), std::exp(-4.5));
  EXPECT_TRUE(fusion_.slip());
}

TEST_F(YawFusionTest, SlipHandsYawToTheGyroAndGrowsTheWheelsVariance) {
  run(1000);
  const double agreed = fusion_.wheel_variance();
  sources_.turn_wheels = 1.2 * kPeriod;
  run(1000);
  EXPECT_NEAR(fusion_.turn(), 0.2 * kPeriod, 1e-6 * kPeriod * 1000);
  EXPECT_GT(fusion_.wheel_variance(), 10 * agreed);
}

TEST_F(YawFusionTest, RecoversWhenTheSlipEnds) {
  run(1000);
  sources_.turn_wheels = 1.2 * kPeriod;
  run(1000);
  sources_.turn_wheels = 0.2 * kPeriod;
  run(1000);
  EXPECT_FALSE(fusion_.slip());
  EXPECT_NEAR(fusion_.confidence(), 1, 1e-9);
}

TEST_F(YawFusionTest, WithoutGyroTheWheelsTurnAlone) {
  sources_.gyro = false;
  sources_.turn_gyro = 1e9;
  run(10);
  EXPECT_EQ(fusion_.turn(), sources_.turn_wheels);
  EXPECT_EQ(fusion_.gain(), 0);
}

TEST_F(YawFusionTest, KnownStandstillIgnoresTheGyro) {
  sources_.turn_wheels = sources_.travel = 0;
  sources_.standing = true;
  run(10);
  EXPECT_EQ(fusion_.turn(), 0);
}

TEST_F(YawFusionTest, UnknownBiasLeavesYawToTheWheels) {
  sources_.bias_variance = 0.05 * 0.05;
  run(1000);
  EXPECT_LT(fusion_.gain(), 0.1);
}

// Every tenth cycle a count: weighting each cycle by its own travel would lose the gyro's turn of the other nine.
TEST_F(YawFusionTest, EncoderCountsDoNotBiasASlowTurn) {
  const double rate = 0.02;
  double turned = 0;
  for (int i = 1; i <= 20000; ++i) {
    const bool count = i % 10 == 0;
    sources_.turn_wheels = count ? 10 * rate * kPeriod : 0;
    sources_.travel = count ? 0.001 : 0;
    sources_.turn_gyro = rate * kPeriod;
    fusion_.step(sources_);
    turned += fusion_.turn();
  }
  EXPECT_NEAR(turned, rate * 20, 1e-3 * rate * 20);
}

TEST_F(YawFusionTest, RotatedByHandWithHeldWheelsTheGyroLeads) {
  run(1000);
  sources_.turn_wheels = sources_.travel = 0;
  sources_.turn_gyro = 1.0 * kPeriod;
  run(2000);
  EXPECT_TRUE(fusion_.slip());
  EXPECT_NEAR(fusion_.turn(), 1.0 * kPeriod, 1e-3 * kPeriod);
}

}  // namespace
}  // namespace robot_control
