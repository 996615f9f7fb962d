/// Tests the vertical from gyro and accelerometer at 1 kHz. The healthy case is upright, at rest, and initialised.

#include "safety/measurements/attitude.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "machine/gravity.h"

namespace robot_control::tests {

using Eigen::Vector3d;

constexpr double kStep = 1e-3;  // s
constexpr double kSmall = 1e-12;
constexpr double kTime = Attitude::kTimeConstant;

struct AttitudeTest : testing::Test {
  AttitudeTest() { step({0, 0, 0}, rest()); }

  static Vector3d rest() { return {0, 0, kGravity}; }
  void step(const Vector3d& rate, const Vector3d& force) { attitude_.step(&rate, &force, kStep); }
  void steps(int count, const Vector3d& rate, const Vector3d& force) {
    for (int i = 0; i < count; ++i) step(rate, force);
  }

  Attitude attitude_;
};

TEST_F(AttitudeTest, IsUprightAtRest) {
  steps(1000, {0, 0, 0}, rest());
  EXPECT_TRUE(attitude_.known());
  EXPECT_NEAR(attitude_.tilt(), 0, kSmall);
}

// No device sends such numbers on purpose, but a broken one may: their squares overflow.
TEST_F(AttitudeTest, IsANumberWhateverFiniteNumbersCome) {
  for (const double absurd : {1e160, -1e300}) {
    step({absurd, absurd, 0}, {absurd, 0, -absurd});
    EXPECT_TRUE(std::isfinite(attitude_.tilt())) << absurd;
    EXPECT_TRUE(std::isfinite(attitude_.tilt_rate())) << absurd;
    EXPECT_NEAR(attitude_.up().norm(), 1, kSmall) << absurd;
  }
  // The force that the caller subtracts may be infinite, too, and then nothing is left.
  const double infinite = std::numeric_limits<double>::infinity();
  step({0, 0, 0}, {infinite, 0, infinite - infinite});
  EXPECT_NEAR(attitude_.tilt(), 0, kSmall);
}

TEST_F(AttitudeTest, IsNotKnownBeforeTheFirstSample) {
  Attitude fresh;
  EXPECT_FALSE(fresh.known());
  const Vector3d rate(0, 0, 1);
  fresh.step(&rate, nullptr, kStep);
  EXPECT_FALSE(fresh.known());
}

TEST_F(AttitudeTest, BeginsAtTheFirstSample) {
  Attitude fresh;
  const Vector3d rate(0, 0, 0), leaning = kGravity * Vector3d(std::sin(0.3), 0, std::cos(0.3));
  fresh.step(&rate, &leaning, kStep);
  EXPECT_TRUE(fresh.known());
  EXPECT_NEAR(fresh.tilt(), 0.3, kSmall);
}

TEST_F(AttitudeTest, DoesNotBeginWithAShock) {
  Attitude fresh;
  const Vector3d rate(0, 0, 0), shock(30, 0, kGravity);
  fresh.step(&rate, &shock, kStep);
  EXPECT_FALSE(fresh.known());
}

TEST_F(AttitudeTest, IsSurelyWithinNoAngleThatTheTiltExceeds) {
  for (const double lean : {0.0, 1e-7, 0.1, 0.5, 1.5, 1.7, 3.0}) {
    Attitude leans;
    const Vector3d rate(0, 0, 0), force = kGravity * Vector3d(std::sin(lean), 0, std::cos(lean));
    leans.step(&rate, &force, kStep);
    for (double angle = 0; angle < 3.2; angle += 0.01) {
      EXPECT_FALSE(leans.surely_within(angle) && leans.tilt() > angle) << lean << ' ' << angle;
    }
  }
  EXPECT_TRUE(attitude_.surely_within(0.01));
}

TEST_F(AttitudeTest, FollowsATiltingBody) {
  for (int i = 1; i <= 500; ++i) {  // nose up about −y: up leans to +x, so does the specific force
    const double angle = 0.6 * kStep * i;
    step({0, -0.6, 0}, kGravity * Vector3d(std::sin(angle), 0, std::cos(angle)));
    ASSERT_NEAR(attitude_.tilt(), angle, 1e-9);
    ASSERT_NEAR(attitude_.tilt_rate(), 0.6, 1e-9);
  }
}

TEST_F(AttitudeTest, RatesOfTiltHaveASign) {
  const Vector3d leaning = kGravity * Vector3d(0, std::sin(0.2), std::cos(0.2));
  Attitude leans;
  const Vector3d forth(0.5, 0, 0), back(-0.5, 0, 0), still(0, 0, 0);
  leans.step(&still, &leaning, kStep);
  leans.step(&forth, &leaning, kStep);  // the left side, +y, rises: up leans to it
  EXPECT_NEAR(leans.tilt_rate(), 0.5, kSmall);
  leans.step(&back, &leaning, kStep);
  EXPECT_NEAR(leans.tilt_rate(), -0.5, kSmall);
}

TEST_F(AttitudeTest, TurningOnTheSpotChangesNothing) {
  steps(5000, {0, 0, 2}, rest());
  EXPECT_NEAR(attitude_.tilt(), 0, kSmall);
  EXPECT_EQ(attitude_.tilt_rate(), 0);
}

// The tilt of a leaning body that turns about the vertical stays.
TEST_F(AttitudeTest, TurningAboutTheVerticalKeepsTheTilt) {
  const Eigen::AngleAxisd lean(0.3, Vector3d::UnitX());
  Attitude leans;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Matrix3d to_world = Eigen::AngleAxisd(2 * kStep * i, Vector3d::UnitZ()) * lean.toRotationMatrix();
    const Vector3d rate = to_world.transpose() * Vector3d(0, 0, 2), force = to_world.transpose() * rest();
    leans.step(&rate, &force, kStep);
    ASSERT_NEAR(leans.tilt(), 0.3, 1e-9);
    ASSERT_NEAR(leans.tilt_rate(), 0, 1e-9);
  }
}

