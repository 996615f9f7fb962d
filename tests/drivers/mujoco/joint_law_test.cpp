/// The law alone, on a wheel of inertia J: q̇' = q̇ + (τ + load)/J h, q' = q + h q̇'.

#include "drivers/joint_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/mujoco/constants.h"

namespace robot_control::tests {

constexpr double kFreeInertia = 0.005;   // kg·m², a wheel off the ground
constexpr double kRobotInertia = 0.065;  // kg·m², a wheel that moves its half of 12 kg
constexpr double kEffortLimit = 3.5;     // N·m
constexpr Brake kBrake{.effort = 3.0, .hold_effort = 3.0, .damping = 2.0, .stiffness = 300, .hold_speed = 0.3};

struct JointLawTest : testing::Test {
  double step(const JointCommand& command, double load = 0) {
    const double effort = law_.step(command, position_, velocity_);
    velocity_ += (effort + load) / inertia_ * kStep;
    position_ += velocity_ * kStep;
    return effort;
  }
  void brake(double seconds, double load = 0) {
    for (int i = 0; i < seconds / kStep; ++i) step({}, load);
  }

  JointLaw law_{kBrake, kEffortLimit};
  double inertia_ = kRobotInertia;
  double position_ = 0;
  double velocity_ = 0;
};

TEST_F(JointLawTest, EveryModeIsItsEquation) {
  JointCommand command{JointMode::kEffort, 0.3, 2.0, 1.5, 0.25, 0.5};
  EXPECT_DOUBLE_EQ(law_.step(command, 0.1, 1.0), 0.5);
  command.mode = JointMode::kVelocity;
  EXPECT_DOUBLE_EQ(law_.step(command, 0.1, 1.0), 0.5 + 0.25 * (2.0 - 1.0));
  command.mode = JointMode::kImpedance;
  EXPECT_DOUBLE_EQ(law_.step(command, 0.1, 1.0), 0.5 + 1.5 * (0.3 - 0.1) + 0.25 * (2.0 - 1.0));
}

TEST_F(JointLawTest, ClampsToTheEffortLimitBothWays) {
  JointCommand command;
  command.mode = JointMode::kEffort;
  command.effort = 100;
  EXPECT_EQ(law_.step(command, 0, 0), kEffortLimit);
  command.effort = -100;
  EXPECT_EQ(law_.step(command, 0, 0), -kEffortLimit);
}

TEST_F(JointLawTest, ABrakeIsNeverStrongerThanTheJoint) {
  JointLaw weak(kBrake, 1.0);
  EXPECT_EQ(weak.step({}, 0, 10), -1.0);
}

TEST_F(JointLawTest, NumbersThatAreNotFiniteBrake) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    JointCommand command;
    command.mode = JointMode::kVelocity;
    command.damping = 1;
    command.velocity = bad;
    law_.reset();
    EXPECT_EQ(law_.step(command, 0, 10), -kBrake.effort);
  }
}

TEST_F(JointLawTest, AnUnknownModeBrakes) {
  JointCommand command;
  command.mode = static_cast<JointMode>(99);
  command.effort = 2;
  EXPECT_EQ(law_.step(command, 0, 10), -kBrake.effort);
}

TEST_F(JointLawTest, StopsAndHoldsAFreeWheelAndAHeavyOne) {
  for (const double inertia : {kFreeInertia, kRobotInertia}) {
    law_.reset();
    inertia_ = inertia;
    velocity_ = 10;
    brake(3);
    EXPECT_TRUE(law_.holding());
    // Slowest pole: e^(−d/(2J) t) = e^(−15 t), three seconds.
    EXPECT_NEAR(velocity_, 0, 1e-9);
  }
}

// A drive that holds a load hands over to the brake: the torque stays, and so does the wheel.
TEST_F(JointLawTest, TakesOverALoadFromTheDriveWithoutSag) {
  constexpr double kLoad = -0.5;  // N·m
  JointCommand drive;
  drive.mode = JointMode::kEffort;
  drive.effort = -kLoad;
  step(drive, kLoad);
  EXPECT_EQ(step({}, kLoad), -kLoad);
  brake(1, kLoad);
  EXPECT_NEAR(position_, 0, 1e-12);
}

TEST_F(JointLawTest, AWheelThatSlidesDownASlopeIsCaughtAndHeld) {
  constexpr double kLoad = 1.5;  // N·m: damping alone would let it turn at 1.5 / 2 = 0.75 rad/s for ever
  velocity_ = 1.0;
  brake(3, kLoad);
  EXPECT_TRUE(law_.holding());
  EXPECT_NEAR(velocity_, 0, 1e-9);
  EXPECT_NEAR(law_.step({}, position_, velocity_), -kLoad, 1e-6);
}

// 2a + b < 4 is the limit; the law itself shows it on either side.
TEST_F(JointLawTest, TheStabilityLimitIsWhereTheHeaderSaysItIs) {
  for (const double excess : {0.98, 1.02}) {
    Brake brake = kBrake;
    brake.effort = brake.hold_effort = 1e9;  // linear
    const double b = brake.stiffness * kStep * kStep / kFreeInertia;
    brake.damping = excess * (4 - b) / 2 * kFreeInertia / kStep;
    JointLaw law(brake, 1e9);
    double position = 0, velocity = 0.01;
    for (int i = 0; i < 2000; ++i) {
      velocity += law.step({}, position, velocity) / kFreeInertia * kStep;
      position += velocity * kStep;
    }
    EXPECT_EQ(std::abs(velocity) < 0.01, excess < 1) << excess;
  }
}

}  // namespace robot_control::tests
