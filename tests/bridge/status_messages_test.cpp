#include "bridge/status_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/time.h>

namespace robot_control {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kPeriod = 1'000'000;  // ns

class SafetyStatusTest : public testing::Test {
 protected:
  SafetyStatusTest() {
    permit_.head = {.run = 7, .cycle = 1500, .stamp_ns = 1500 * kPeriod};
    permit_.action = PermitAction::kDrive;
    permit_.state = SupervisorState::kReady;
    permit_.since_cycle = 500;
  }

  msg::SafetyStatus message() const { return safety_status(permit_, absent_, time_, kPeriod); }

  Permit stopped() const {
    Permit stopped = permit_;
    stopped.state = SupervisorState::kStopped;
    stopped.causes = stopped.first_cause = kCauseEmergencyStopTopic;
    return stopped;
  }

  std::vector<std::string> absent_;
  TimeMap time_{ClockMode::kLockstep};  // stamps are ROS time
  Permit permit_;
};

TEST_F(SafetyStatusTest, SaysThatAHealthyRobotMayDrive) {
  const msg::SafetyStatus status = message();
  EXPECT_EQ(status.state, static_cast<int>(msg::SafetyStatus::READY));
  EXPECT_EQ(status.state_name, "READY");
  EXPECT_EQ(status.permit, static_cast<int>(msg::SafetyStatus::PERMIT_DRIVE));
  EXPECT_THAT(status.causes, IsEmpty());
  EXPECT_EQ(status.first_cause, "");
  EXPECT_EQ(status.run, 7u);
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
  const msg::SafetyStatus status = message();
  EXPECT_THAT(status.causes, ElementsAre("e_stop_topic", "controller_lost"));
  EXPECT_THAT(status.active, ElementsAre("controller_lost"));
  EXPECT_EQ(status.first_cause, "controller_lost");
  ASSERT_EQ(status.sentences.size(), 2u);
  ASSERT_EQ(status.remedies.size(), 2u);
  for (const std::string& text : status.remedies) EXPECT_THAT(text, Not(IsEmpty()));
}

TEST_F(SafetyStatusTest, NamesWhoIsMissingInInitAlone) {
  permit_.missing = kMissingState;
  EXPECT_THAT(message().missing, IsEmpty());
  permit_.state = SupervisorState::kInit;
  EXPECT_THAT(message().missing, ElementsAre(HasSubstr("state_estimator")));
}

TEST_F(SafetyStatusTest, TellsNewsFromRepetition) {
  Permit later = permit_;
  later.head.cycle += 1;
  EXPECT_FALSE(news(permit_, later));
  later.active = kCauseEmergencyStopTopic;
  EXPECT_TRUE(news(permit_, later));
  later = permit_;
  later.resets_handled = 1;
  EXPECT_TRUE(news(permit_, later));
}

TEST_F(SafetyStatusTest, AnswersAnAcceptedReset) {
  EXPECT_EQ(reset_text(stopped(), permit_, {}), "released");
}

TEST_F(SafetyStatusTest, DoesNotClaimToHaveReleasedWhatWasNotStopped) {
  EXPECT_EQ(reset_text(permit_, permit_, {}), "nothing was stopped");
}

TEST_F(SafetyStatusTest, AnswersARefusedResetWithTheSenders) {
  permit_.reset_refusal = kRefusalCommand;
  EXPECT_THAT(reset_text(stopped(), permit_, {"/send_cmd", "/teleop"}), HasSubstr("/send_cmd, /teleop"));
}

TEST_F(SafetyStatusTest, AnswersARefusedResetWithTheCauseThatPersists) {
  permit_.reset_refusal = kRefusalCauseActive;
  permit_.active = kCauseEmergencyStopTopic;
  EXPECT_THAT(reset_text(stopped(), permit_, {}), HasSubstr("e_stop"));
}

}  // namespace
}  // namespace robot_control