// Steady state: carried by b dt a step, pulled back by tilt · dt/T.
TEST_F(AttitudeTest, ErrsByBiasTimesTimeConstant) {
  steps(20000, {0.05, 0, 0}, rest());
  EXPECT_NEAR(attitude_.tilt(), std::atan(0.05 * kTime), 2e-4) << "tan or sine: a third of the cube";
}

// The error is (A/g)·(1 − e^{−t/T}) for small angles, to a hundredth.
TEST_F(AttitudeTest, ErrsLittleInAnAcceleration) {
  steps(1000, {0, 0, 0}, {1, 0, kGravity});
  const double expected = std::atan(1 / kGravity) * (1 - std::exp(-1 / kTime));
  EXPECT_NEAR(attitude_.tilt(), expected, 0.01 * expected);
  EXPECT_LT(attitude_.tilt(), 0.0505) << "as promised";
}

TEST_F(AttitudeTest, IgnoresAHardBrake) {
  steps(200, {0, 0, 0}, {-5, 0, kGravity});
  EXPECT_NEAR(attitude_.tilt(), 0, kSmall);
  EXPECT_TRUE(attitude_.known());
}

TEST_F(AttitudeTest, LivesOnTheAccelerometerWithoutAGyro) {
  const Vector3d leaning = kGravity * Vector3d(std::sin(0.3), 0, std::cos(0.3));
  for (int i = 0; i < 3000; ++i) attitude_.step(nullptr, &leaning, kStep);
  // The rest of 0.3 rad after 2 T, on the chord, is within a percent of the arc.
  EXPECT_NEAR(attitude_.tilt(), 0.3 * (1 - std::exp(-3 / kTime)), 0.003);
  EXPECT_EQ(attitude_.tilt_rate(), 0);
}

