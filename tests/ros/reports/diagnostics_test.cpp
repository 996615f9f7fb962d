#include "ros/reports/diagnostics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "signals/names.h"

namespace robot_control::tests {

using testing::HasSubstr;

std::string value_of(const DiagnosticReport& report, const std::string& key) {
  for (const diagnostic_msgs::KeyValue& pair : report.message().values) {
    if (pair.key == key) return pair.value;
  }
  return "(none)";
}

struct PermitReport : testing::Test {
  PermitReport() {
    permit_.state = SupervisorState::kDrive;
    permit_.action = PermitAction::kDrive;
    permit_.speed_limit = kNoSpeedLimit;
  }

  DiagnosticReport report() const {
    DiagnosticReport report("safety_monitor", "diffbot");
    report_permit(report, permit_, {});
    return report;
  }

  Permit permit_;
};

TEST_F(PermitReport, IsContentWithAHealthyRobot) {
  EXPECT_EQ(report().message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::OK));
  EXPECT_EQ(value_of(report(), "state"), "DRIVE");
  EXPECT_EQ(value_of(report(), "speed_limit_m_s"), "(none)");
}

TEST_F(PermitReport, WarnsOfWarnings) {
  permit_.warnings = kCauseBatteryLow;
  permit_.speed_limit = 0.3;
  EXPECT_EQ(report().message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::WARN));
  EXPECT_THAT(report().message().message, HasSubstr("the battery is low"));
  EXPECT_EQ(value_of(report(), "warnings"), "battery_low");
  EXPECT_EQ(value_of(report(), "speed_limit_m_s"), "0.3");
}

TEST_F(PermitReport, ACauseOutweighsAWarning) {
  permit_.warnings = kCauseBatteryLow;
  permit_.causes = kCauseTilt;
  EXPECT_EQ(report().message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::ERROR));
  EXPECT_THAT(report().message().message, HasSubstr("tilted too far"));
}

struct StateReport : testing::Test {
  StateReport() {
    state_.head.run = 1;
    state_.base.flags = kStateValid;
  }

  DiagnosticReport report(std::uint64_t slip_lately = 0) const {
    DiagnosticReport report("state_estimator", "diffbot");
    report_state(report, state_, slip_lately, {});
    return report;
  }

  StateFrame state_;
};

TEST_F(StateReport, IsContentWithAHealthyState) {
  EXPECT_EQ(report().message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::OK));
  EXPECT_EQ(value_of(report(), "slip"), "");
}

TEST_F(StateReport, WarnsOfASensorThatIsLost) {
  for (const std::uint64_t flag : {kStateNoGyro, kStateNoAccelerometer, kStateNoLeftEncoder, kStateNoRightEncoder}) {
    state_.base.flags = kStateValid | flag;
    EXPECT_EQ(report().message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::WARN));
    EXPECT_THAT(report().message().message, HasSubstr(sentences_of(kStateFlagNames, flag, {})));
    const BitName& row = *row_of(kStateFlagNames, flag);
    EXPECT_EQ(value_of(report(), "estimate: " + std::string(row.name)), row.sentence);
    EXPECT_EQ(value_of(report(), "estimate remedy: " + std::string(row.name)), row.remedy);
  }
}

TEST_F(StateReport, WarnsOfAStateThatIsNotValid) {
  state_.base.flags = 0;
  EXPECT_EQ(report().message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::WARN));
  EXPECT_THAT(report().message().message, HasSubstr("not valid"));
}

TEST_F(StateReport, GivesNoDeviationBeforeThereIsAState) {
  EXPECT_EQ(value_of(report(), "gyro_bias_z_deviation_deg_s"), "0");
  state_ = {};
  EXPECT_THAT(report().message().message, HasSubstr("not valid"));
  EXPECT_EQ(value_of(report(), "gyro_bias_z_deviation_deg_s"), "(none)");
  EXPECT_EQ(value_of(report(), "radius_ratio_deviation"), "(none)");
}

