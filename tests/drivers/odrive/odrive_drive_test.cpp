#include <cmath>

#include "drivers/drive/device_rig.h"
#include "drivers/odrive/odrive_messages_05.h"
#include "drivers/odrive/odrive_messages_06.h"
#include "support/matchers.h"

namespace robot_control::odrive::tests {

std::string words_after(const OdrivePair& pair, double seconds = 3) {
  DeviceRig rig;
  add(rig, pair);
  rig.command_all({.enabled = true});
  rig.run(seconds);
  return rig.drive().words();
}

TEST(OdriveDrive, SilenceOnGetVersionMeansFirmware05) {
  for (const Firmware firmware : {Firmware::k05, Firmware::k06}) {
    DeviceRig rig;
    add(rig, odrive_pair(3, firmware));
    ASSERT_TRUE(rig.runs());
    EXPECT_EQ(dynamic_cast<OdriveDrive&>(rig.drive()).firmware(), firmware);
  }
}

TEST(OdriveDrive, ComparesTheFirmwareWithTheFile) {
  OdrivePair pair = odrive_pair(3, Firmware::k05);
  pair.drive.firmware = Firmware::k06;
  EXPECT_THAT(words_after(pair),
              HasSubstr("fault; the drive differs from the drive file: firmware, 0.5 instead of 0.6"));
}

TEST(OdriveDrive, ComparesTheSerialNumberWithTheFile) {
  OdrivePair pair = odrive_pair(3);
  pair.drive.serial_number = 77;
  EXPECT_THAT(words_after(pair), HasSubstr("differs from the drive file: serial number 4660"));
}

TEST(OdriveDrive, NoticesASecondDriveOfTheSameNode) {
  DeviceRig rig;
  add(rig, odrive_pair(3));
  OdriveDeviceParameters second = odrive_pair(3).device;
  second.serial_number = 99;
  rig.add_device(std::make_unique<OdriveDevice>(second, rig.bus(), rig.add_motor()));
  EXPECT_FALSE(rig.runs(3));
  EXPECT_THAT(rig.drive().words(), HasSubstr("shares its node number with a second drive"));
}

TEST(OdriveDrive, DoesNotExecuteTheSetPointOfAnEarlierProgram) {
  for (const Firmware firmware : {Firmware::k05, Firmware::k06}) {
    DeviceRig rig;
    OdriveDevice& device = add(rig, odrive_pair(3, firmware));
    const std::size_t earlier = rig.bus().join([](const can_frame&, std::int64_t) {});
    rig.bus().connect(rig.host(), false);
    rig.bus().send(earlier, encode(3, SetControllerMode{}));
    rig.bus().send(earlier, encode(3, SetInputTorque{.torque = 0.5}));
    rig.bus().advance(1'000'000);
    ASSERT_EQ(device.set_point(), 0.5);
    rig.bus().connect(rig.host(), true);
    rig.bus().lose(0.1);
    rig.command_all({.enabled = true});
    ASSERT_TRUE(rig.run_until(
        [&] { return rig.motor().torque != 0 || rig.drive().status().state == DrivePhase::kRunning; }, 20))
        << rig.drive().words();
    EXPECT_EQ(rig.motor().torque, 0);
    EXPECT_EQ(device.set_point(), 0);
  }
}

TEST(OdriveDrive, RaisesTheVelocityLimitThatWouldReduceTheTorque) {
  DeviceRig rig;
  add(rig, odrive_pair(2));
  ASSERT_TRUE(rig.runs());
  rig.motor().velocity = 2.5 * 40;  // the joint at its limit
  rig.command_all({.enabled = true, .torque = 0.5});
  rig.cycle();
  EXPECT_NEAR(rig.motor().torque, 0.2, 1.0e-6);
}

/// The robot's damping of the brake is smaller than what torque mode needs at the joint's limit.
TEST(OdriveDrive, HasItsWholeTorqueAgainAfterItBrakedInAFault) {
  DeviceRig rig;
  add(rig, odrive_pair(2));
  ASSERT_TRUE(rig.runs());
  rig.command_all({.enabled = true, .brake_torque = 1, .brake_damping = 0.01});
  rig.answers = false;
  rig.run(0.5);
  ASSERT_EQ(rig.drive().status().state, DrivePhase::kFault);
  rig.answers = true;
  rig.command_all({.enabled = true, .reset = true, .brake_torque = 1, .brake_damping = 0.01});
  rig.cycle();
  ASSERT_TRUE(rig.runs());
  rig.motor().velocity = 2.5 * 39;  // just below the joint's limit
  rig.command_all({.enabled = true, .torque = 4});
  rig.cycle();
  EXPECT_NEAR(rig.motor().torque, 4 / 2.5, 1.0e-6);
}

/// Behind an encoder that slipped the loop of the axis drives instead of braking.
TEST(OdriveDrive, DoesNotRunAwayWhereItsEncoderFailed) {
  for (const Firmware firmware : {Firmware::k05, Firmware::k06}) {
    for (const bool takes_speeds : {false, true}) {
      OdrivePair pair = odrive_pair(2, firmware);
      pair.drive.drive.takes_speeds = takes_speeds;
      pair.device.speed_gain = 0.1;
      DeviceRig rig;
      OdriveDevice& device = add(rig, pair);
      ASSERT_TRUE(rig.runs());
      rig.command_all({.enabled = true, .torque = takes_speeds ? 0 : 0.5, .speed = 8, .brake_damping = 1});
      ASSERT_TRUE(rig.run_until([&] { return rig.motor().velocity > 18; }, 2));
      rig.command_all({.enabled = true, .speed = 8, .brake_torque = 4, .brake_damping = 1});
      device.inject(DeviceFault::kSlipped);
      for (int i = 0; i < 1000; ++i) {
        rig.cycle();
        ASSERT_LT(std::abs(rig.motor().velocity), 2 * 20) << takes_speeds;
      }
      EXPECT_EQ(device.state(), AxisState::kIdle);
      EXPECT_THAT(rig.drive().words(), HasSubstr("reports a jump of its position"));
    }
  }
}

TEST(OdriveDrive, ReportsTheLastOrderAsEffortWhileItFollows) {
  DeviceRig rig;
  add(rig, odrive_pair(2));
  ASSERT_TRUE(rig.runs());
  rig.inertia = 100;
  for (int i = 0; i < 200; ++i) {
    const double torque = 2 * std::sin(0.05 * i);
    rig.command_all({.enabled = true, .torque = torque});
    rig.cycle();
    if (i > 20) {
      ASSERT_EQ(rig.drive().sample().joint.effort, torque) << i;
    }
  }
}

TEST(OdriveDrive, ReportsTheMeasuredEffortWhereItDoesNotFollow) {
  DeviceRig rig;
  add(rig, odrive_pair(2));
  ASSERT_TRUE(rig.runs());
  rig.inertia = 100;
  rig.motor().velocity = 2.5 * 59;  // the device reduces the torque at this speed
  rig.command_all({.enabled = true, .torque = 3});
  rig.run(0.1);
  EXPECT_NEAR(rig.drive().sample().joint.effort, 2.5 * rig.motor().torque, 1.0e-3);
  EXPECT_LT(rig.motor().torque, 0.5);
  EXPECT_TRUE(rig.drive().sample().effort_valid);
}

TEST(OdriveDrive, ReadsItsWatchdogWhereTheEndpointsAreKnown) {
  OdrivePair pair = odrive_pair(3);
  pair.drive.drive.on_silence = SilenceReaction::kUnknown;
  pair.drive.enable_watchdog_endpoint = pair.device.enable_watchdog_endpoint = 200;
  pair.drive.watchdog_timeout_endpoint = pair.device.watchdog_timeout_endpoint = 201;
  EXPECT_THAT(words_after(pair), HasSubstr("unknown reaction on silence"));
  pair.device.watchdog_timeout = 1;
  EXPECT_THAT(words_after(pair), HasSubstr("watchdog_timeout, 1 instead of 0.2"));
  pair.device.watchdog_timeout = 0.1;
  DeviceRig rig;
  add(rig, pair);
  ASSERT_TRUE(rig.runs());
  EXPECT_EQ(rig.drive().on_silence().reaction, SilenceReaction::kCoasts);
  EXPECT_EQ(rig.drive().on_silence().evidence, ReactionEvidence::kRead);
}

TEST(OdriveDrive, TakesTheUsersWordForAWatchdogThatCannotBeRead) {
  DeviceRig rig;
  add(rig, odrive_pair(3, Firmware::k05));
  ASSERT_TRUE(rig.runs());
  EXPECT_EQ(rig.drive().on_silence().evidence, ReactionEvidence::kConfirmed);
}

/// A float of 10⁵ turns has a step of 0.05 rad.
TEST(OdriveDrive, KeepsItsResolutionAfterManyTurnsWithoutAJump) {
  for (const Firmware firmware : {Firmware::k05, Firmware::k06}) {
    DeviceRig rig;
    add(rig, odrive_pair(2, firmware));
    rig.motor().position = 1.0e5 * kTurn + 1;
    ASSERT_TRUE(rig.runs());
    rig.run(2);
    const double joint = rig.motor().position / 2.5;
    EXPECT_NEAR(rig.drive().sample().joint.position, joint, 0.03);
    const double offset = rig.drive().sample().joint.position - joint;
    for (int i = 0; i < 20; ++i) {
      rig.motor().position += 0.01;
      rig.run(0.01);
      ASSERT_NEAR(rig.drive().sample().joint.position, rig.motor().position / 2.5 + offset, 0.0008);
    }
  }
}

/// An axis of firmware 0.5 that reports zeros until it closes its loop, and then `position` in turns.
class ZeroUntilClosedLoop {
 public:
  explicit ZeroUntilClosedLoop(double position) : position_(position) {}

