#include "ros/reports/stop_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ros/messages/status_messages.h"
#include "signals/names.h"

namespace robot_control::tests {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr double kLogPeriod = 0.001;  // s
constexpr std::uint64_t kLogSecond = 1000;

/// A robot that has just become ready; its permits pass through the message, as in the node.
class StopLogTest : public testing::Test {
 protected:
  StopLogTest() {
    permit_.head = {.run = 7, .cycle = 10};
    permit_.speed_limit = kNoSpeedLimit;
    robot_.joints.resize(1);
    robot_.joints[0].name = "left_wheel_joint";
    permit_.missing = kMissingState;
    report();
    permit_.missing = 0;
    enter(SupervisorState::kReady);
  }

  std::string report() { return report(message()); }

  /// "W text" and "I text", a line each.
  std::string report(const SafetyStatus& status) {
    std::string text;
    for (const ReportLine& line : log_.update(status)) text += (line.warning ? "W " : "I ") + line.text + "\n";
    return text;
  }

  std::string enter(SupervisorState state) {
    ++permit_.head.cycle;
    permit_.state = state;
    return report();
  }

  std::string stop(std::uint64_t causes, SupervisorState state = SupervisorState::kStopped) {
    if (permit_.causes == 0) permit_.first_cause = causes & -causes;
    permit_.causes |= causes;
    return enter(state);
  }

  std::string release() {
    permit_.causes = permit_.first_cause = 0;
    return enter(SupervisorState::kReady);
  }

  SafetyStatus message() const { return safety_status(permit_, robot_, {}, time_, 1'000'000, {}); }

  StopLog log_{kLogPeriod, 1.25};
  Permit permit_;