TEST_F(AttitudeTest, IsNotKnownForLongWithoutAnAccelerometer) {
  const Vector3d rate(0.05, 0, 0);
  const int trusted = static_cast<int>(std::lround(Attitude::kTrustTime / kStep));
  for (int i = 0; i < trusted - 1; ++i) attitude_.step(&rate, nullptr, kStep);
  EXPECT_TRUE(attitude_.known());
  EXPECT_NEAR(attitude_.tilt(), 0.05 * (Attitude::kTrustTime - kStep), 1e-9);
  for (int i = 0; i < 3; ++i) attitude_.step(&rate, nullptr, kStep);
  EXPECT_FALSE(attitude_.known());
  step({0, 0, 0}, rest());
  EXPECT_TRUE(attitude_.known());
  EXPECT_NEAR(attitude_.tilt(), 0, kSmall) << "restarts";
}

TEST_F(AttitudeTest, KnowsUpsideDown) {
  Attitude upside_down;
  const Vector3d rate(0, 0, 0), force(0, 0, -kGravity);
  upside_down.step(&rate, &force, kStep);
  EXPECT_NEAR(upside_down.tilt(), M_PI, kSmall);
  const Vector3d up = rest();
  for (int i = 0; i < 20000; ++i) upside_down.step(&rate, &up, kStep);
  EXPECT_TRUE(std::isfinite(upside_down.tilt()));
}

TEST_F(AttitudeTest, SpeaksTheSameAtAnyRate) {
  Attitude slow;
  const Vector3d rate(0.3, -0.4, 1), force(0.5, 0.2, kGravity);
  const Vector3d still(0, 0, 0), up = rest();
  slow.step(&still, &up, 0.01);
  for (int i = 0; i < 50; ++i) slow.step(&rate, &force, 0.01);
  steps(500, rate, force);
  EXPECT_NEAR((slow.up() - attitude_.up()).norm(), 0, 2e-3) << "half a long step of 0.4 rad/s";
}

/// A trot: the body is thrown up and falls, and its acceleration along the ground changes with that. Its gyro has a
/// bias.
double tilt_in_a_trot(Attitude attitude) {
  constexpr double kPeriod = 0.19, kPi = 3.14159265358979323846;  // s, of a step
  const Vector3d bias(0, 0.05, 0);
  for (int i = 0; i < 20'000; ++i) {
    const double phase = 2 * kPi * kStep * i / kPeriod;
    const Vector3d force(-1.5 * std::sin(phase), 0, kGravity + 6 * std::cos(phase));
    attitude.step(&bias, &force, kStep);
  }
  return attitude.tilt();
}

TEST_F(AttitudeTest, IsPulledByTheMeanForceOfABodyOnLegs) {
  EXPECT_LT(tilt_in_a_trot(Attitude(0.3)), 0.05 * kTime + 0.02);
  EXPECT_GT(tilt_in_a_trot(Attitude()), 0.25);
}

TEST_F(AttitudeTest, TheMeanForceTurnsWithTheGyro) {
  Attitude turns(0.3);
  const Vector3d still = Vector3d::Zero(), rate(1, 0, 0);
  const Vector3d upright = rest();
  for (int i = 0; i < 1000; ++i) turns.step(&still, &upright, kStep);
  for (int i = 0; i < 500; ++i) {
    const Vector3d force = Eigen::AngleAxisd(-kStep * (i + 1), Vector3d::UnitX()) * upright;
    turns.step(&rate, &force, kStep);
  }
  EXPECT_NEAR(turns.tilt(), 0.5, 1e-6);
}

TEST_F(AttitudeTest, AForceThatNoAccelerometerMeasuresDoesNotEnterTheMean) {
  Attitude attitude(0.3);
  const Vector3d still = Vector3d::Zero(), upright = rest(), huge(1e300, 0, 0);
  for (int i = 0; i < 1000; ++i) attitude.step(&still, i == 500 ? &huge : &upright, kStep);
  EXPECT_TRUE(attitude.known());
  EXPECT_NEAR(attitude.tilt(), 0, kSmall);
}

}  // namespace robot_control::tests
