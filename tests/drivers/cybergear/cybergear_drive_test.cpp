/// The state machine of a CyberGear against its device: parameters, timeout, zero, ranges, impedance.

#include <cmath>
#include <numbers>

#include "drivers/drive/device_rig.h"
#include "support/matchers.h"

namespace robot_control::tests {

struct CybergearDriveTest : testing::Test {
  std::string refusal() {
    add(rig_, pair_);
    rig_.command_all({.enabled = true, .torque = 1});
    rig_.run(2);
    EXPECT_EQ(rig_.motor().velocity, 0);
    return rig_.drive().words();
  }

  DeviceRig rig_;
  CybergearPair pair_ = cybergear_pair(1);
};

TEST_F(CybergearDriveTest, AnotherModeOfControlIsRefused) {
  pair_.device.run_mode = 2;
  EXPECT_THAT(refusal(), HasSubstr("differs from the drive file: mode of control (run_mode), 2 instead of 0"));
}

TEST_F(CybergearDriveTest, ATorqueLimitBeyondTheRangeShowsAnotherTypeOfMotor) {
  pair_.device.torque_limit = 17;
  EXPECT_THAT(refusal(), HasSubstr("differs from the drive file: torque_range (limit_torque), 17 instead of 12"));
}

TEST_F(CybergearDriveTest, AMotorThatAnswersNoParameterIsRefused) {
  pair_.device.answers_parameters = false;
  EXPECT_THAT(refusal(), HasSubstr("did not answer a request for its parameters"));
}

TEST_F(CybergearDriveTest, AMotorWithoutATimeoutIsRefusedUnlessTheFileAcceptsThat) {
  pair_.device.has_timeout = false;
  EXPECT_THAT(refusal(), HasSubstr("has an unknown reaction on silence"));
}

TEST_F(CybergearDriveTest, ATimeoutThatTheMotorDoesNotTakeIsNone) {
  pair_.device.takes_timeout = false;
  EXPECT_THAT(refusal(), HasSubstr("has an unknown reaction on silence"));
}

TEST_F(CybergearDriveTest, AnAcceptedMotorWithoutATimeoutKeepsItsOrder) {
  pair_.device.has_timeout = false;
  pair_.drive.drive.on_silence = SilenceReaction::kKeeps;
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  EXPECT_EQ(rig_.drive().on_silence(), (KnownReaction{SilenceReaction::kKeeps, ReactionEvidence::kConfirmed}));
}

TEST_F(CybergearDriveTest, TheMotorReleasesItselfAfterItsTimeoutAndRunsAgainAfterTheReset) {
  pair_.drive.timeout = 0.05;
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  EXPECT_EQ(rig_.drive().on_silence(), (KnownReaction{SilenceReaction::kCoasts, ReactionEvidence::kRead}));
  rig_.command_all({.enabled = true, .torque = 0.1});
  rig_.cycle();
  rig_.host_lives = false;
  rig_.run(0.048);
  EXPECT_NE(rig_.motor().torque, 0);
  rig_.run(0.004);
  EXPECT_EQ(rig_.motor().torque, 0);
  rig_.host_lives = true;
  ASSERT_TRUE(rig_.run_until([this] { return rig_.all_are(DrivePhase::kFault); }, 1));
  rig_.reset();
  EXPECT_TRUE(rig_.runs());
}

TEST_F(CybergearDriveTest, TheMotorClosesTheImpedanceOfTheJoint) {
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  rig_.motor().velocity = 0;
  const double position = rig_.drive().sample().joint.position;
  rig_.command_all({.enabled = true, .stiffness = 20, .position = position + 0.2, .damping = 1});
  rig_.run(3);
  // A torque of 0 is off by 12/65535 N·m of the motor, at 20 N·m/rad of the joint; position and velocity add less.
  EXPECT_NEAR(rig_.drive().sample().joint.position, position + 0.2, 1.0e-3);
}

TEST_F(CybergearDriveTest, AJointThatIsOffByATurnOfTheRotorIsRefusedBeforeAnyTorque) {
  const double turn = 2 * std::numbers::pi / (7.75 * 2.5);
  for (const double sign : {-1.0, 1.0}) {
    DeviceRig rig;
    CybergearPair pair = cybergear_pair(1);
    pair.drive.start_angle = 0.02;
    pair.device.zero = sign * turn * 2.5;
    add(rig, pair);
    rig.command_all({.enabled = true, .torque = 1});
    rig.run(2);
    EXPECT_EQ(rig.motor().velocity, 0);
    EXPECT_THAT(rig.drive().words(), HasSubstr("differs from the drive file: start_angle, "));
  }
}

TEST_F(CybergearDriveTest, AWrongRangeOfTheVelocityIsFoundWhileTheMotorIsReleased) {
  pair_.device.ranges.velocity = 33;
  add(rig_, pair_);
  rig_.command_all({});
  rig_.run(1);
  ASSERT_EQ(rig_.drive().status().state, DrivePhase::kReady) << rig_.drive().words();
  rig_.motor().velocity = 3;  // It is turned by hand.
  rig_.run(1);
  EXPECT_THAT(rig_.drive().words(), AllOf(HasSubstr("differs from the drive file: velocity_range by its positions"),
                                          HasSubstr(" instead of 50")));
}

/// The two orders in which the numbers of host and motor are stated.
TEST_F(CybergearDriveTest, DetailedFaultsAreTakenWithBothOrdersOfTheNumbers) {
  for (const canid_t id : {0x150001FDU, 0x1500FD01U}) {
    DeviceRig rig;
    add(rig, cybergear_pair(1));
    ASSERT_TRUE(rig.runs());
    rig.drive().receive(word_frame(CAN_EFF_FLAG | id, 0x4002, 8), rig.now_ns());
    rig.cycle();
    EXPECT_THAT(rig.drive().words(), HasSubstr("reports an error: driver chip, overload"));
  }
}

}  // namespace robot_control::tests
