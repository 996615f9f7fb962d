/// The tyre's law alone, on a mass that slides on a plane: v' = v + (F + load)/m h.

#include "drivers/mujoco/contact/tyre.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/mujoco/constants.h"

namespace robot_control::tests {

constexpr double kMass = 0.5;        // kg
constexpr double kTyreRadius = 0.1;  // m
constexpr double kLoad = 50;         // N

struct TyreTest : testing::Test {
  /// Force in x, N, on a mass with the slip velocity velocity_.
  double step(double load, double rim_speed = 0) {
    TyreInput input;
    input.velocity.x() = velocity_;
    input.rim_speed = rim_speed;
    input.grip = grip_;
    const double force = step_tyre(tyre_, state_, input, kStep).force.x();
    velocity_ += (force + load) / kMass * kStep;
    position_ += velocity_ * kStep;
    return force;
  }
  double steps(int count, double load, double rim_speed = 0) {
    double force = 0;
    for (int i = 0; i < count; ++i) force = step(load, rim_speed);
    return force;
  }

  TyreParameters tyre_ = tyre_parameters(kMass, kTyreRadius, kLoad, kStep);
  TyreState state_;
  double grip_ = kLoad;
  double velocity_ = 0;
  double position_ = 0;
};

TEST_F(TyreTest, HasTheNumbersThatWereMeasured) {
  EXPECT_NEAR(tyre_.damping, 150, 1e-9);
  EXPECT_NEAR(tyre_.stiffness, 5e4, 1e-6);
  EXPECT_NEAR(tyre_.dead_band, 0.01, 1e-12);
  EXPECT_NEAR(tyre_.stiffness * tyre_.twist_lever * tyre_.twist_lever, 20, 1e-9);
}

TEST_F(TyreTest, RelaxesOverALongerWayUnderAHeavyRobotOnALightWheel) {
  const TyreParameters heavy = tyre_parameters(kMass, kTyreRadius, 5000, kStep);
  EXPECT_NEAR(heavy.stiffness * heavy.relaxation_length, 20 * 5000, 1e-6);
}

TEST_F(TyreTest, StandingIsASpring) {
  steps(1000, 20);
  EXPECT_NEAR(position_, 20 / tyre_.stiffness, 1e-9);
  EXPECT_NEAR(velocity_, 0, 1e-9);
  steps(60000, 20);
  EXPECT_NEAR(position_, 20 / tyre_.stiffness, 1e-9) << "no creep in a minute";
}

TEST_F(TyreTest, SlidingIsCoulombFriction) {
  velocity_ = 2;
  steps(5, 0);
  const double before = velocity_;
  steps(10, 0);
  EXPECT_NEAR((before - velocity_) / 0.01, grip_ / kMass, 1e-6 * grip_ / kMass);
}

TEST_F(TyreTest, FrictionOpposesTheSlipInThePlane) {
  TyreInput input;
  input.velocity = {0.6, -0.8, 0};
  input.grip = 1;
  Eigen::Vector3d force;
  for (int i = 0; i < 100; ++i) force = step_tyre(tyre_, state_, input, kStep).force;
  EXPECT_NEAR(force.x(), -0.6, 1e-9);
  EXPECT_NEAR(force.y(), 0.8, 1e-9);
  EXPECT_EQ(force.z(), 0);
}

TEST_F(TyreTest, GripsAgainWhenTheSlidingEnds) {
  velocity_ = 2;
  steps(2000, 0);
  EXPECT_NEAR(velocity_, 0, 1e-9);
  const double rest = position_;
  steps(10000, 0);
  EXPECT_NEAR(position_, rest, 1e-9);
}

// v = F / (k L/|u| + c), |u| less the dead band.
TEST_F(TyreTest, RollingUnderAForceItCreeps) {
  steps(5000, 10, 1);
  const double stiffness = tyre_.stiffness * tyre_.relaxation_length / (1 - tyre_.dead_band);
  EXPECT_NEAR(velocity_, 10 / (stiffness + tyre_.damping), 1e-9);
}

TEST_F(TyreTest, ARimThatHardlyTurnsDoesNotCreep) {
  steps(1000, 10, 0.009);
  const double rest = position_;
  steps(60000, 10, -0.009);
  EXPECT_NEAR(position_, rest, 1e-9);
}

TEST_F(TyreTest, TurnSlipIsBoundedByTheGripToo) {
  TyreInput input;
  input.turn_rate = 3;
  input.grip = kLoad;
  double torque = 0;
  for (int i = 0; i < 100; ++i) torque = step_tyre(tyre_, state_, input, kStep).torque;
  EXPECT_NEAR(torque, -kLoad * 0.01 * kTyreRadius, 1e-12);
}

TEST_F(TyreTest, HasNoForceWithoutANormalForce) {
  grip_ = 0;
  velocity_ = 1;
  steps(100, 0);
  EXPECT_EQ(velocity_, 1);
}

// 2a + b < 4 is the limit; the law itself shows it on either side.
TEST_F(TyreTest, TheStabilityLimitIsWhereTheHeaderSaysItIs) {
  grip_ = 1e12;  // linear
  for (const double excess : {0.98, 1.02}) {
    const double b = tyre_.stiffness * kStep * kStep / kMass;
    tyre_.damping = excess * (4 - b) / 2 * kMass / kStep;
    state_ = {};
    velocity_ = 0.01;
    steps(2000, 0);
    EXPECT_EQ(std::abs(velocity_) < 0.01, excess < 1) << excess;
  }
}

TEST_F(TyreTest, IsStableAtAnyRimSpeed) {
  velocity_ = 0.5;
  steps(2000, 0, 1e9);
  EXPECT_NEAR(velocity_, 0, 1e-9);
}

}  // namespace robot_control::tests
