#include <numbers>

#include "drivers/drive/device_rig.h"
#include "support/matchers.h"

namespace robot_control::vesc::tests {

constexpr double kCount = 2 * std::numbers::pi / 42;  // rad of the motor, 7 pole pairs
constexpr double kGear = 2.5;

std::string vesc_words_after(const VescPair& pair, const DriveCommand& command, double seconds = 3) {
  DeviceRig rig;
  add(rig, pair);
  rig.command_all(command);
  rig.run(seconds);
  return rig.drive().words();
}

TEST(VescDrive, NamesTheMessageThatIsNotTurnedOn) {
  VescPair pair = vesc_pair(2);
  pair.device.temperature_period = 0;
  EXPECT_THAT(vesc_words_after(pair, {.enabled = true}),
              HasSubstr("starting; the drive waits for CAN status message 4; set it with the tool of the maker"));
  pair = vesc_pair(2);
  pair.device.status_period = 0;
  EXPECT_THAT(vesc_words_after(pair, {.enabled = true}), HasSubstr("waits for CAN status message 1"));
}

TEST(VescDrive, NamesAMessageThatIsSilent) {
  VescPair pair = vesc_pair(2);
  pair.device.temperature_period = 2;
  EXPECT_THAT(vesc_words_after(pair, {.enabled = true}),
              HasSubstr("fault; the drive is silent: no CAN status message 4"));
}

TEST(VescDrive, ATachometerOfAnotherUnitIsNamed) {
  for (const double counts : {3.0, 18.0}) {
    VescPair pair = vesc_pair(2);
    pair.device.counts_per_turn = counts;
    EXPECT_THAT(vesc_words_after(pair, {.enabled = true, .torque = 0.5}, 1),
                HasSubstr("differs from the drive file: counts of the tachometer per electrical turn"));
  }
}

TEST(VescDrive, ThePositionBetweenTwoCountsFollowsTheSpeed) {
  DeviceRig rig;
  add(rig, vesc_pair(2));
  ASSERT_TRUE(rig.runs());
  rig.motor().velocity = 3 * kGear;
  rig.run(0.5);  // some counts, which show where between two of them the motor is
  const double offset = rig.drive().sample().joint.position - rig.motor().position / kGear;
  for (int i = 0; i < 500; ++i) {
    rig.cycle();
    ASSERT_NEAR(rig.drive().sample().joint.position - rig.motor().position / kGear, offset, 0.15 * kCount / kGear) << i;
  }
}

TEST(VescDrive, TheTachometerOverflowsWithoutAJump) {
  DeviceRig rig;
  add(rig, vesc_pair(2));
  rig.motor().position = kCount * (2147483648.0 - 20);
  ASSERT_TRUE(rig.runs());
  rig.motor().velocity = 10;
  rig.run(2);
  EXPECT_GT(rig.motor().position, kCount * (2147483648.0 + 20));
  EXPECT_EQ(rig.drive().status().state, DrivePhase::kRunning) << rig.drive().words();
}

TEST(VescDrive, TheEffortHasTheSignOfTheTorqueAlsoWhereItBrakes) {
  DeviceRig rig;
  add(rig, vesc_pair(2));
  ASSERT_TRUE(rig.runs());
  for (const double velocity : {-20.0, 20.0}) {
    for (const double torque : {-1.0, 1.0}) {
      rig.motor().velocity = velocity;
      rig.command_all({.enabled = true, .torque = torque});
      rig.run(0.02);
      EXPECT_NEAR(rig.drive().sample().joint.effort, torque, 0.03) << velocity;
    }
  }
}

TEST(VescDrive, TakesSpeedsAndMeasuresNoTorqueWithoutATorqueConstant) {
  VescPair pair = vesc_pair(2);
  pair.drive.drive.takes_speeds = true;
  pair.drive.torque_constant = 0;
  pair.device.speed_gain = 1;
  DeviceRig rig;
  add(rig, pair);
  ASSERT_TRUE(rig.runs());
  rig.command_all({.enabled = true, .speed = 4});
  rig.run(2);
  EXPECT_NEAR(rig.motor().velocity, 4 * kGear, 0.05);
  EXPECT_FALSE(rig.drive().sample().effort_valid);
  EXPECT_FALSE(rig.drive().drive_parameters().measures_torque);
}

TEST(VescDrive, ADriveThatTakesSpeedsAndGivesNoCurrentIsNamed) {
  VescPair pair = vesc_pair(2);
  pair.drive.drive.takes_speeds = true;
  pair.device.speed_gain = 1;
  DeviceRig rig;
  VescDevice& device = add(rig, pair);
  ASSERT_TRUE(rig.runs());
  device.inject(DeviceFault::kEncoder);
  rig.command_all({.enabled = true, .speed = 10});
  rig.run(0.2);
  EXPECT_THAT(rig.drive().words(), HasSubstr("released the motor without an error: no current"));
}

TEST(VescDrive, NoCurrentBeyondTheVelocityLimitIsNoFault) {
  DeviceRig rig;
  VescDevice& device = add(rig, vesc_pair(2));
  ASSERT_TRUE(rig.runs());
  rig.motor().velocity = 41 * kGear;
  device.inject(DeviceFault::kEncoder);
  rig.command_all({.enabled = true, .torque = 1});
  rig.run(0.3);
  EXPECT_EQ(rig.drive().status().state, DrivePhase::kRunning) << rig.drive().words();
}

TEST(VescDrive, AnOrderToEveryDriveIsThatOfAnotherProgram) {
  DeviceRig rig;
  add(rig, vesc_pair(2));
  ASSERT_TRUE(rig.runs());
  const std::size_t foreign = rig.bus().join([](const can_frame&, std::int64_t) {});
  rig.bus().send(foreign, encode(kEveryNode, SetCurrent{}));
  rig.run(0.02);
  EXPECT_THAT(rig.drive().words(), HasSubstr("is commanded by another program, with frame 0x1FF"));
}

TEST(VescDrive, ThatTakesSpeedsBrakesByItselfWhenItsAnswersAreLost) {
  VescPair pair = vesc_pair(2);
  pair.drive.drive.takes_speeds = true;
  pair.device.speed_gain = 0.1;
  DeviceRig rig;
  add(rig, pair);
  ASSERT_TRUE(rig.runs());
  rig.command_all({.enabled = true, .speed = 4});
  rig.run(2);
  ASSERT_NEAR(rig.motor().velocity, 10, 0.5);
  rig.answers = false;
  rig.run(2);
  EXPECT_NEAR(rig.motor().velocity, 0, 0.05);
  rig.answers = true;
  rig.run(1);
  EXPECT_EQ(rig.drive().status().state, DrivePhase::kFault);
  EXPECT_NEAR(rig.motor().velocity, 0, 0.05);
}

TEST(VescDrive, TheTimeoutBrakesWithItsCurrent) {
  VescPair pair = vesc_pair(2);
  pair.device.brake_current = 5;
  pair.device.speed_gain = 1;
  DeviceRig rig;
  add(rig, pair);
  ASSERT_TRUE(rig.runs());
  rig.motor().velocity = 50;
  rig.host_lives = false;
  rig.run(0.11);
  EXPECT_NEAR(rig.motor().torque, -0.5, 1.0e-9);
  rig.run(2);
  EXPECT_NEAR(rig.motor().velocity, 0, 1.0e-3);
}

}  // namespace robot_control::vesc::tests
