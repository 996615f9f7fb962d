/// The state machine of an AK motor against its device: what it cannot report, and the ranges.

#include <cmath>
#include <numbers>

#include "drivers/drive/device_rig.h"
#include "support/matchers.h"

namespace robot_control::tests {

struct AkDriveTest : testing::Test {
  double motor_per_joint() { return -2.5; }  // direction and gear of node 1

  DeviceRig rig_;
  AkPair pair_ = ak_pair(1);
};

TEST_F(AkDriveTest, OlderFirmwareWithoutHealthRuns) {
  pair_.device.reports_health = false;
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  EXPECT_EQ(rig_.drive().on_silence(), (KnownReaction{SilenceReaction::kKeeps, ReactionEvidence::kConfirmed}));
}

/// A motor keeps the order of a program that was killed.
TEST_F(AkDriveTest, AnOldOrderIsNotCarriedOutWhenTheMotorIsEnabled) {
  add(rig_, pair_);
  rig_.run(0.1);
  rig_.host_lives = false;
  rig_.bus().send(rig_.host(), encode_request(1, MitRequest::kEnable));
  rig_.bus().send(rig_.host(), encode_mit(1, pair_.drive.ranges, {.torque = 20}));
  rig_.run(0.01);
  EXPECT_NE(rig_.motor().torque, 0);
  rig_.host_lives = true;
  rig_.run(0.01);
  EXPECT_EQ(rig_.motor().torque, 0);
  rig_.motor().velocity = 0;
  ASSERT_TRUE(rig_.runs());
  EXPECT_NEAR(rig_.motor().velocity, 0, 0.1);
}

TEST_F(AkDriveTest, AReleaseIsFoundWhereTheOrderNeedsTorque) {
  pair_.drive.drive.torque_limit = 100;
  Device& device = add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  rig_.command_all({.enabled = true});
  device.inject(DeviceFault::kReleased);
  rig_.run(1);
  EXPECT_EQ(rig_.drive().status().state, DrivePhase::kRunning);
  rig_.command_all({.enabled = true, .torque = 20});
  rig_.run(0.09);
  EXPECT_EQ(rig_.drive().status().state, DrivePhase::kRunning);
  rig_.run(0.03);
  EXPECT_THAT(rig_.drive().words(), HasSubstr("released the motor without an error: no torque"));
}

TEST_F(AkDriveTest, AJointThatIsOffByATurnOfTheRotorIsRefusedBeforeAnyTorque) {
  const double turn = 2 * std::numbers::pi / (9 * 2.5);
  for (const double sign : {-1.0, 1.0}) {
    DeviceRig rig;
    AkPair pair = ak_pair(1);
    pair.drive.start_angle = 0.02;
    pair.device.zero = sign * turn * 2.5;
    add(rig, pair);
    rig.command_all({.enabled = true, .torque = 1});
    rig.run(2);
    EXPECT_EQ(rig.motor().velocity, 0);
    EXPECT_THAT(rig.drive().words(), HasSubstr("differs from the drive file: start_angle, "));
  }
}

/// The ranges of the velocity on which public lists contradict each other, and one of the position.
TEST_F(AkDriveTest, AWrongRangeIsFoundBeforeTheMotorIsReleasedToTheController) {
  struct Case {
    double position, velocity;  // of the motor
    const char* words;
  };
  for (const Case& each : {Case{12.5, 25.64, ", 25."}, {12.5, 76, ", 76"}, {95.5, 50, ", 6.5"}}) {
    DeviceRig rig;
    AkPair pair = ak_pair(1);
    pair.device.ranges.position = each.position;
    pair.device.ranges.velocity = each.velocity;
    add(rig, pair);
    rig.command_all({});
    rig.run(0.5);
    ASSERT_EQ(rig.drive().status().state, DrivePhase::kReady) << rig.drive().words();
    rig.motor().velocity = 4;  // It is turned by hand.
    rig.run(1);
    EXPECT_THAT(rig.drive().words(), AllOf(HasSubstr("fault; the drive differs from the drive file: velocity_range by "
                                                     "its positions, or position_range"),
                                           HasSubstr(each.words)));
  }
}

TEST_F(AkDriveTest, AWrongRangeIsFoundWhileItRuns) {
  pair_.device.ranges.velocity = 25.64;
  add(rig_, pair_);
  ASSERT_TRUE(rig_.runs());
  rig_.command_all({.enabled = true, .torque = 0.3, .brake_damping = 1});
  rig_.run(2);
  EXPECT_THAT(rig_.drive().words(), HasSubstr("velocity_range by its positions"));
  EXPECT_LT(std::abs(rig_.motor().velocity), 1);  // It is damped.
}

}  // namespace robot_control::tests
