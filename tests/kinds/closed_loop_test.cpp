/// A second robot kind in one process: its laws, the common monitor and gate, its stop action, its replay.

#include <gtest/gtest.h>

#include <cmath>

#include "kinds/pendulum.h"
#include "log/replay/recorded.h"
#include "signals/checksum.h"
#include "signals/names.h"
#include "signals/wheeled/drive_tuning.h"
#include "support/recorded_loop.h"

namespace robot_control::tests {

struct SecondKind : testing::Test {
  static Parameters parameters() {
    Parameters parameters = default_parameters();
    parameters.robot = {};
    return parameters;
  }

  /// One request every 50 cycles: rad/s of the joint.
  void drive(double speed, std::uint64_t cycles) {
    for (std::uint64_t k = 0; k < cycles; ++k) {
      if (k % 50 == 0) loop.command({.linear = {}, .angular = {0, 0, speed}});
      step();
    }
  }
  void wait(std::uint64_t cycles) {
    for (std::uint64_t k = 0; k < cycles; ++k) step();
  }
  void step() {
    loop.step();
    recording.add(loop);
    fastest = std::max(fastest, std::abs(loop.row().driver->truth.joints[0].velocity));
  }
  double angle() const { return loop.row().driver->truth.joints[0].position; }
  const GateReport& gate() const { return loop.row().driver->gate; }
  std::string causes() const { return names_of(kStopCauseNames, loop.row().monitor->permit.causes); }

  RecordedLoop loop{parameters(), std::make_shared<Pendulum>(parameters())};
  Recording recording;
  double fastest = 0;  // rad/s
};

TEST_F(SecondKind, LiftsAsRequestedAndStopsWhenItsSenderIsSilent) {
  drive(1.0, 1000);
  EXPECT_NEAR(loop.row().driver->truth.joints[0].velocity, 1.0, 0.1);
  EXPECT_GT(angle(), 0.5);
  EXPECT_EQ(gate().verdict, GateVerdict::kPassed) << causes();
  wait(600);
  EXPECT_EQ(loop.row().controller->command.joints[0].velocity, 0);
}

TEST_F(SecondKind, AnEmergencyStopMovesItDownAndNothingHoldsItAfterwards) {
  drive(1.0, 1000);
  const double lifted = angle();
  loop.e_stop();
  wait(3);
  EXPECT_EQ(gate().verdict, GateVerdict::kBrake);
  fastest = 0;
  wait(397);
  EXPECT_LT(std::abs(angle()), 0.1 * lifted);
  EXPECT_LT(fastest, 1.5 * lifted / (JointStop::kFirstRateShare * kDownTime))
      << "1.5 times the speed of the reference (StopKind::kMove)";
  wait(2000);
  EXPECT_NEAR(angle(), 0, 0.01);
  EXPECT_EQ(loop.row().monitor->permit.causes, std::uint64_t{kCauseEmergencyStopService}) << causes();
}

TEST_F(SecondKind, AResetNeedsZeroFirstAndStandstillAsForWheels) {
  drive(1.0, 500);
  loop.e_stop();
  loop.e_stop_reset();
  wait(2);
  EXPECT_NE(loop.row().monitor->permit.causes, 0u);
  drive(0, 1500);
  loop.e_stop_reset();
  wait(2);
  EXPECT_EQ(loop.row().monitor->permit.causes, 0u)
      << causes() << ", refused: " << names_of(kResetRefusalNames, loop.row().monitor->permit.reset_refusal);
  drive(1.0, 500);
  EXPECT_GT(angle(), 0.2);
}

TEST_F(SecondKind, ALostControllerIsFollowedByItsStopActionWithinTheLifeOfACommand) {
  drive(1.0, 1000);
  loop.inject_fault("controller", "off");
  wait(kCommandLife + 1);
  EXPECT_EQ(gate().verdict, GateVerdict::kBrake);
  wait(500);
  EXPECT_LT(std::abs(angle()), 0.05);
  EXPECT_NE(loop.row().monitor->permit.causes & kCauseControllerLost, 0u) << causes();
}

TEST_F(SecondKind, ItsOwnConditionStopsItAndNamesTheJoint) {
  drive(2.0, 1500);
  EXPECT_EQ(loop.row().monitor->permit.causes, std::uint64_t{kCauseWheelSpeed}) << causes();
  EXPECT_EQ(loop.row().monitor->permit.evidence[0].joint, 0u);
}

TEST_F(SecondKind, ItsMotorFailsByTheNameOfItsJoint) {
  drive(1.0, 1000);
  const double lifted = angle();
  loop.inject_fault("pole_joint_motor", "off");
  wait(400);
  EXPECT_LT(angle(), 0.5 * lifted) << "nothing holds the pole";
}

TEST_F(SecondKind, ItsEncoderFailsByTheNameOfItsJoint) {
  drive(1.0, 500);
  loop.inject_fault("pole_joint_encoder", "off");
  wait(10);
  EXPECT_NE(loop.row().monitor->permit.causes & kCauseNotFinite, 0u) << causes();
}

TEST_F(SecondKind, HasNoSidesThatFail) {
  EXPECT_THROW(loop.inject_fault("left_motor", "off"), std::invalid_argument);
}

TEST_F(SecondKind, IsReplayedBitForBit) {
  drive(1.0, 1200);
  loop.e_stop();
  wait(1500);
  const ReplayReport report = recording.replay(loop.robot(), parameters().loop.period());
  EXPECT_TRUE(report.exact()) << text_of(report);
  for (const LawReport& law : report.laws) EXPECT_EQ(law.compared, recording.rows.size()) << text_of(report);
}

TEST_F(SecondKind, HasNoParametersThatChangeWhileItRuns) {
  EXPECT_THROW(loop.set_parameters("{max_linear_speed: 0.5}"), ParameterError);
}

TEST_F(SecondKind, ALiveTuningInItsLogIsForged) {
  std::vector<LoggedMessage> messages;
  const auto replayed = [&] { return replay(messages, recording.snapshots, loop.robot(), parameters().loop.period()); };
  for (int k = 0; k < 3; ++k) {
    step();
    log(loop.row(), 1, messages);
  }
  EXPECT_TRUE(replayed().exact()) << text_of(replayed());
  ControllerTrace forged = *loop.row().controller;
  forged.calls.tuned = 1;
  content_of<DriveTuning>(forged.tuning).count = 1;
  JoinedRow row = loop.row();
  row.controller = row.laws.controller = &forged;
  messages.pop_back();
  log(row, 1, messages);
  EXPECT_FALSE(replayed().exact());
}

}  // namespace robot_control::tests
