// The plain odometer beside the full law: bias and rest, track, tilt.

#include "estimation/simple/simple_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

namespace robot_control {
namespace {

constexpr double kTick = 0.01;  // s

static_assert(std::is_trivially_copyable_v<SimplePart>);  // a snapshot of it is a copy of its bytes

class RestBiasTest : public testing::Test {
 protected:
  void go(double seconds, double gyro, double travel = 0) {
    for (double t = 0; t < seconds - kTick / 2; t += kTick) {
      rest_.step({.dt = kTick, .gyro = Vector3{0, 0, gyro}, .accelerometer = {}, .left = travel, .right = travel});
    }
  }
  RestBias rest_{RestBiasParams{}};
};

TEST_F(RestBiasTest, OfARunThatBeginsAtRestIsTheMeanFromTheFirstSampleOn) {
  go(RestBias::kWindow, 0.0200);
  EXPECT_FALSE(rest_.resting());
  go(RestBias::kWindow, 0.0204);
  EXPECT_TRUE(rest_.resting());
  EXPECT_NEAR(rest_.bias()[2], 0.0202, 1e-5);
}

TEST_F(RestBiasTest, LeavesOutTheFirstWindowAfterAStop) {
  go(1.0, 0.5, 0.005);
  go(RestBias::kWindow, 0.028);  // the body still rocks
  go(3 * RestBias::kWindow, 0.02);
  EXPECT_NEAR(rest_.bias()[2], 0.02, 1e-4);
}

TEST_F(RestBiasTest, LearnsNothingWhileTheWheelsTurn) {
  go(10.0, 0.3, 0.001);
  EXPECT_FALSE(rest_.learned());
  EXPECT_EQ(rest_.bias()[2], 0);
}

TEST_F(RestBiasTest, ATurnOnWheelsThatStandIsNoRestUntilItLastsTenSeconds) {
  go(2.0, 0.0);
  go(9.0, 0.2);
  EXPECT_NEAR(rest_.bias()[2], 0, 1e-6);
  EXPECT_FALSE(rest_.resting());
  go(4.0, 0.2);
  EXPECT_NEAR(rest_.bias()[2], 0.2, 1e-3);
  EXPECT_TRUE(rest_.resting());
}

// Straight on for s metres in T seconds: σ_yaw² = b² T² + n² T, and across the way b² (s T)²/4 + n² s² T/3.
TEST(PlanarTrackTest, CovarianceIsThatOfTheClosedForm) {
  constexpr double kBias = 0.01;
  constexpr double kSeconds = 20;
  constexpr double kWay = 10;
  const PlanarNoise noise{.gyro = 1e-2, .scale = 0, .slip = 0, .turn = 0};
  PlanarTrack track(noise);
  track.place({}, {}, kBias * kBias);
  const int steps = static_cast<int>(kSeconds / kTick);
  for (int i = 0; i < steps; ++i) {
    track.turn(0, kTick, true);
    track.roll(kWay / steps, 0);
  }
  const double drift = kBias * kBias;
  const double white = noise.gyro * noise.gyro;
  const PlanarCovariance& p = track.covariance();
  EXPECT_NEAR(p.ww, drift * kSeconds * kSeconds + white * kSeconds, 1e-3 * p.ww);
  EXPECT_NEAR(p.yy, drift * kWay * kWay * kSeconds * kSeconds / 4 + white * kWay * kWay * kSeconds / 3, 5e-3 * p.yy);
  EXPECT_NEAR(p.xx, 0, 1e-12);
}

TEST(PlanarTrackTest, ABiasThatBecomesKnownLeavesAValidCovariance) {
  PlanarTrack track{PlanarNoise{}};
  track.place({}, {}, 0.05 * 0.05);
  for (int i = 0; i < 1000; ++i) {
    track.turn(0, kTick, true);
    track.roll(0.005, 0);
  }
  track.learn_bias(1e-8);
  for (int i = 0; i < 1000; ++i) {
    track.turn(0, kTick, true);
    track.roll(0.005, 0);
  }
  const PlanarCovariance& p = track.covariance();
  EXPECT_GE(p.ww * p.bb, p.wb * p.wb);
  EXPECT_GE(p.yy * p.ww, p.yw * p.yw);
  EXPECT_GE(p.yy * p.bb, p.yb * p.yb);
}

TEST(TiltTest, IsBoundedHoweverTheGyroTurns) {
  Tilt tilt;
  for (int i = 0; i < 10000; ++i) {
    tilt.turn({3.0, -2.0, 1.0}, kTick);
    ASSERT_LE(std::hypot(tilt.up()[0], tilt.up()[1]), Tilt::kSteepest + 1e-9);
    ASSERT_GT(tilt.up()[2], 0);
  }
}

TEST(TiltTest, IsThatOfGravityAfterASecondOfRest) {
  Tilt tilt;
  for (int i = 0; i < 100; ++i) tilt.turn({0, 1.0, 0}, kTick);
  const Vector3 force{-Tilt::kGravity * std::sin(0.1), 0, Tilt::kGravity * std::cos(0.1)};
  tilt.rest(force, 0.5, 0.5);
  EXPECT_NEAR(tilt.pitch(), 0.1, 1e-6);
}

class SimplePartTest : public testing::Test {
 protected:
  static WheelGeometry geometry() {
    RobotModel robot;
    robot.wheel_base = 0.5;
    robot.wheels = {WheelModel{.radius = 0.1}};
    return WheelGeometry(robot);
  }
  /// Both sides at 0.5 m/s ∓ base/2 · rate.
  void drive(double seconds, double rate, bool left = true, bool gyro = true) {
    for (double t = 0; t < seconds - kTick / 2; t += kTick) {
      SimplePart::Input input;
      input.dt = kTick;
      if (gyro) input.gyro = Vector3{0, 0, rate};
      if (gyro) input.sample = rate;
      input.travel = {left ? (0.5 - 0.25 * rate) * kTick : 0, (0.5 + 0.25 * rate) * kTick};
      input.received = {left, true};
      input.lost = {!left, false};
      input.speed = 0.5;
      part_.step(input);
    }
  }
  const PlanarPose& pose() const { return part_.track(SimplePart::kLong).pose(); }
  SimplePart part_{SimplePartParams{}, geometry()};
};

TEST_F(SimplePartTest, DrivesTheCircleThatGyroAndWheelsSay) {
  drive(5.0, 0.4);  // 2 rad on a radius of 1.25 m
  EXPECT_NEAR(pose().yaw, 2.0, 1e-9);
  EXPECT_NEAR(pose().x, 1.25 * std::sin(2.0), 1e-5);
  EXPECT_NEAR(pose().y, 1.25 * (1 - std::cos(2.0)), 1e-5);
}

TEST_F(SimplePartTest, OneEncoderAndTheGyroAreEnough) {
  drive(5.0, 0.4, false);
  EXPECT_NEAR(pose().x, 1.25 * std::sin(2.0), 1e-5);
  EXPECT_NEAR(pose().y, 1.25 * (1 - std::cos(2.0)), 1e-5);
}

TEST_F(SimplePartTest, WithoutGyroTheWheelsTurnIt) {
  drive(5.0, 0.4, true, false);
  EXPECT_NEAR(pose().yaw, 2.0, 1e-9);
}

// Between two samples 0.1 s apart in a steady turn the line is the truth; the wheels' base is wrong by a factor of 2.
TEST_F(SimplePartTest, AShortGapOfTheGyroIsALine) {
  drive(1.0, 0.4);
  SimplePart::Input input;
  input.dt = kTick;
  input.received = {true, true};
  input.travel = {(0.5 - 0.125 * 0.4) * kTick, (0.5 + 0.125 * 0.4) * kTick};
  for (int i = 0; i < 9; ++i) part_.step(input);
  input.gyro = Vector3{0, 0, 0.4};
  input.sample = 0.4;
  part_.step(input);
  EXPECT_NEAR(pose().yaw, 0.44, 1e-9);
}

}  // namespace
}  // namespace robot_control
