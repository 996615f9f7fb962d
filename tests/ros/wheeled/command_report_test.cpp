#include "ros/wheeled/command_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robot_control::tests {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kLookTick = 20'000'000;  // ns between two looks
constexpr std::int64_t kLookSecond = 1'000'000'000;

/// Unless said otherwise, two events are further apart than the report's gap.
class CommandReportTest : public testing::Test {
 protected:
  CommandReportTest() { frame_.head.run = 1; }

  /// A message arrives and is accepted.
  std::vector<ReportLine> receive(double linear, double angular, std::uint64_t reasons = 0,
                                  std::int64_t later_ns = kLookSecond) {
    frame_.head.stamp_ns += later_ns;
    ++frame_.requests_received;
    frame_.reasons = reasons;
    frame_.requested.twist.linear[0] = linear;
    frame_.requested.twist.angular[2] = angular;
    return report().update(frame_);
  }

  /// Continues with the same command and `reasons`; returns all lines until `seconds` later.
  std::vector<ReportLine> go_on(std::uint64_t reasons, double seconds = 1.5) {
    frame_.reasons = reasons;
    std::vector<ReportLine> lines;
    for (double t = 0; t < seconds; t += static_cast<double>(kLookTick) / 1e9) {
      frame_.head.stamp_ns += kLookTick;
      for (const ReportLine& line : report().update(frame_)) lines.push_back(line);
    }
    return lines;
  }

  std::vector<ReportLine> refuse() {
    frame_.head.stamp_ns += kLookSecond;
    ++frame_.requests_received;
    ++frame_.requests_refused;
    frame_.reasons = kReasonRefused;
    frame_.requested.twist = {};
    return report().update(frame_);
  }

  std::vector<ReportLine> time_out() {
    frame_.head.stamp_ns += kLookSecond;
    ++frame_.timeouts;
    frame_.reasons = kReasonTimedOut;
    frame_.requested.twist = {};
    return report().update(frame_);
  }

  CommandReport& report() { return report_; }

  CommandFrame frame_;

 private:
  static DriveTrain robot() {
    DriveTrain robot;
    robot.wheel_base = 0.5;
    robot.wheels = {WheelModel{.joint = 0, .radius = 0.1}, WheelModel{.joint = 1, .radius = 0.1, .side = Side::kRight}};
    robot.joints.resize(2);
    return robot;
  }

  static DriveControllerParameters parameters() {
    DriveControllerParameters parameters;
    parameters.max_linear_speed = 1.0;
    parameters.max_angular_speed = 2.0;
    parameters.cmd_vel_timeout = 1.25;
    return parameters;
  }

  CommandReport report_{robot(), parameters()};
};

TEST_F(CommandReportTest, ReportsTheWheelSpeedsOfTheArticlesCommand) {
  // 0.5 ∓ 0.2 · 0.5 / 2
  const std::vector<ReportLine> lines = receive(0.5, 0.2);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_FALSE(lines[0].warning);
  EXPECT_THAT(lines[0].text, HasSubstr("left 0.45 m/s, right 0.55 m/s"));
}

TEST_F(CommandReportTest, RoundsWhatASendersArithmeticLeft) {
  const auto lines = receive(0.5, 1.04854e-14);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text, "left 0.50 m/s, right 0.50 m/s (cmd_vel 0.5 m/s, 0 rad/s)");
}

TEST_F(CommandReportTest, ReportsTheSpeedsAfterTheLimits) {
  // 3 m/s is thrice the limit, so both axes are divided by 3: 1 ∓ 0.4 · 0.5 / 2
  EXPECT_THAT(receive(3, 1.2)[0].text, HasSubstr("left 0.90 m/s, right 1.10 m/s (cmd_vel 3 m/s, 1.2 rad/s, "
                                                 "limited to 1 m/s, 0.4 rad/s)"));
}

TEST_F(CommandReportTest, GoesByTheLimitsThatHold) {
  DriveControllerParameters other;
  other.max_angular_speed = 0.1;
  other.cmd_vel_timeout = 0.4;
  report().limit(other);
  EXPECT_THAT(receive(0.5, 0.2).at(0).text, HasSubstr("limited to 0.25 m/s, 0.1 rad/s"));
  EXPECT_THAT(time_out().at(0).text, HasSubstr("no cmd_vel for 0.4 s"));
}

TEST_F(CommandReportTest, SpeaksOfNoLimitWhereNoneWasMet) {
  EXPECT_THAT(receive(1, 2)[0].text, Not(HasSubstr("limited")));
}

TEST_F(CommandReportTest, IsSilentWhileTheValueStays) {
  receive(0.5, 0.2);
  EXPECT_THAT(receive(0.5, 0.2), IsEmpty());
  EXPECT_THAT(report().update(frame_), IsEmpty());
}

TEST_F(CommandReportTest, ReportsAChangedValue) {
  receive(0.5, 0.2);
  EXPECT_EQ(receive(0.5, 0.0).size(), 1u);
}

TEST_F(CommandReportTest, WarnsOncePerTimeout) {
  receive(0.5, 0.2);
  const std::vector<ReportLine> lines = time_out();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].warning);
  EXPECT_THAT(lines[0].text, HasSubstr("1.25 s"));
  EXPECT_THAT(report().update(frame_), IsEmpty());
  EXPECT_EQ(receive(0.5, 0.2).size(), 1u) << "the motion begins again: reported again";
}

