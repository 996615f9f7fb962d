#include "safety/measurements/wheel_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "safety/measurements/joint_standstill.h"
#include "support/constants.h"

namespace robot_control::tests {

constexpr std::uint64_t kSpeedWindow = 20;  // cycles
constexpr double kAngleRounding = 1e-9;     // of angles of some rad, over 20 ms

/// One wheel with an encoder.
struct WheelMotionTest : testing::Test {
  WheelMotionTest() {
    set_joints_valid(sensors_, kValidMotion);
    sensors_.joint_count = 1;
  }
  void step(double angle, std::uint64_t elapsed = 1) {
    sensors_.head.cycle += elapsed;
    sensors_.joints[0].position = counts_ > 0 ? quantum() * std::floor(angle / quantum()) : angle;
    motion_.step(sensors_);
    standstill_.step(motion_, sensors_.head.cycle);
  }
  /// Turns at `speed` rad/s for `cycles`.
  void turn(double speed, std::uint64_t cycles) {
    for (std::uint64_t i = 0; i < cycles; ++i) step(angle_ += speed * kPeriod);
  }
  double quantum() const { return 2 * std::numbers::pi / counts_; }

  double counts_ = 0;
  double angle_ = 0;
  SensorFrame sensors_;
  WheelMotion motion_{1, kPeriod};
  JointStandstill standstill_{0.05, kPeriod};
};

TEST_F(WheelMotionTest, IsKnownAfterOneWindowAndItsAccelerationAfterTwo) {
  turn(3, kSpeedWindow);
  EXPECT_FALSE(motion_.speed_known());
  turn(3, 1);
  EXPECT_TRUE(motion_.speed_known());
  EXPECT_FALSE(motion_.acceleration_known());
  turn(3, kSpeedWindow);
  EXPECT_TRUE(motion_.acceleration_known());
  EXPECT_NEAR(motion_.speed(0), 3, kAngleRounding);
  EXPECT_NEAR(motion_.acceleration(0), 0, kAngleRounding / 0.02);
}

TEST_F(WheelMotionTest, MeasuresASteadyAcceleration) {
  double speed = 0;
  for (int i = 0; i < 100; ++i) turn(speed += 8 * kPeriod, 1);
  EXPECT_NEAR(motion_.acceleration(0), 8, kAngleRounding / 0.0004);
  EXPECT_NEAR(motion_.speed(0), speed - 8 * 0.0095, kAngleRounding) << "the mean of 20 steps is 9.5 steps old";
}

TEST_F(WheelMotionTest, ASpeedOfCountsIsWithinItsTolerance) {
  for (const double counts : {64.0, 4096.0}) {
    counts_ = counts;
    motion_.enter_run();
    turn(0.3, 5000);
    EXPECT_NEAR(motion_.quantum(0), quantum(), 1e-9);
    EXPECT_NEAR(motion_.speed_tolerance(0), quantum() / 0.02, 1e-6);
    for (int i = 0; i < 2000; ++i) {
      turn(0.3, 1);
      ASSERT_LE(std::abs(motion_.speed(0) - 0.3), motion_.speed_tolerance(0) + kAngleRounding);
      ASSERT_LE(std::abs(motion_.acceleration(0)), motion_.acceleration_tolerance(0) + kAngleRounding / 0.0004);
    }
  }
}

// 10 rad/s of 4096 counts at 100 Hz are 65 or 66 counts a cycle: never a single one.
TEST_F(WheelMotionTest, FindsTheQuantumOfAWheelThatAlreadyTurns) {
  counts_ = 4096;
  motion_ = WheelMotion(1, 0.01);
  for (int i = 0; i < 200; ++i) step(angle_ += 0.1);
  EXPECT_NEAR(motion_.quantum(0), quantum(), 1e-9);
}

TEST_F(WheelMotionTest, AnExactEncoderNeedsNoTolerance) {
  double speed = 0;
  for (int i = 0; i < 2000; ++i) turn(speed += 1e-6, 1);
  EXPECT_LT(motion_.speed_tolerance(0), 1e-3);
}

TEST_F(WheelMotionTest, SkippedCyclesMakeTheWindowLongerNotTheSpeedWrong) {
  for (int i = 0; i < 50; ++i) step(angle_ += 7 * 3 * kPeriod, 7);
  EXPECT_TRUE(motion_.speed_known());
  EXPECT_NEAR(motion_.speed(0), 3, kAngleRounding);
  EXPECT_NEAR(motion_.acceleration(0), 0, kAngleRounding / 0.0004);
}

TEST_F(WheelMotionTest, KnowsNothingAfterAGapOfMoreThanTwoWindows) {
  turn(3, 50);
  step(angle_ += 0.3, 41);
  EXPECT_FALSE(motion_.speed_known());
}

TEST_F(WheelMotionTest, ASampleThatIsMissingOrNotFiniteIsNone) {
  turn(3, 50);
  step(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(motion_.sampled());
  EXPECT_FALSE(motion_.speed_known());
  angle_ += 3 * kPeriod;
  set_joints_valid(sensors_, 0);
  turn(3, 1);
  EXPECT_FALSE(motion_.sampled());
  set_joints_valid(sensors_, kValidMotion);
  turn(3, 1);
  EXPECT_NEAR(motion_.speed(0), 3, kAngleRounding);
}

// Standstill.

TEST_F(WheelMotionTest, StandsAfterItsTimeAndIsNeitherBefore) {
  turn(0, 100);
  EXPECT_FALSE(standstill_.standing());
  EXPECT_FALSE(standstill_.moving());
  turn(0, 1);
  EXPECT_TRUE(standstill_.standing());
}

TEST_F(WheelMotionTest, ACreepBelowTheStandstillSpeedStands) {
  counts_ = 4096;
  turn(0.03, 5000);
  for (int i = 0; i < 2000; ++i) {
    turn(0.03, 1);
    ASSERT_TRUE(standstill_.standing());
  }
}

TEST_F(WheelMotionTest, AWheelThatSwingsAboutItsRestMoves) {
  turn(0, 200);
  std::uint64_t moving = 0;
  for (int i = 0; i < 2000; ++i) {  // ±30 mrad at 2 Hz: 0 rad/s on average
    step(0.03 * std::sin(2 * std::numbers::pi * 2 * i * kPeriod));
    moving += standstill_.moving() ? 1 : 0;
  }
  EXPECT_GT(moving, 1900u);
  EXPECT_FALSE(standstill_.standing());
}

TEST_F(WheelMotionTest, ACoarseCountAtTheEdgeIsNoMotion) {
  counts_ = 64;
  turn(0.5, 1000);
  turn(0, 200);
  ASSERT_TRUE(standstill_.standing());
  const double edge = quantum() * std::ceil(angle_ / quantum());
  for (int i = 0; i < 1000; ++i) {
    step(edge + (i % 3 == 0 ? 1e-6 : -1e-6));
    ASSERT_TRUE(standstill_.standing());
  }
}

}  // namespace robot_control::tests