 private:
  DriveTrain robot_;
  TimeMap time_{ClockMode::kLockstep};
};

TEST_F(StopLogTest, SaysOnceThatTheRobotIsReady) {
  enter(SupervisorState::kInit);
  EXPECT_EQ(enter(SupervisorState::kReady), "I ready: send cmd_vel\n");
  EXPECT_EQ(enter(SupervisorState::kDrive), "");
  EXPECT_EQ(enter(SupervisorState::kReady), "");
}

TEST_F(StopLogTest, SaysStateCauseValueLimitAndRemedyOfAStop) {
  permit_.evidence[0] = {.cause = kCauseStall, .joint = 0, .value = 0.6, .limit = 0.5};
  EXPECT_EQ(stop(kCauseStall),
            "W STOPPED: stall: a wheel does not turn although motion is commanded (0.6 rad, limit 0.5 rad, "
            "left_wheel_joint). "
            "To drive again: check for a blocked wheel, then motor and encoder, then call e_stop_reset\n");
  EXPECT_EQ(report(), "");
}

TEST_F(StopLogTest, EveryCauseOfTheTableGivesOneLineWithItsRemedyAndTheReset) {
  for (const BitName& row : kStopCauseNames) {
    const std::string line = stop(row.bit);
    EXPECT_THAT(line, AllOf(StartsWith("W STOPPED: " + std::string(row.name) + ": " + std::string(row.sentence)),
                            EndsWith("call e_stop_reset\n")));
    EXPECT_EQ(std::ranges::count(line, '\n'), 1);
    EXPECT_EQ(line.find("e_stop_reset"), line.rfind("e_stop_reset")) << line;
    EXPECT_EQ(release(), "I released: READY; send cmd_vel\n");
  }
}

TEST_F(StopLogTest, SeveralCausesAtOnceAreOneLineWithTheFirstInFront) {
  permit_.first_cause = kCauseStall;
  permit_.causes = kCauseStall | kCauseEmergencyStopService;
  EXPECT_EQ(
      enter(SupervisorState::kStopped),
      "W STOPPED: stall: a wheel does not turn although motion is commanded; e_stop_service: an emergency stop "
      "was requested. To drive again: check for a blocked wheel, then motor and encoder, then call e_stop_reset\n");
}

TEST_F(StopLogTest, ACauseThatLatchesLaterHasALineOfItsOwn) {
  stop(kCauseEmergencyStopService);
  EXPECT_THAT(stop(kCauseHeartbeatLost), StartsWith("W STOPPED: heartbeat_lost: "));
}

TEST_F(StopLogTest, SaysThatARampBeginsAndEnds) {
  EXPECT_THAT(stop(kCauseHeartbeatLost, SupervisorState::kStopping), StartsWith("W STOPPING: heartbeat_lost"));
  EXPECT_EQ(enter(SupervisorState::kStopped), "I STOPPED: the ramp has ended, the robot brakes\n");
}

TEST_F(StopLogTest, ALookWithoutAPermitReleasesNothing) {
  stop(kCauseEmergencyStopService);
  EXPECT_EQ(report(waiting_status({"mujoco_plant"})), "");
  EXPECT_EQ(report(), "") << "the same latch";
  EXPECT_EQ(release(), "I released: READY; send cmd_vel\n");
  EXPECT_THAT(stop(kCauseEmergencyStopService), StartsWith("W STOPPED: e_stop_service")) << "a new one";
}

TEST_F(StopLogTest, AReleaseThatWaitsForAZeroFirstIsTwoEvents) {
  stop(kCauseEmergencyStopService);
  permit_.causes = permit_.first_cause = 0;
  EXPECT_EQ(enter(SupervisorState::kInit), "");
  EXPECT_EQ(enter(SupervisorState::kReady), "I released: READY; send cmd_vel\n");
}

TEST_F(StopLogTest, SaysOnceThatItWaitsForAZeroRequestWhenSilenceWouldHaveEndedTheWait) {
  SafetyStatus status = message();
  status.state = SafetyStatus::INIT;
  status.state_name = "INIT";
  status.awaiting_zero_request = 1;
  std::vector<std::string> said;
  for (std::uint64_t i = 0; i < 5 * kLogSecond; i += 20) {
    status.cycle = 100 + i;
    if (const std::string text = report(status); !text.empty()) said.push_back(std::to_string(i) + " " + text);
  }
  EXPECT_THAT(
      said,
      ElementsAre("1500 W INIT: waiting for a zero velocity command; stop publishing for 1.25 s, or publish zero\n"));
  status.awaiting_zero_request = 0;
  report(status);
  status.awaiting_zero_request = 1;
  report(status);
  status.cycle += 2 * kLogSecond;
  EXPECT_THAT(report(status), HasSubstr("waiting for a zero velocity command")) << "another wait";
}

TEST_F(StopLogTest, SaysNothingOfAWaitThatSilenceEnds) {
  SafetyStatus status = message();
  status.state = SafetyStatus::INIT;
  status.awaiting_zero_request = 1;
  report(status);
  status.cycle += 1260;
  EXPECT_EQ(report(status), "");
}

TEST_F(StopLogTest, AWarningIsSaidWhenItBeginsAndNotEachTimeItFlickers) {
  permit_.speed_limit = 0.3;
  std::string said;
  for (std::uint64_t i = 0; i < 9 * kLogSecond; i += 20) {
    permit_.head.cycle += 20;
    permit_.warnings = i % 40 == 0 ? std::uint64_t{kCauseImuStuck} : 0;
    said += report();
  }
  EXPECT_THAT(said, AllOf(StartsWith("W warning: imu_stuck: "), EndsWith("; at most 0.3 m/s\n")));
  EXPECT_EQ(std::ranges::count(said, '\n'), 1);
  permit_.head.cycle += 2 * kLogSecond;
  permit_.warnings = 0;
  EXPECT_EQ(report(), "");
  permit_.warnings = kCauseImuStuck;
  EXPECT_THAT(report(), StartsWith("W warning: imu_stuck: "));
}

TEST_F(StopLogTest, SaysThatTheWayIsNotFree) {
  permit_.speed_limit = 0;
  EXPECT_THAT(report(), HasSubstr("the free distance (clearance) is 0"));
  EXPECT_EQ(report(), "");
}

TEST_F(StopLogTest, AWarningOfTheMachineDoesNotHideThatTheWayIsNotFree) {
  SafetyStatus status = message();
  status.warnings = {"torque_not_measured"};
  status.warning_sentences = {"drives measure no torque"};
  status.speed_limit = 0;
  const std::string said = report(status);
  EXPECT_THAT(said, HasSubstr("W warning: torque_not_measured: drives measure no torque\n"));
  EXPECT_THAT(said, HasSubstr("the free distance (clearance) is 0"));
}

TEST_F(StopLogTest, IsSilentWhileAHealthyRobotDrives) {
  for (int i = 0; i < 1000; ++i) {
    permit_.head.cycle += 100;
    EXPECT_EQ(enter(i % 2 == 0 ? SupervisorState::kDrive : SupervisorState::kReady), "");
  }
}

}  // namespace robot_control::tests
