/// The state machine of a moteus controller against its device: gains, registers, timeout, zero.

#include <cmath>
#include <numbers>

#include "drivers/drive/device_rig.h"
#include "support/matchers.h"

namespace robot_control::tests {

struct MoteusDriveTest : testing::Test {
  /// No motor turns before the refusal.
  std::string refusal() {
    add(rig_, pair_);
    rig_.command_all({.enabled = true, .torque = 1});
    rig_.run(2);
    EXPECT_EQ(rig_.motor().velocity, 0);
    EXPECT_EQ(rig_.motor().torque, 0);
    return rig_.drive().words();
  }

  DeviceRig rig_;
  MoteusPair pair_ = moteus_pair(1);
};

TEST_F(MoteusDriveTest, AnotherKpIsFoundBeforeTheMotorHasTorque) {
  pair_.device.gains.stiffness *= 0.5;
  EXPECT_THAT(refusal(), testing::ContainsRegex(
                             "differs from the drive file: kp, or a limit of its position, 1[45][0-9]+(.[0-9]+)? "
                             "instead of 3000"));
}

TEST_F(MoteusDriveTest, AnotherKdIsFoundBeforeTheMotorHasTorque) {
  pair_.device.gains.damping *= 1.5;
  EXPECT_THAT(refusal(), HasSubstr("differs from the drive file: kd, 45 instead of 30"));
}

TEST_F(MoteusDriveTest, AnIntegralIsFoundBeforeTheMotorHasTorque) {
  pair_.device.integral = 0.01;
  EXPECT_THAT(refusal(), HasSubstr("integral, for which set servo.pid_position.ilimit to 0, 0.01 instead of 0"));
}

TEST_F(MoteusDriveTest, GainsThatDifferByATenthAreAccepted) {
  pair_.device.gains.stiffness *= 1.1;
  pair_.device.gains.damping *= 0.9;
  add(rig_, pair_);
  EXPECT_TRUE(rig_.runs());
}

TEST_F(MoteusDriveTest, TheGainsAreFoundWhileTheJointMovesAndFramesAreLost) {
  add(rig_, pair_);
  rig_.bus().lose(0.05);
  rig_.motor().velocity = 1;
  EXPECT_TRUE(rig_.runs());
  EXPECT_NEAR(rig_.motor().velocity, 1, 1.0e-9);
}

TEST_F(MoteusDriveTest, OlderRegistersAreRefused) {
  pair_.device.map_version = 4;
  EXPECT_THAT(refusal(), HasSubstr("differs from the drive file: version of its registers (102h), 4 instead of 5"));
}

TEST_F(MoteusDriveTest, APositionThatIsRelativeToNothingIsRefused) {
  pair_.device.home = 0;
  EXPECT_THAT(refusal(), HasSubstr("reference of its position (register 00Ch), 0 instead of 1"));
}

/// The angle is off by a turn of the rotor, 2π/(9 · 2.5) at the joint.
TEST_F(MoteusDriveTest, AnAngleThatIsOffByATurnOfTheRotorIsRefused) {
  pair_.drive.start_angle = 0;
  pair_.device.zero = 2 * std::numbers::pi / 9;
  pair_.drive.motor_gear = 9;
  EXPECT_THAT(refusal(), HasSubstr("differs from the drive file: start_angle, 0.2793 instead of 0"));
}

TEST_F(MoteusDriveTest, APositionOfTheOutputHasNoTurnsOfTheRotor) {
  pair_.drive.start_angle = 0;
  pair_.device.zero = 2 * std::numbers::pi / 9;
  pair_.device.home = 2;
  add(rig_, pair_);
  EXPECT_TRUE(rig_.runs());
}

TEST_F(MoteusDriveTest, AMissedTimeoutDampsTheMotorAndLastsUntilTheReset) {
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  rig_.motor().velocity = 8;
  rig_.command_all({.enabled = true, .damping = 1});
  rig_.cycle();
  rig_.host_lives = false;
  rig_.run(0.031);
  EXPECT_NEAR(rig_.motor().torque, -1 / 6.25 * rig_.motor().velocity, 0.01);
  rig_.motor().velocity = 1000;
  rig_.run(0.001);
  EXPECT_NEAR(rig_.motor().torque, -1.6, 1.0e-9) << "the limit of the torque, 4 N·m at the joint";
  rig_.host_lives = true;
  rig_.command_all({.enabled = true, .torque = 1});
  rig_.motor().velocity = 0;
  rig_.run(0.1);
  EXPECT_THAT(rig_.drive().words(), HasSubstr("fault; the drive"));
  EXPECT_NEAR(rig_.motor().velocity, 0, 1.0e-9);
  rig_.reset();
  EXPECT_TRUE(rig_.runs());
}

/// The computer is late for longer than the timeout, and for less than the driver calls silence.
TEST_F(MoteusDriveTest, ATimeoutOfAControllerIsNamed) {
  pair_.drive.timeout = 0.02;
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  rig_.host_lives = false;
  rig_.run(0.03);
  rig_.host_lives = true;
  rig_.run(0.01);
  EXPECT_THAT(rig_.drive().words(), HasSubstr("braked by itself, because it received no order in time"));
}

TEST_F(MoteusDriveTest, AControllerThatCoastsHasNoTorqueAfterItsTimeout) {
  pair_.device.damps_after_timeout = false;
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  rig_.command_all({.enabled = true, .damping = 1});
  rig_.motor().velocity = 20;
  rig_.cycle();
  rig_.host_lives = false;
  rig_.run(0.05);
  EXPECT_EQ(rig_.motor().torque, 0);
}

TEST_F(MoteusDriveTest, TheMotorClosesTheImpedanceOfTheJoint) {
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  rig_.inertia = 1.0e6;
  rig_.command_all({.enabled = true, .torque = 0.5, .stiffness = 2, .position = 0.4, .damping = 0});
  rig_.run(0.01);
  EXPECT_NEAR(rig_.motor().torque, -(0.5 + 2 * 0.4) / 2.5, 1.0e-4);
}

TEST_F(MoteusDriveTest, NoOrderExceedsTheLimitOfTheJoint) {
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  rig_.inertia = 1.0e6;
  rig_.command_all({.enabled = true, .stiffness = 100, .position = 1});
  rig_.run(0.01);
  EXPECT_NEAR(rig_.motor().torque, -4 / 2.5, 1.0e-6);
}

TEST_F(MoteusDriveTest, TheSupplyIsThatOfTheReplies) {
  pair_.drive.drive.min_voltage = 41;
  EXPECT_THAT(refusal(), HasSubstr("has a low supply: voltage, 40 instead of 41"));
  EXPECT_EQ(rig_.drive().sample().voltage, 40);
}

}  // namespace robot_control::tests
