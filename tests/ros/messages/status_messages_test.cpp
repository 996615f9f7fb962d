#include "ros/messages/status_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/time.h>

namespace robot_control::tests {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kPeriod = 1'000'000;  // ns

struct SafetyStatusTest : testing::Test {
  SafetyStatusTest() {
    permit_.head = {.run = 7, .cycle = 1500, .stamp_ns = 1500 * kPeriod};
    permit_.action = PermitAction::kDrive;
    permit_.state = SupervisorState::kReady;
    permit_.since_cycle = 500;
    permit_.speed_limit = kNoSpeedLimit;
    robot_.joints.resize(2);
    robot_.joints[0].name = "left_wheel_joint";
    robot_.joints[1].name = "right_wheel_joint";
  }

  SafetyStatus message() const { return safety_status(permit_, robot_, absent_, time_, kPeriod, {}); }

  Permit stopped() const {
    Permit stopped = permit_;
    stopped.state = SupervisorState::kStopped;
    stopped.causes = stopped.first_cause = kCauseEmergencyStopTopic;
    return stopped;
  }

  std::vector<std::string> absent_;
  TimeMap time_{ClockMode::kLockstep};  // stamps are ROS time
  Permit permit_;
  DriveTrain robot_;
};

TEST_F(SafetyStatusTest, SaysThatAHealthyRobotMayDrive) {
  const SafetyStatus status = message();
  EXPECT_EQ(status.state, static_cast<int>(SafetyStatus::READY));
  EXPECT_EQ(status.state_name, "READY");
  EXPECT_EQ(status.permit, static_cast<int>(SafetyStatus::PERMIT_DRIVE));
  EXPECT_THAT(status.causes, IsEmpty());
  EXPECT_EQ(status.first_cause, "");
  EXPECT_EQ(status.run, 7u);
}

TEST_F(SafetyStatusTest, NamesTheConditionsThatAreBlindWithoutATorque) {
  SensorFrame sensors;
  sensors.joint_count = 2;
  const auto warnings = [&](std::uint32_t valid) {
    for (JointSample& joint : sensors.joints) joint.valid = valid;
    SafetyStatus status = message();
    warn_of_blind_conditions(sensors, status);
    EXPECT_EQ(status.warning_sentences.size(), status.warnings.size());
    return status.warnings;
  };
  EXPECT_THAT(warnings(kValidKinematics), testing::ElementsAre("torque_not_measured"));
  EXPECT_THAT(warnings(kValidMotion), IsEmpty());
  EXPECT_THAT(warnings(0), IsEmpty()) << "before the first sample";
}

TEST_F(SafetyStatusTest, DatesTheStateByItsFirstCycle) {
  EXPECT_DOUBLE_EQ(message().since.toSec(), 0.5);
  EXPECT_DOUBLE_EQ(message().header.stamp.toSec(), 1.5);
}

TEST_F(SafetyStatusTest, HasASentenceAndARemedyForEveryCause) {
  permit_.state = SupervisorState::kStopped;
  permit_.causes = kCauseEmergencyStopTopic | kCauseControllerLost;
  permit_.active = kCauseControllerLost;
  permit_.first_cause = kCauseControllerLost;
  const SafetyStatus status = message();
  EXPECT_THAT(status.causes, ElementsAre("e_stop_topic", "controller_lost"));
  EXPECT_THAT(status.active, ElementsAre("controller_lost"));
  EXPECT_EQ(status.first_cause, "controller_lost");
  ASSERT_EQ(status.sentences.size(), 2u);
  ASSERT_EQ(status.remedies.size(), 2u);
  for (const std::string& text : status.remedies) EXPECT_THAT(text, Not(IsEmpty()));
}

TEST_F(SafetyStatusTest, NamesTheActorOfEveryCause) {
  permit_.causes = kCauseEmergencyStopTopic | kCauseControllerLost | kCauseStall;
  EXPECT_THAT(message().actors, ElementsAre("operator", "integrator", "technician"));
}

TEST_F(SafetyStatusTest, HasWhatWasMeasuredBesideItsCause) {
  permit_.causes = kCauseEmergencyStopTopic | kCauseWheelSpeed | kCauseTilt;
  permit_.evidence[0] = {.cause = kCauseTilt, .value = 0.4, .limit = 0.35};
  permit_.evidence[1] = {.cause = kCauseWheelSpeed, .joint = 0, .value = 17.3, .limit = 15};
  EXPECT_THAT(message().details,
              ElementsAre("", "17.3 rad/s, limit 15 rad/s, left_wheel_joint", "0.4 rad, limit 0.35 rad"));
}

// The evidence is of a joint of another robot's model, or of a cause without room for evidence.
TEST_F(SafetyStatusTest, InventsNoEvidence) {
  permit_.causes = kCauseTilt;
  EXPECT_THAT(message().details, ElementsAre(""));
  permit_.evidence[0] = {.cause = kCauseTilt, .joint = 7, .value = 0.4, .limit = 0.35};
  EXPECT_THAT(message().details, ElementsAre("0.4 rad, limit 0.35 rad"));
}

TEST_F(SafetyStatusTest, ReportsWarningsBesideTheCauses) {
  permit_.warnings = kCauseBatteryLow;
  permit_.evidence[0] = {.cause = kCauseBatteryLow, .value = 20.9, .limit = 21};
  const SafetyStatus status = message();
  EXPECT_THAT(status.warnings, ElementsAre("battery_low"));
  EXPECT_THAT(status.warning_sentences,
              ElementsAre("the battery is low: 20.9 V, limit 21 V (charge the battery soon)"));
  EXPECT_THAT(status.causes, IsEmpty());
}

// Every reaction can be set: by default imu_lost slows down and tilt brakes.
TEST_F(SafetyStatusTest, AsksForAResetOfWhatLatchedAlone) {
  permit_.causes = kCauseImuLost | kCauseEmergencyStopService;
  permit_.warnings = kCauseTilt;
  const SafetyStatus status = message();
  ASSERT_THAT(status.causes, ElementsAre("e_stop_service", "imu_lost"));
  EXPECT_EQ(status.remedies[0], "call e_stop_reset");
  EXPECT_THAT(status.remedies_before_reset, ElementsAre("", Not(HasSubstr("e_stop_reset"))));
  EXPECT_EQ(status.remedies[1], status.remedies_before_reset[1] + ", then call e_stop_reset");
  ASSERT_EQ(status.warning_sentences.size(), 1u);
  EXPECT_THAT(status.warning_sentences[0], Not(HasSubstr("e_stop_reset")));
}

TEST_F(SafetyStatusTest, ReportsTheSpeedLimitWhereThereIsOne) {
  EXPECT_EQ(message().speed_limit, std::numeric_limits<double>::infinity());
  EXPECT_EQ(waiting_status({}).speed_limit, std::numeric_limits<double>::infinity());
  permit_.speed_limit = 0.3;
  EXPECT_EQ(message().speed_limit, 0.3);
}

TEST_F(SafetyStatusTest, NamesTheMissingNodeInInitAlone) {
  permit_.missing = kMissingState;
  EXPECT_THAT(message().missing, IsEmpty());
  permit_.state = SupervisorState::kInit;
  EXPECT_THAT(message().missing, ElementsAre(HasSubstr("state_estimator")));
}

TEST_F(SafetyStatusTest, DistinguishesNewsFromRepetition) {
  Permit later = permit_;
  later.head.cycle += 1;
  EXPECT_FALSE(differs(permit_, later));
  later.active = kCauseEmergencyStopTopic;
  EXPECT_TRUE(differs(permit_, later));
  later = permit_;
  later.resets_handled = 1;
  EXPECT_TRUE(differs(permit_, later));
  later = permit_;
  later.warnings = kCauseBatteryLow;
  EXPECT_TRUE(differs(permit_, later));
  later = permit_;
  later.speed_limit = 0.3;
  EXPECT_TRUE(differs(permit_, later));
}

TEST_F(SafetyStatusTest, AnswersAnAcceptedReset) {
  EXPECT_EQ(reset_text(stopped(), permit_, {}, {}), "released");
}

TEST_F(SafetyStatusTest, DoesNotClaimToHaveReleasedWhatWasNotStopped) {
  EXPECT_EQ(reset_text(permit_, permit_, {}, {}), "nothing was stopped");
}

TEST_F(SafetyStatusTest, AnswersARefusedResetWithTheSenders) {
  permit_.reset_refusal = kRefusalCommand;
  EXPECT_THAT(reset_text(stopped(), permit_, {.commands = {"/send_cmd", "/teleop"}, .e_stop = {}}, {}),
              HasSubstr("/send_cmd, /teleop"));
}

TEST_F(SafetyStatusTest, AnswersARefusedResetWithTheCauseThatPersists) {
  permit_.reset_refusal = kRefusalCauseActive;
  permit_.active = kCauseEmergencyStopTopic;
  EXPECT_THAT(reset_text(stopped(), permit_, {.commands = {}, .e_stop = {"/panel", "/gate"}}, {}),
              HasSubstr("true on e_stop: /panel, /gate"));
}

TEST(RobotKindMessage, NamesTheNodesOfTheRobotsKindAndItsJoints) {
  MachineModel robot;
  robot.name = "quadbot";
  robot.joints.resize(3);
  robot.joints[0].name = "knee";
  robot.joints[1].name = "camera";
  robot.joints[1].role = JointRole::kHeld;
  robot.joints[2].name = "swivel";
  robot.joints[2].role = JointRole::kPassive;
  const RobotKind message = robot_kind(robot, {.kind = kLeggedKind, .driver = "driver"}, false);
  EXPECT_EQ(message.robot, "quadbot");
  EXPECT_EQ(message.kind, "quadruped");
  EXPECT_THAT(message.roles, ElementsAre("driver", "estimator", "controller", "monitor"));
  EXPECT_THAT(message.nodes, ElementsAre("driver", "state_estimator", "leg_controller", "safety_monitor"));
  EXPECT_THAT(message.joints, ElementsAre("knee", "camera", "swivel"));
  EXPECT_THAT(message.joint_roles, ElementsAre("driven", "held", "passive"));
  EXPECT_THAT(message.fault_components, IsEmpty());
  const RobotKind simulated = robot_kind(robot, {.kind = kLeggedKind}, true);
  EXPECT_THAT(simulated.fault_components, testing::Contains("knee_motor"));
  EXPECT_THAT(simulated.fault_components, testing::Contains("camera_motor"));
  EXPECT_THAT(simulated.fault_components, Not(testing::Contains("swivel_motor")));
  EXPECT_THAT(simulated.fault_kinds, testing::Contains("stuck"));
}

TEST_F(SafetyStatusTest, ARemedyNamesTheProgramsOfTheRobot) {
  permit_.causes = kCauseControllerLost | kCauseDriverLost;
  const Programs programs{.kind = kLeggedKind, .driver = "driver"};
  const SafetyStatus status = safety_status(permit_, robot_, absent_, time_, kPeriod, programs);
  EXPECT_THAT(status.remedies_before_reset,
              ElementsAre("check that driver runs and gets enough CPU time (scripts/doctor.py)",
                          "check that leg_controller runs and gets enough CPU time (scripts/doctor.py)"));
}

}  // namespace robot_control::tests
