// Tests the tilt of the body and the bias of the accelerometer, from rests, the gyro between them, and the wheels'
// acceleration.

#include "estimation/common/tilt/tilt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "signals/rotation.h"

namespace robot_control::tests {

constexpr double kTiltStep = 0.01;  // s
constexpr double kAllowedTilt =
    0.5 * std::numbers::pi / 180;  // rad: largest error that a failed sensor may leave behind a rest

/// Gravity on a robot that stands with its nose down by `pitch`.
Vector3 gravity(double pitch) {
  return {-kGravity * std::sin(pitch), 0, kGravity * std::cos(pitch)};
}

/// The robot stands on level ground; its accelerometer has a bias of 0.3 m/s².
constexpr double kForceBias = 0.3;
constexpr Vector3 kBiased{kForceBias, 0, kGravity};

/// Stands for two seconds; `force` m/s²: the reading of the accelerometer.
void stand(Tilt& tilt, const Vector3& force) {
  for (int i = 0; i < 4; ++i) tilt.rest(force, 0.5);
}

Quaternion attitude(const Tilt& tilt) {
  const Eigen::Quaterniond q = tilt.attitude();
  return {q.x(), q.y(), q.z(), q.w()};
}

/// Makes half a turn.
void turn_back(Tilt& tilt) {
  constexpr int kTurn = 628;
  for (int i = 0; i < kTurn; ++i) tilt.turn({0, 0, std::numbers::pi / kTurn / kTiltStep}, kTiltStep);
}

TEST(TiltTest, IsBoundedHoweverTheGyroTurns) {
  Tilt tilt;
  for (int i = 0; i < 10000; ++i) {
    tilt.turn({3.0, -2.0, 1.0}, kTiltStep);
    ASSERT_LE(std::hypot(tilt.up()[0], tilt.up()[1]), Tuning::kSteepest + 1e-9);
    ASSERT_GT(tilt.up()[2], 0);
  }
}

// A rest shows tilt and bias together. After half a turn they are apart by twice the bias.
TEST(TiltTest, ABiasThatARestTookForTiltIsUnknownAgainInATurn) {
  constexpr TiltParams kParams;
  Tilt tilt(kParams);
  stand(tilt, kBiased);
  EXPECT_LT(std::sqrt(tilt.acceleration_variance(0)), 0.1 * kParams.bias);
  turn_back(tilt);
  tilt.age();
  EXPECT_NEAR(std::sqrt(tilt.acceleration_variance(0)), 2 * kParams.bias, 0.1 * kParams.bias);
}

TEST(TiltTest, IsBoundedHoweverTheAccelerometerCorrectsIt) {
  Tilt tilt;
  for (int i = 0; i < 1000; ++i) {
    tilt.turn({}, kTiltStep);
    tilt.correct(8.0, -9.0, 1.0, 1e-3);
    ASSERT_LE(std::hypot(tilt.up()[0], tilt.up()[1]), Tuning::kSteepest + 1e-9);
    ASSERT_GT(tilt.up()[2], 0);
  }
}

TEST(TiltTest, ItsVarianceIsBoundedHoweverLongNothingCorrectsIt) {
  Tilt tilt;
  for (int i = 0; i < 100000; ++i) {
    tilt.turn({}, 10.0);
    if (i % 100 == 0) tilt.correct(0, 0, 1.0, 1e6);
  }
  for (const int axis : {0, 1}) EXPECT_LE(tilt.covariance(axis, axis), Tuning::kSteepest * Tuning::kSteepest);
}

// The bias takes the share of its own variance of a first rest: 0.0004 of 0.0104.
TEST(TiltTest, IsThatOfGravityButForTheShareThatTheBiasMayHave) {
  Tilt tilt;
  tilt.rest(gravity(0.05), 0.5);
  EXPECT_NEAR(pitch_of(attitude(tilt)), 0.05, 0.05 * 0.05);
  EXPECT_NEAR(roll_of(attitude(tilt)), 0, 1e-12);
}

TEST(TiltTest, AForceThatIsNotGravityIsNoRest) {
  Tilt tilt;
  for (const double force : {0.0, 0.4 * kGravity, 2.1 * kGravity}) tilt.rest({force, 0, 0}, 0.5);
  EXPECT_EQ(tilt.up(), (Vector3{0, 0, 1}));
}

TEST(TiltTest, RestsInTwoHeadingsSeparateBiasFromTilt) {
  Tilt tilt;
  stand(tilt, kBiased);
  EXPECT_NEAR(tilt.up()[0], kForceBias / kGravity, 0.1 * kForceBias / kGravity) << "taken for a slope";
  turn_back(tilt);
  stand(tilt, kBiased);
  EXPECT_NEAR(tilt.up()[0], 0, kAllowedTilt);
  EXPECT_NEAR(tilt.bias(0), kForceBias, 0.1 * kForceBias);
}

// The robot leaves a slope of 0.1 rad and comes back to it turned by 180°: gravity turns, the bias does not.
TEST(TiltTest, SeparatesTheTwoOnASlopeToo) {
  Tilt tilt;
  Vector3 uphill = gravity(-0.1);
  Vector3 downhill = gravity(0.1);
  uphill[0] += kForceBias;
  downhill[0] += kForceBias;
  stand(tilt, uphill);
  for (int i = 0; i < 628; ++i) {  // about the slope's normal
    tilt.turn({0, 1e-4 * (i % 2), std::numbers::pi / 6.28}, kTiltStep);
  }
  stand(tilt, downhill);
  EXPECT_NEAR(pitch_of(attitude(tilt)), 0.1, kAllowedTilt);
  EXPECT_NEAR(tilt.bias(0), kForceBias, 0.1 * kForceBias);
}

// The gyro measured that the next place slopes down by 0.1 rad: the floor is not plane, and this is no bias either.
TEST(TiltTest, WhatTheGyroMeasuredIsASlope) {
  Tilt tilt;
  stand(tilt, gravity(0));
  for (int i = 0; i < 100; ++i) tilt.turn({0, 0.1 + 1e-3 * (i % 2), 0}, kTiltStep);
  stand(tilt, gravity(0.1));
  EXPECT_NEAR(pitch_of(attitude(tilt)), 0.1, kAllowedTilt);
  EXPECT_NEAR(tilt.bias(0), 0, 0.05);
}

// A broken gyro did not measure a slope of 0.2 rad; rests in two headings gave the bias.
TEST(TiltTest, ARestThatContradictsGyroAndFloorOpensTheTiltAndLeavesTheBias) {
  Tilt tilt;
  stand(tilt, kBiased);
  turn_back(tilt);
  stand(tilt, kBiased);
  const Vector3 slope = gravity(0.2);
  stand(tilt, {slope[0] + kForceBias, slope[1], slope[2]});
  EXPECT_NEAR(pitch_of(attitude(tilt)), 0.2, kAllowedTilt);
  EXPECT_NEAR(tilt.bias(0), kForceBias, 0.1 * kForceBias);
}

// It drives onto a slope of 0.05 rad without a trusted gyro: the wheels' acceleration finds the slope.
TEST(TiltTest, TheErrorOfGravityTurnsIt) {
  Tilt tilt;
  stand(tilt, gravity(0));
  for (int i = 0; i < 30000; ++i) {
    tilt.turn({}, kTiltStep);
    if (i % 40 != 0) continue;
    const double along = gravity(0.05)[0] - kGravity * tilt.up()[0] - tilt.bias(0);
    tilt.correct(along, 0, 0.4, 0.05);
  }
  EXPECT_NEAR(pitch_of(attitude(tilt)), 0.05, kAllowedTilt);
}

TEST(TiltTest, IsSetToThatOfAnEarlierProcess) {
  Tilt tilt;
  const double up = std::sqrt(1 - 0.1 * 0.1 - 0.05 * 0.05);
  tilt.set({0.1, -0.05, up}, {0.2, -0.3});
  EXPECT_NEAR(tilt.up()[0], 0.1, 1e-12);
  EXPECT_NEAR(tilt.up()[1], -0.05, 1e-12);
  EXPECT_NEAR(tilt.bias(0), 0.2, 1e-12);
  EXPECT_NEAR(tilt.bias(1), -0.3, 1e-12);
  EXPECT_NEAR(pitch_of(attitude(tilt)), std::asin(-0.1), 1e-12);
  EXPECT_NEAR(roll_of(attitude(tilt)), std::atan2(-0.05, up), 1e-12);
  EXPECT_NEAR(yaw_of(attitude(tilt)), 0, 1e-12);
  const auto acceleration = tilt.acceleration({kGravity * 0.1 + 0.2 + 0.5, -kGravity * 0.05 - 0.3 - 0.25, 0});
  EXPECT_NEAR(acceleration[0], 0.5, 1e-12);
  EXPECT_NEAR(acceleration[1], -0.25, 1e-12);
}

TEST(TiltTest, WhatIsSetBeyondTheSteepestIsBounded) {
  Tilt tilt;
  tilt.set({0.9, 0, std::sqrt(1 - 0.81)}, {0, 0});
  EXPECT_NEAR(tilt.up()[0], Tuning::kSteepest, 1e-9);
}

}  // namespace robot_control::tests