  /// Runs one cycle of 10 ms.
  void cycle(bool reset = false) {
    now_ns_ += 10'000'000;
    if (now_ns_ % 100'000'000 == 0) drive_.receive(encode(0, v05::Heartbeat{.state = state_}), now_ns_);
    const double turns = state_ == AxisState::kClosedLoopControl ? position_ : 0;
    drive_.receive(encode(0, EncoderEstimates{.position = kTurn * turns}), now_ns_);
    FrameBatch send;
    drive_.step({.enabled = true, .reset = reset}, now_ns_, send);
    for (const can_frame& frame : send.frames()) {
      if (const auto wanted = decode<SetAxisState>(frame); wanted && !is_remote_request(frame)) state_ = wanted->state;
    }
  }
  OdriveDrive& drive() { return drive_; }
  void lose_torque() { state_ = AxisState::kIdle; }

 private:
  static OdriveParameters parameters() {
    OdriveParameters parameters = odrive_pair(0, Firmware::k05).drive;
    parameters.estimates_period = 0.01;
    return parameters;
  }

  double position_;
  OdriveDrive drive_{parameters(), 0.01};
  AxisState state_ = AxisState::kIdle;
  std::int64_t now_ns_ = 0;
};

TEST(OdriveDrive, APositionIsNoZeroBeforeTheAxisIsInClosedLoop) {
  for (const double turns : {12.34, -0.8, 3000.0}) {
    ZeroUntilClosedLoop axis(turns);
    for (int attempt = 0; attempt < 3; ++attempt) {
      for (int i = 0; i < 300; ++i) axis.cycle(i == 0);
      ASSERT_EQ(axis.drive().status().state, DrivePhase::kRunning) << axis.drive().words();
      const double position = axis.drive().sample().joint.position;
      for (int i = 0; i < 100; ++i) {
        axis.cycle();
        ASSERT_NEAR(axis.drive().sample().joint.position, position, 1.0e-9) << i;
      }
      axis.lose_torque();
      for (int i = 0; i < 20; ++i) axis.cycle();
      ASSERT_EQ(axis.drive().status().state, DrivePhase::kFault);
    }
  }
}

TEST(OdriveDrive, ThatTakesSpeedsBrakesByItselfWhenItsAnswersAreLost) {
  OdrivePair pair = odrive_pair(2);
  pair.drive.drive.takes_speeds = true;
  pair.device.speed_gain = 0.1;
  DeviceRig rig;
  OdriveDevice& device = add(rig, pair);
  ASSERT_TRUE(rig.runs());
  rig.command_all({.enabled = true, .speed = 4});
  rig.run(2);
  ASSERT_NEAR(rig.motor().velocity, 10, 0.5);
  rig.answers = false;
  rig.run(2);
  EXPECT_EQ(device.state(), AxisState::kClosedLoopControl);
  EXPECT_NEAR(rig.motor().velocity, 0, 0.05);
  rig.answers = true;
  rig.run(1);
  EXPECT_EQ(rig.drive().status().state, DrivePhase::kFault);
  EXPECT_NEAR(rig.motor().velocity, 0, 0.05);
}

TEST(OdriveDrive, IsIdleAgainWhenItIsNotEnabled) {
  DeviceRig rig;
  OdriveDevice& device = add(rig, odrive_pair(2));
  ASSERT_TRUE(rig.runs());
  rig.command_all({.torque = 1});
  rig.run(0.3);
  EXPECT_EQ(device.state(), AxisState::kIdle);
  EXPECT_EQ(rig.drive().status().state, DrivePhase::kReady);
  EXPECT_TRUE(rig.runs());
}

TEST(OdriveDrive, AnErrorAtTheStartWaitsForTheReset) {
  DeviceRig rig;
  OdriveDevice& device = add(rig, odrive_pair(2));
  device.inject(DeviceFault::kEncoder);
  device.inject(DeviceFault::kReleased);  // The cause is gone, its error bits remain.
  EXPECT_FALSE(rig.runs(3));
  EXPECT_THAT(rig.drive().words(), HasSubstr("reports an error: MISSING_ESTIMATE"));
  rig.command_all({.enabled = true, .reset = true});
  rig.cycle();
  EXPECT_TRUE(rig.runs());
}

TEST(OdriveDrive, AnAxisThatCannotCloseItsLoopIsAFault) {
  OdrivePair pair = odrive_pair(2);
  DeviceRig rig;
  OdriveDevice& device = add(rig, pair);
  rig.command_all({.enabled = true});
  for (int i = 0; i < 5000; ++i) {
    device.inject(DeviceFault::kReleased);
    rig.cycle();
  }
  EXPECT_THAT(rig.drive().words(), HasSubstr("stays without torque: axis state 1"));
}

}  // namespace robot_control::odrive::tests