TEST_F(StateReport, WarnsOfSlipInWordsAlsoOfAMoment) {
  state_.wheeled.slip = kSlipSpinning | kSlipBlocked;
  EXPECT_THAT(report().message().message, HasSubstr("the wheels turn faster than the ground passes (reduce the "
                                                    "acceleration); "
                                                    "the wheels turn, but the robot stands"));
  EXPECT_EQ(value_of(report(), "slip"), "spinning blocked");
  EXPECT_EQ(value_of(report(), "slip: spinning"), "the wheels turn faster than the ground passes");
  EXPECT_EQ(value_of(report(), "slip remedy: spinning"), "reduce the acceleration");
  EXPECT_EQ(value_of(report(), "slip remedy: stalled"), "(none)");
  state_.wheeled.slip = 0;
  EXPECT_EQ(report(kSlipStalled).message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::WARN));
  EXPECT_THAT(report(kSlipStalled).message().message, HasSubstr("the wheels turn slower than the ground passes"));
  EXPECT_EQ(value_of(report(kSlipStalled), "slip"), "");
  EXPECT_EQ(value_of(report(kSlipStalled), "slip_lately"), "stalled");
}

TEST_F(StateReport, WarnsOfAPoseWhoseWheelsSlip) {
  state_.base.flags = kStateValid | kStateDegraded;
  state_.base.degraded = kDegradedPosition;
  EXPECT_EQ(report().message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::WARN));
  EXPECT_THAT(report().message().message, HasSubstr("wheels or feet contradict the IMU, as in a slip"));
  EXPECT_EQ(value_of(report(), "degraded"), "position");
  EXPECT_THAT(value_of(report(), "degraded remedy: position"), HasSubstr("the mounting of the IMU"));
}

TEST_F(StateReport, ReportsHowWellSlipIsNoticed) {
  for (const auto& [level, words] : {std::pair{0.0, "unknown: nothing was compared yet"},
                                     {1.2, "on"},
                                     {12.0, "slow: residuals 12 x the sensors' noise"},
                                     {60.0, "off: residuals 60 x the sensors' noise"}}) {
    state_.wheeled.residual_level = level;
    EXPECT_EQ(value_of(report(), "slip_detection"), words);
    EXPECT_EQ(report().message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::OK))
        << "the floor is as it is";
  }
}

TEST_F(StateReport, ReportsHowFarEachSensorAgrees) {
  state_.wheeled.confidence[kGyro] = 0.5;
  state_.wheeled.nis[kLateralContact] = 1.25;
  state_.wheeled.rejected[kVerticalContact] = 17;
  EXPECT_EQ(value_of(report(), "confidence_gyro"), "0.5");
  EXPECT_EQ(value_of(report(), "nis_lateral_contact"), "1.25");
  EXPECT_EQ(value_of(report(), "rejected_vertical_contact"), "17");
  for (const std::string_view sensor : kStateSensorNames) {
    EXPECT_NE(value_of(report(), "nis_" + std::string(sensor)), "(none)") << sensor;
  }
}

// 1 rad/s is 57.2958 °/s.
TEST_F(StateReport, ReportsTheSelfCalibration) {
  state_.wheeled.calibration = {
      .radius_ratio = 1.01, .wheel_base_factor = 0.98, .radius_ratio_deviation = 0.001, .wheel_base_deviation = 0.002};
  state_.base.gyro_bias = {0, 0, 1};
  state_.base.gyro_bias_deviation = {0, 1, 0};
  EXPECT_EQ(value_of(report(), "radius_ratio"), "1.01");
  EXPECT_EQ(value_of(report(), "radius_ratio_deviation"), "0.001");
  EXPECT_EQ(value_of(report(), "wheel_base_factor"), "0.98");
  EXPECT_EQ(value_of(report(), "wheel_base_deviation"), "0.002");
  EXPECT_EQ(value_of(report(), "gyro_bias_z_deg_s"), "57.2958");
  EXPECT_EQ(value_of(report(), "gyro_bias_y_deviation_deg_s"), "57.2958");
}