TEST_F(CommandReportTest, DoesNotWarnWhenAStandingRobotIsLeftAlone) {
  receive(0, 0);
  EXPECT_THAT(time_out(), IsEmpty());
}

TEST_F(CommandReportTest, LeavesARefusalToTheWarningOfTheInputAndReportsTheNextCommand) {
  receive(0.5, 0.2);
  EXPECT_THAT(refuse(), IsEmpty());
  EXPECT_EQ(receive(0.5, 0.2).size(), 1u);
}

TEST_F(CommandReportTest, LeavesStampsAndSendersToTheirOwnWarnings) {
  receive(0.5, 0.2);
  ++frame_.requests_received;
  ++frame_.requests_refused;
  ++frame_.requests_stale;
  frame_.reasons = kReasonStale;
  EXPECT_THAT(report().update(frame_), IsEmpty()) << "the command before it stands";
  ++frame_.requests_received;
  ++frame_.requests_refused;
  ++frame_.requests_crowded;
  frame_.reasons = kReasonManySenders;
  frame_.requested.twist = {};
  EXPECT_THAT(report().update(frame_), IsEmpty()) << "no zero was commanded";
}

TEST_F(CommandReportTest, ReportsWhatIsDoneAndNotWhatIsRequestedWhileTheRobotIsStopped) {
  for (const std::uint64_t reason : {kReasonPermitBrake, kReasonPermitRamp, kReasonNoPermit, kReasonBadSensors}) {
    ++frame_.head.run;
    const std::vector<ReportLine> lines = receive(0.5, 0.2, reason | kReasonAccelerationLimited);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_THAT(lines[0].text, HasSubstr("cmd_vel 0.5 m/s, 0.2 rad/s has no effect: "));
    EXPECT_THAT(lines[0].text, Not(HasSubstr("left")));
    EXPECT_TRUE(lines[0].warning);
  }
}

TEST_F(CommandReportTest, ReportsThatAStopEndedTheEffectAndThatAReleaseRestoredIt) {
  receive(0.5, 0.2);
  std::vector<ReportLine> lines = go_on(kReasonPermitBrake);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0].text,
              HasSubstr("has no effect: the permit orders the brake (check the cause in safety_status)"));
  lines = go_on(0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0].text, HasSubstr("left 0.45 m/s, right 0.55 m/s"));
}

TEST_F(CommandReportTest, ASingleLateCycleIsNoStop) {
  receive(0.5, 0.2);
  EXPECT_THAT(go_on(kReasonNoPermit, 0.02), IsEmpty());
  EXPECT_THAT(go_on(0), IsEmpty());
}

TEST_F(CommandReportTest, ReportsThatTheMonitorSlowsItDown) {
  EXPECT_THAT(receive(0.5, 0.2, kReasonPermitSlow).at(0).text, HasSubstr("but the safety monitor limits the speed"));
}

TEST_F(CommandReportTest, AStandingRobotThatIsCommandedToStandIsNoNews) {
  EXPECT_THAT(receive(0, 0), IsEmpty());
  EXPECT_THAT(go_on(kReasonPermitBrake), IsEmpty());
  EXPECT_THAT(go_on(0), IsEmpty());
}

TEST_F(CommandReportTest, AChangingCommandIsReportedOnceASecond) {
  std::size_t lines = 0;
  for (int i = 0; i < 200; ++i) lines += receive(0.2 + 0.001 * i, 0.3, 0, kLookSecond / 20).size();
  EXPECT_GE(lines, 9u);
  EXPECT_LE(lines, 10u);
}

TEST_F(CommandReportTest, TheLastOfManyChangesIsReported) {
  receive(0.5, 0.2);
  EXPECT_THAT(receive(0.1, 0, 0, kLookTick), IsEmpty());
  EXPECT_THAT(receive(0.3, 0, 0, kLookTick), IsEmpty());
  const std::vector<ReportLine> lines = go_on(0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0].text, HasSubstr("left 0.30 m/s"));
}

TEST_F(CommandReportTest, AChangeThatNoWheelShowsIsNoNews) {
  receive(0.5, 0.2);
  EXPECT_THAT(receive(0.504, 0.2), IsEmpty());
}

TEST_F(CommandReportTest, TimeoutsOfAFlickeringSenderAreReportedOnceASecond) {
  std::size_t lines = 0;
  for (int i = 0; i < 100; ++i) {
    lines += receive(0.5, 0.2, 0, kLookTick).size();
    ++frame_.timeouts;
    frame_.head.stamp_ns += kLookTick;
    lines += report().update(frame_).size();
  }
  EXPECT_LE(lines, 2u * 4 + 2) << "two kinds, 4 s";
}

TEST_F(CommandReportTest, RestartsWithARun) {
  receive(0.5, 0.2);
  frame_ = {};
  frame_.head.run = 2;
  EXPECT_EQ(receive(0.5, 0.2).size(), 1u);
}

TEST_F(CommandReportTest, NamesThePartsThatTheRobotIgnores) {
  frame_.ignored = kPartLinearY;
  const std::vector<ReportLine> lines = receive(0, 0, kReasonPartIgnored);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].warning);
  EXPECT_THAT(lines[0].text, HasSubstr("linear.y, but a part of the request is ignored"));
}

}  // namespace robot_control::tests
