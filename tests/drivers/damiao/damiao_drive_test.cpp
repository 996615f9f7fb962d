/// The state machine of a Damiao motor against its device: registers, timeout, zero, impedance.

#include <cmath>
#include <numbers>

#include "drivers/drive/device_rig.h"
#include "support/matchers.h"

namespace robot_control::tests {

struct DamiaoDriveTest : testing::Test {
  DamiaoDevice& add_motor() { return add(rig_, pair_); }
  std::string refusal() {
    add_motor();
    rig_.command_all({.enabled = true});
    rig_.run(2);
    EXPECT_EQ(rig_.motor().torque, 0);
    return rig_.drive().words();
  }
  double motor_per_joint() { return -2.5; }  // direction and gear of node 1

  DeviceRig rig_;
  DamiaoPair pair_ = damiao_pair(1);
};

TEST_F(DamiaoDriveTest, ARangeThatIsNotTheMotorsIsRefused) {
  pair_.device.ranges.velocity = 30;
  EXPECT_THAT(refusal(),
              HasSubstr("fault; the drive differs from the drive file: velocity_range (VMAX), 30 instead of 45"));
}

TEST_F(DamiaoDriveTest, AnotherModeOfControlIsRefused) {
  pair_.device.mode = 2;
  EXPECT_THAT(refusal(), HasSubstr("differs from the drive file: control mode (CTRL_MODE), 2 instead of 1"));
}

TEST_F(DamiaoDriveTest, AMotorWhoseRegistersAreNotAnsweredIsRefused) {
  pair_.device.answers_registers = false;
  EXPECT_THAT(refusal(), HasSubstr("did not answer a request for its registers"));
}

TEST_F(DamiaoDriveTest, ATimeoutThatTheMotorDoesNotTakeIsRefused) {
  pair_.device.takes_timeout = false;
  EXPECT_THAT(refusal(), HasSubstr("refused to set its timeout (TIMEOUT)"));
}

TEST_F(DamiaoDriveTest, TheReactionOnSilenceIsReadFromTheMotor) {
  add_motor();
  ASSERT_TRUE(rig_.runs());
  EXPECT_EQ(rig_.drive().on_silence(), (KnownReaction{SilenceReaction::kCoasts, ReactionEvidence::kRead}));
}

TEST_F(DamiaoDriveTest, TheMotorReleasesItselfAfterItsTimeoutAndTheNextStartClearsThat) {
  pair_.drive.timeout = 0.05;
  add_motor();
  ASSERT_TRUE(rig_.runs());
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

TEST_F(DamiaoDriveTest, TheMotorClosesTheImpedanceOfTheJoint) {
  add_motor();
  ASSERT_TRUE(rig_.runs());
  rig_.motor().velocity = 0;
  const double position = rig_.drive().sample().joint.position;
  rig_.command_all({.enabled = true, .stiffness = 20, .position = position + 0.2, .damping = 1});
  rig_.run(3);
  // A torque of 0 is off by 54/4095 N·m of the motor, at 20 N·m/rad of the joint; position and velocity add less.
  EXPECT_NEAR(rig_.drive().sample().joint.position, position + 0.2, 1.5 * 54.0 / 4095 * 2.5 / 20);
  rig_.motor().velocity = 0;
  rig_.command_all({.enabled = true, .torque = 1, .speed = 2, .damping = 1});
  rig_.cycle();
  // Joint: 1 N·m + 1 N·m·s/rad · (2 rad/s − q̇), and the joint moves for one period only.
  EXPECT_NEAR(rig_.motor().torque, 3 / motor_per_joint(), 0.3 / 2.5);
}

TEST_F(DamiaoDriveTest, AJointThatIsOffByATurnOfTheRotorIsRefusedBeforeAnyTorque) {
  const double turn = 2 * std::numbers::pi / (9 * 2.5);
  for (const double sign : {-1.0, 1.0}) {
    DeviceRig rig;
    DamiaoPair pair = damiao_pair(1);
    pair.drive.start_angle = 0.02;
    pair.device.zero = sign * turn * 2.5;
    add(rig, pair);
    rig.command_all({.enabled = true, .torque = 1});
    rig.run(2);
    EXPECT_EQ(rig.motor().velocity, 0);
    EXPECT_THAT(rig.drive().words(), HasSubstr("differs from the drive file: start_angle, "));
  }
}

TEST_F(DamiaoDriveTest, TheAnswerToAnotherProgramThatReadsARegisterIsNoSample) {
  add_motor();
  ASSERT_TRUE(rig_.runs());
  const double position = rig_.drive().sample().joint.position;
  rig_.drive().receive(
      damiao::encode(static_cast<canid_t>(1 + damiao::kMaxNode + 1),
                     {.node = 1, .operation = damiao::Operation::kRead, .number = damiao::Register::kGear}),
      rig_.now_ns());
  rig_.run(0.02);
  EXPECT_EQ(rig_.drive().status().state, DrivePhase::kRunning) << rig_.drive().words();
  EXPECT_NEAR(rig_.drive().sample().joint.position, position, 0.1);
}

/// The second frame comes 1 ms too early, so the first one was late.
TEST_F(DamiaoDriveTest, ThePositionOfALateFrameIsTakenAsItArrives) {
  add_motor();
  ASSERT_TRUE(rig_.runs());
  const double position = rig_.drive().sample().joint.position;
  const damiao::Feedback feedback{.node = 1,
                                  .state = damiao::State::kOn,
                                  .position = rig_.motor().position - pair_.device.zero,
                                  .velocity = 10,
                                  .transistors = 20,
                                  .rotor = 20};
  for (const std::int64_t after_ns : {2'000'000, 3'000'000})
    rig_.drive().receive(damiao::encode(static_cast<canid_t>(1 + damiao::kMaxNode + 1), pair_.device.ranges, feedback),
                         rig_.now_ns() + after_ns);
  EXPECT_NEAR(rig_.drive().sample().joint.position, position, 1.0e-3);
}

TEST_F(DamiaoDriveTest, AJointNearItsStartAngleRuns) {
  pair_.drive.drive.offset = 0.5;
  pair_.drive.start_angle = 0.4;
  add_motor();
  ASSERT_TRUE(rig_.runs());
  EXPECT_NEAR(rig_.drive().sample().joint.position, 0.5, 1.0e-3);
}

}  // namespace robot_control::tests