TEST(CommandReasons, AreEachAValueInWords) {
  CommandFrame command;
  command.reasons = kReasonTimedOut | kReasonHolding;
  command.requested.twist.linear[0] = 0.5;
  DiagnosticReport report("diff_drive_controller", "diffbot");
  report_command(report, command, command.reasons, {}, {});
  EXPECT_EQ(value_of(report, "reasons"), "timed_out holding");
  EXPECT_EQ(value_of(report, "command: timed_out"), "the last cmd_vel is older than cmd_vel_timeout");
  EXPECT_THAT(value_of(report, "command remedy: timed_out"), HasSubstr("publish on cmd_vel"));
  EXPECT_EQ(value_of(report, "command: holding"), "the command is zero: the brake holds the position");
  EXPECT_EQ(value_of(report, "command: no_command"), "(none)");
  EXPECT_EQ(value_of(report, "requested_m_s"), "0.5");
}

TEST(CommandReasons, OfIgnoredPartsNameThem) {
  CommandFrame command;
  command.reasons = kReasonPartIgnored;
  command.ignored = kPartLinearY | kPartMode;
  command.requests_partial = 3;
  DiagnosticReport report("diff_drive_controller", "diffbot");
  report_command(report, command, 0, {}, {});
  EXPECT_EQ(value_of(report, "ignored"), "linear.y mode");
  EXPECT_EQ(value_of(report, "commands_partly_ignored"), "3");
  EXPECT_EQ(value_of(report, "reasons"), "part_ignored");
}

TEST(CommandReasons, OfAMomentAreReported) {
  DiagnosticReport report("diff_drive_controller", "diffbot");
  report_command(report, {}, std::uint64_t{kReasonJerkYielded} | kReasonSaturated, {}, {});
  EXPECT_EQ(value_of(report, "reasons"), "");
  EXPECT_EQ(value_of(report, "reasons_lately"), "jerk_yielded saturated");
  EXPECT_EQ(report.message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::OK));
}

TEST(CommandReasons, ThatRefuseCommandsWarn) {
  for (const std::uint64_t bit :
       {kReasonRefused, kReasonStale, kReasonManySenders, kReasonRevoked, kReasonPartIgnored}) {
    DiagnosticReport report("diff_drive_controller", "diffbot");
    report_command(report, {}, bit, {}, {});
    EXPECT_EQ(report.message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::WARN));
    EXPECT_THAT(report.message().message, HasSubstr(sentences_of(kCommandReasonNames, bit, {})));
  }
}

TEST(CommandSenders, AreAValueAndWarnWhereThereIsMoreThanOne) {
  DiagnosticReport one("diff_drive_controller", "diffbot");
  report_command(one, {}, 0, {}, {"/teleop"});
  EXPECT_EQ(value_of(one, "senders"), "/teleop");
  EXPECT_EQ(one.message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::OK));
  DiagnosticReport two("diff_drive_controller", "diffbot");
  report_command(two, {}, 0, {}, {"/navigation", "/teleop"});
  EXPECT_EQ(value_of(two, "senders"), "/navigation, /teleop");
  EXPECT_EQ(two.message().level, static_cast<int>(diagnostic_msgs::DiagnosticStatus::WARN));
  EXPECT_THAT(two.message().message, HasSubstr("/navigation, /teleop"));
}

TEST(GateReasons, AreEachAValueInWords) {
  SensorFrame sensors;
  sensors.gate.reasons = kGatePermitBrake;
  DiagnosticReport report("mujoco_plant", "diffbot");
  report_driver(report, sensors, {}, {}, 1.0);
  EXPECT_EQ(value_of(report, "gate: permit_brake"), "the permit orders the brake");
  EXPECT_EQ(value_of(report, "gate remedy: permit_brake"), "check the cause in safety_status");
}

TEST(GateReasons, NameTheControllerOfTheRobot) {
  SensorFrame sensors;
  sensors.gate.reasons = kGateNoCommand;
  DiagnosticReport report("mujoco_plant", "quadbot");
  report_driver(report, sensors, {}, {.kind = kLeggedKind}, 1.0);
  EXPECT_EQ(value_of(report, "gate remedy: no_command"),
            "check that leg_controller runs and gets enough CPU time (scripts/doctor.py)");
}

}  // namespace robot_control::tests
