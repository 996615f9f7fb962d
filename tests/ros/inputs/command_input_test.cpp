#include "ros/inputs/command_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

#include "ros/nanoseconds.h"

namespace robot_control::tests {

using testing::HasSubstr;
using testing::IsEmpty;

/// One node sends every 0.1 s, on the robot's clock.
struct CommandInputTest : testing::Test {
  void receive(const std::string& sender, double linear, std::int64_t stamp_ns = 0) {
    ArrivedCommand arrived{.sender = publisher(sender), .twist = {}, .stamp_ns = stamp_ns};
    arrived.twist.linear[0] = linear;
    input_.receive(arrived, now_);
  }

  /// The same process for the same name until `restart`, and the same connection until `reopen`.
  Publisher publisher(const std::string& name) {
    Publisher& publisher = publishers_[name];
    if (publisher.name.empty())
      publisher = {name, boost::make_shared<char>(), std::to_string(++processes_), "cmd_vel_stamped"};
    return publisher;
  }

  void reopen(const std::string& sender) { publishers_[sender].connection = boost::make_shared<char>(); }
  void restart(const std::string& sender) { publishers_.erase(sender); }

  void receive_stamped(const std::string& sender, double linear, std::int64_t age_ns = 0) {
    receive(sender, linear, now_.ros_ns - age_ns);
  }

  void pass(std::int64_t time_ns) {
    now_.ros_ns += time_ns;
    now_.loop_ns += time_ns;
  }

  const VelocityCommand& value() const { return input_.value(); }

  std::string reported() {
    std::string text;
    for (const ReportLine& line : input_.lines()) text += (line.warning ? "W " : "I ") + line.text + "\n";
    return text;
  }

  ArrivalTime now_{.ros_ns = 1'700'000'000 * kSecond, .loop_ns = 5000 * kSecond};
  CommandInput input_{1.25, false};
  std::map<std::string, Publisher> publishers_;
  int processes_ = 0;
};

TEST_F(CommandInputTest, PassesOnWhatOneNodeSends) {
  receive("/teleop", 0.5);
  EXPECT_EQ(value().count, 1u);
  EXPECT_EQ(value().content.twist.linear[0], 0.5);
  EXPECT_EQ(value().age_ns, 0);
  pass(kSecond / 10);
  receive_stamped("/teleop", 0.3, kSecond / 50);
  EXPECT_EQ(value().count, 2u);
  EXPECT_EQ(value().content.twist.linear[0], 0.3);
  EXPECT_EQ(value().age_ns, kSecond / 50);
  EXPECT_EQ(reported(), "");
}

TEST_F(CommandInputTest, AStampTooOldOrOfTheFutureIsRefusedAndTheCommandBeforeStands) {
  receive_stamped("/teleop", 0.5);
  receive_stamped("/teleop", 0.9, 2 * kSecond);
  receive_stamped("/teleop", 0.9, -kHour);
  EXPECT_EQ(value().count, 1u);
  EXPECT_EQ(value().stale, 2u);
  EXPECT_EQ(value().content.twist.linear[0], 0.5);
}

TEST_F(CommandInputTest, AClockThatIsAnHourOffIsReportedOnce) {
  for (int i = 0; i < 36'000; ++i) {
    receive_stamped("/teleop", 0.5, kHour);
    pass(kSecond / 10);
  }
  EXPECT_EQ(value().stale, 36'000u);
  EXPECT_EQ(value().count, 0u);
  EXPECT_EQ(reported(),
            "W cmd_vel_stamped of /teleop is 3600 s old by its stamp, more than cmd_vel_timeout (1.25 s): refused; it "
            "was delayed, or the clock of its sender is behind; synchronise it (chrony), or publish without "
            "a stamp: the age then counts from the arrival\n");
  receive_stamped("/teleop", 0.5, -kHour);
  EXPECT_THAT(reported(), HasSubstr("/teleop is stamped 3600 s in the future")) << "that is another fault";
  receive_stamped("/ahead", 0.5, -kHour);
  EXPECT_THAT(reported(),
              HasSubstr("/ahead is stamped 3600 s in the future, more than the allowed clock difference (0.1 s)"));
}

TEST_F(CommandInputTest, AClockThatFlickersIsReportedEveryTenSecondsAtMost) {
  std::size_t lines = 0;
  for (int i = 0; i < 300; ++i) {  // 60 s
    receive_stamped("/teleop", 0.5, i % 2 == 0 ? kHour : 0);
    pass(kSecond / 5);
    lines += input_.lines().size();
  }
  EXPECT_EQ(lines, 6u);
}

// The time of day jumps between two messages, and sender and robot share it: neither message looks old.
TEST_F(CommandInputTest, AJumpOfACommonClockRefusesNothing) {
  for (const std::int64_t jump : {kHour, -kHour, kSecond, -kSecond}) {
    now_.ros_ns += jump;
    receive_stamped("/teleop", 0.5);
    EXPECT_EQ(value().stale, 0u) << jump;
    EXPECT_EQ(value().age_ns, 0);
    pass(kSecond / 10);
  }
  EXPECT_EQ(value().count, 4u);
}

// The clock may also jump while a message is under way: that message alone is refused.
TEST_F(CommandInputTest, AJumpWhileAMessageIsUnderWayCostsThatMessage) {
  for (const std::int64_t jump : {kHour, -kHour}) {
    const std::int64_t stamp_ns = now_.ros_ns;
    const std::uint64_t count = value().count;
    const std::uint64_t stale = value().stale;
    now_.ros_ns += jump;
    receive("/teleop", 0.9, stamp_ns);
    EXPECT_EQ(value().stale, stale + 1) << jump;
    EXPECT_EQ(value().count, count) << jump;
    receive_stamped("/teleop", 0.5);
    EXPECT_EQ(value().count, count + 1) << jump;
  }
}

TEST_F(CommandInputTest, AJumpChangesNothingOfWhatArrivedBefore) {
  receive_stamped("/teleop", 0.5, kSecond / 10);
  const VelocityCommand before = value();
  now_.ros_ns -= kHour;
  EXPECT_FALSE(input_.update(now_.loop_ns));
  now_.ros_ns += 2 * kHour;
  EXPECT_FALSE(input_.update(now_.loop_ns));
  EXPECT_EQ(value().count, before.count);
  EXPECT_EQ(value().age_ns, before.age_ns);
}

TEST_F(CommandInputTest, SimulatedTimeIsAClockLikeAnyOther) {
  now_ = {.ros_ns = 7 * kSecond, .loop_ns = 7 * kSecond};
  receive_stamped("/teleop", 0.5, kSecond / 100);
  EXPECT_EQ(value().age_ns, kSecond / 100);
  receive("/wall", 0.9, 1'700'000'000 * kSecond);
  EXPECT_EQ(value().stale, 1u);
  EXPECT_THAT(reported(), HasSubstr("is not the robot's /clock"));
}

TEST_F(CommandInputTest, WithoutATimeoutNoStampIsLookedAt) {
  input_.set_timeout(0);
  receive_stamped("/teleop", 0.5, kHour);
  EXPECT_EQ(value().count, 1u);
  EXPECT_EQ(value().age_ns, 0);
}

TEST_F(CommandInputTest, TwoNodesAreNamedOnceAndOverrideEachOther) {
  for (int i = 0; i < 100; ++i) {
    receive("/teleop", 0.5);
    receive("/navigation", 0.3);
    pass(kSecond / 10);
  }
  EXPECT_EQ(value().count, 200u);
  EXPECT_EQ(value().many_senders, 0u);
  EXPECT_EQ(reported(),
            "W 2 nodes send commands: /navigation, /teleop; each message overrides the previous one (one_sender: true "
            "refuses them)\n");
  pass(2 * kSecond);
  receive("/teleop", 0.5);
  EXPECT_EQ(reported(), "I one sender of commands is left: /teleop\n");
}

TEST_F(CommandInputTest, OneNodeOnBothTopicsIsOneSender) {
  receive("/teleop", 0.5);
  receive_stamped("/teleop", 0.5);
  EXPECT_EQ(reported(), "");
}

TEST_F(CommandInputTest, SendersSlowerThanAShortTimeoutAreACrowdAllTheSame) {
  input_ = CommandInput(0.1, true);
  input_.follow({.run = 7, .withdrawals = 0, .granted = true}, now_.loop_ns);
  for (int i = 0; i < 10; ++i) {  // each at 2 Hz
    receive(i % 2 == 0 ? "/teleop" : "/navigation", 0.5);
    EXPECT_EQ(value().many_senders, i == 0 ? 0u : 1u);
    pass(kSecond / 4);
  }
  EXPECT_EQ(value().count, 1u);
}

TEST_F(CommandInputTest, TakingTurnsSlowerThanTheTimeoutIsNoCrowd) {
  for (int i = 0; i < 10; ++i) {
    receive(i % 2 == 0 ? "/teleop" : "/navigation", 0.5);
    pass(2 * kSecond);
  }
  EXPECT_EQ(reported(), "");
}

TEST_F(CommandInputTest, ANodeWhoseStampsAreRefusedIsNoSender) {
  input_ = CommandInput(1.25, true);
  receive("/teleop", 0.5);
  receive_stamped("/late", 0.5, kHour);
  EXPECT_EQ(value().many_senders, 0u);
  EXPECT_THAT(input_.senders(now_.loop_ns), testing::ElementsAre("/teleop"));
}

TEST_F(CommandInputTest, WithOneSenderMessagesOfAllAreRefusedUntilOneIsLeft) {
  input_ = CommandInput(1.25, true);
  receive("/teleop", 0.5);
  EXPECT_EQ(value().count, 1u);
  pass(kSecond / 10);
  receive("/navigation", 0.3);
  EXPECT_EQ(value().many_senders, 1u);
  EXPECT_EQ(value().crowded, 1u);
  for (int i = 0; i < 12; ++i) {
    pass(kSecond / 10);
    receive("/teleop", 0.5);
  }
  EXPECT_EQ(value().many_senders, 1u) << "/navigation was received 1.2 s ago";
  EXPECT_EQ(value().crowded, 13u);
  EXPECT_EQ(value().count, 1u);
  EXPECT_THAT(reported(),
              HasSubstr("refused while one of them requests motion (one_sender), ramping down to standstill"));
  pass(kSecond / 10);
  EXPECT_TRUE(input_.update(now_.loop_ns)) << "without any message, too";
  EXPECT_EQ(value().many_senders, 0u);
  receive("/teleop", 0.5);
  EXPECT_EQ(value().count, 2u);
  EXPECT_EQ(reported(), "I one sender of commands is left: /teleop\n");
}

TEST_F(CommandInputTest, WithOneSenderZerosOfTwoAreAcceptedWhileNoneRequestsMotion) {
  input_ = CommandInput(1.25, true);
  input_.follow({.run = 7, .withdrawals = 0, .granted = true}, now_.loop_ns);
  receive("/teleop", 0);
  receive("/console", 0);
  EXPECT_EQ(value().many_senders, 0u);
  EXPECT_EQ(value().count, 2u);
  EXPECT_EQ(value().contested, 0u) << "evidence for a reset";
  receive("/teleop", 0.5);
  receive("/console", 0);
  EXPECT_EQ(value().many_senders, 1u);
  EXPECT_EQ(value().crowded, 2u);
  receive("/teleop", 0);
  EXPECT_EQ(value().many_senders, 0u);
  EXPECT_EQ(value().count, 3u);
}

TEST_F(CommandInputTest, ANewcomerToACrowdIsNamed) {
  receive("/a", 0);
  receive("/b", 0);
  EXPECT_THAT(reported(), HasSubstr("2 nodes send commands: /a, /b"));
  receive("/c", 0);
  EXPECT_THAT(reported(), HasSubstr("3 nodes send commands: /a, /b, /c"));
  receive("/a", 0);
  EXPECT_EQ(reported(), "");
}

TEST_F(CommandInputTest, FlickeringSendersAreReportedEveryTenSecondsAtMost) {
  std::size_t warnings = 0;
  for (int i = 0; i < 30; ++i) {  // 60 s: /b sends every 2 s, and is a sender for 1.25 of them
    receive("/b", 0.5);
    for (int k = 0; k < 20; ++k) {
      receive("/a", 0.5);
      pass(kSecond / 10);
    }
    for (const ReportLine& line : input_.lines()) warnings += line.warning ? 1 : 0;
  }
  EXPECT_EQ(warnings, 6u);
}

TEST_F(CommandInputTest, AZeroIsContestedWhileAnotherSenderRequestsMotion) {
  receive("/teleop", 1);
  receive("/planner", 0);
  EXPECT_EQ(value().contested, 1u);
  pass(kSecond);
  receive("/planner", 0);
  EXPECT_EQ(value().contested, 1u);
  receive("/teleop", 0);  // its own zero ends its request
  EXPECT_EQ(value().contested, 0u);
  receive("/planner", 0);
  EXPECT_EQ(value().contested, 0u);
}

TEST_F(CommandInputTest, ARequestForMotionContestsForTheTimeoutOnly) {
  receive("/teleop", 1);
  pass(5 * kSecond / 4 + 1);
  receive("/planner", 0);
  EXPECT_EQ(value().contested, 0u);
}

TEST_F(CommandInputTest, ARefusedMessageIsARequestForMotionWhateverItHolds) {
  receive_stamped("/teleop", 0, -kHour);
  receive("/planner", 0);
  EXPECT_EQ(value().contested, 1u);
  receive("/teleop", std::numeric_limits<double>::quiet_NaN());
  receive("/planner", 0);
  EXPECT_EQ(value().contested, 1u);
}

/// A stop that latches, and its reset.
struct RevokedSenderTest : CommandInputTest {
  RevokedSenderTest() { grant(); }

  void grant() { input_.follow({.run = 7, .withdrawals = withdrawals_, .granted = true}, now_.loop_ns); }
  void stop() { input_.follow({.run = 7, .withdrawals = ++withdrawals_, .granted = false}, now_.loop_ns); }

  std::uint64_t withdrawals_ = 0;
};

TEST_F(RevokedSenderTest, WhatAStopInterruptedIsRefusedUntilItsSendersOwnZero) {
  receive("/teleop", 0.5);
  pass(kSecond / 10);  // the controller reads it
  stop();
  EXPECT_EQ(value().content.twist.linear[0], 0);
  EXPECT_EQ(value().contested, kNoMessage);
  pass(3 * kSecond);  // suspended meanwhile
  grant();
  const std::uint64_t count = value().count;
  receive("/teleop", 0.5);
  EXPECT_EQ(value().count, count);
  EXPECT_EQ(value().revoked, 1u);
  EXPECT_THAT(input_.revoked(), testing::ElementsAre("/teleop"));
  EXPECT_THAT(reported(), HasSubstr("W motion of /teleop is refused: it must send zero once after a stop"));
  receive("/pad", 0);
  receive("/teleop", 0.5);
  EXPECT_EQ(value().revoked, 2u) << "the zero of another sender";
  receive("/teleop", 0);
  receive("/teleop", 0.5);
  EXPECT_EQ(value().content.twist.linear[0], 0.5);
  EXPECT_THAT(input_.revoked(), IsEmpty());
}

TEST_F(RevokedSenderTest, MotionThatItsStampDatesBeforeTheReleaseIsRefusedWhateverTheTimeout) {
  for (const double timeout : {1.25, 60.0, 0.0}) {
    input_.set_timeout(timeout);
    receive("/relay", 0);
    pass(100 * kSecond);
    const std::uint64_t refused = value().revoked;
    const std::int64_t before_ns = now_.ros_ns;
    stop();
    pass(kSecond / 2);
    grant();
    receive("/relay", 0.5, before_ns);
    receive_stamped("/relay", 0.5);
    EXPECT_EQ(value().revoked, refused + 2) << timeout;
    EXPECT_EQ(value().content.twist.linear[0], 0) << timeout;
    receive_stamped("/relay", 0);
    receive_stamped("/relay", 0.5);
    EXPECT_EQ(value().content.twist.linear[0], 0.5) << timeout;
    receive_stamped("/relay", 0);
  }
}

TEST_F(RevokedSenderTest, MotionWithinTheTimeoutBeforeAStopCountsAsWell) {
  receive("/teleop", 0.5);
  receive("/teleop", 0);
  pass(kSecond);
  stop();
  grant();
  receive("/teleop", 0.5);
  EXPECT_EQ(value().revoked, 1u);
}

TEST_F(RevokedSenderTest, MotionThatEndedLongBeforeAStopDoesNot) {
  receive("/teleop", 0.5);
  receive("/teleop", 0);
  pass(2 * kSecond);
  stop();
  grant();
  receive("/teleop", 0.5);
  EXPECT_EQ(value().content.twist.linear[0], 0.5);
}

TEST_F(RevokedSenderTest, MotionThatNoZeroEndedCountsHoweverLongAgoItCame) {
  receive("/teleop", 0.5);
  pass(100 * kSecond);
  stop();
  grant();
  receive("/teleop", 0.5);
  EXPECT_EQ(value().revoked, 1u);
}

TEST_F(RevokedSenderTest, MotionOfANewSenderDuringAStopIsVoidAfterIt) {
  stop();
  receive("/teleop", 0.5);
  EXPECT_EQ(value().revoked, 0u);
  pass(2 * kSecond);
  grant();
  receive("/teleop", 0.5);
  EXPECT_EQ(value().revoked, 1u);
}

TEST_F(RevokedSenderTest, ItsCommandDoesNotTakeEffectWithTheReleaseEither) {
  stop();
  receive("/teleop", 0.5);
  EXPECT_EQ(value().content.twist.linear[0], 0.5) << "in force, and braked";
  grant();
  EXPECT_EQ(value().content.twist.linear[0], 0);
}

TEST_F(RevokedSenderTest, NorDoesWhatWasRequestedDuringTheStopAfterAZero) {
  stop();
  receive("/teleop", 0);
  pass(kSecond);
  receive("/teleop", 0.5);
  pass(2 * kSecond);
  grant();
  receive("/teleop", 0.5);
  EXPECT_EQ(value().revoked, 1u);
}

TEST_F(RevokedSenderTest, ACommandOfADeadSenderEndsInAStopWhateverItsTimeout) {
  input_.set_timeout(0);
  stop();
  receive("/teleop", 0);
  receive("/teleop", 0.5);
  EXPECT_FALSE(input_.update(now_.loop_ns));
  restart("/teleop");
  pass(kSecond);
  EXPECT_TRUE(input_.update(now_.loop_ns));
  EXPECT_EQ(value().content.twist.linear[0], 0);
  EXPECT_EQ(value().contested, kNoMessage);
}

TEST_F(RevokedSenderTest, ACommandThatEndsBeforeTheControllerReadItStillContestsAnEarlierZero) {
  receive("/teleop", 0);
  receive("/teleop", 0.5);
  stop();
  EXPECT_EQ(value().content.twist.linear[0], 0);
  EXPECT_EQ(value().contested, 1u);
  receive("/other", 0.5);
  pass(kSecond);
  grant();
  EXPECT_EQ(value().contested, kNoMessage) << "it was read, and has ended";
}

TEST_F(RevokedSenderTest, AZeroDuringTheStopIsEnough) {
  receive("/teleop", 0.5);
  stop();
  receive("/teleop", 0);
  receive("/teleop", 0.5);  // before this node has read the permit that lets it drive
  grant();
  receive("/teleop", 0.5);
  EXPECT_EQ(value().revoked, 0u);
  EXPECT_EQ(value().content.twist.linear[0], 0.5);
}

TEST_F(RevokedSenderTest, ASenderThatIsStartedAnewOwesNothing) {
  receive("/teleop", 0.5);
  stop();
  grant();
  restart("/teleop");
  receive("/teleop", 0.5);
  EXPECT_EQ(value().content.twist.linear[0], 0.5);
}

TEST_F(RevokedSenderTest, AConnectionThatTheSameProcessOpensAgainOwesWhatTheFirstOneDid) {
  input_.set_timeout(0);
  receive("/teleop", 0.5);
  stop();
  grant();
  pass(100 * kSecond);
  reopen("/teleop");
  receive("/teleop", 0.5);  // a latched message, delivered again
  EXPECT_EQ(value().revoked, 1u);
  EXPECT_EQ(value().content.twist.linear[0], 0);
}

TEST_F(RevokedSenderTest, AControllerThatIsRestartedRevokesThosePublishingAlready) {
  const Publisher teleop = publisher("/teleop");
  input_ = CommandInput(1.25, false);
  input_.start({.present = {{teleop.name, nullptr, teleop.uri}}, .run = 7});
  stop();
  pass(100 * kSecond);
  grant();
  receive("/teleop", 0.5);
  EXPECT_EQ(value().revoked, 1u);
  receive("/planner", 0.3);
  EXPECT_EQ(value().content.twist.linear[0], 0.3) << "started since then";
}

TEST_F(RevokedSenderTest, AnotherRunIsAWithdrawalToo) {
  receive("/teleop", 0.5);
  input_.follow({.run = 8, .withdrawals = 0, .granted = true}, now_.loop_ns);
  EXPECT_EQ(value().content.twist.linear[0], 0);
  receive("/teleop", 0.5);
  EXPECT_EQ(value().revoked, 1u);
}

TEST_F(RevokedSenderTest, ARefusedRequestContestsTheZeroOfAnother) {
  receive("/teleop", 0.5);
  stop();
  pass(2 * kSecond);
  receive("/pad", 0);
  EXPECT_EQ(value().contested, 0u);
  receive("/teleop", 0.5);
  receive("/pad", 0);
  EXPECT_EQ(value().contested, 1u);
}

TEST_F(RevokedSenderTest, TheSameCommandIsReportedEveryTenSecondsAtMost) {
  receive("/teleop", 0.5);
  stop();
  std::size_t lines = 0;
  for (int i = 0; i < 600; ++i) {  // 60 s
    receive("/teleop", 0.5);
    pass(kSecond / 10);
    lines += input_.lines().size();
  }
  EXPECT_EQ(lines, 6u);
}

TEST_F(RevokedSenderTest, ARequestOfNoSenderCanBeWithdrawnAndIsNoZeroOfASender) {
  input_.receive_once({.twist = {}, .posture = {}, .mode = {ModeKind::kStand}}, now_);
  input_.withdraw({ModeKind::kLie}, now_.loop_ns);
  EXPECT_EQ(value().content.mode, Mode{ModeKind::kStand}) << "another request is in force";
  input_.withdraw({ModeKind::kStand}, now_.loop_ns);
  EXPECT_EQ(value().content.mode, Mode{});
  EXPECT_NE(value().contested, 0u);
}

TEST_F(CommandInputTest, ARequestOfNoSenderHasNoEffectWithoutThePermissionToMove) {
  input_.receive_once({.twist = {}, .posture = {}, .mode = {ModeKind::kStand}}, now_);
  EXPECT_EQ(value().count, 0u);
  EXPECT_EQ(value().content.mode, Mode{});
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST_F(CommandInputTest, NaNNeverReachesTheLoopAndEndsTheCommandOfItsSender) {
  receive("/teleop", 0.5);
  receive("/teleop", kNaN);
  EXPECT_EQ(value().content.twist.linear[0], 0);
  EXPECT_EQ(value().contested, kNotFiniteMessage);
  EXPECT_EQ(value().count, 2u);
  EXPECT_EQ(reported(), "W cmd_vel_stamped holds NaN or infinity: refused; check its sender /teleop\n");
  receive("/teleop", 0.5);
  EXPECT_EQ(value().content.twist.linear[0], 0.5);
  EXPECT_EQ(value().contested, 0u);
}

TEST_F(CommandInputTest, NaNOfAnotherSenderLeavesTheCommandInForce) {
  receive("/teleop", 0.5);
  receive("/broken", kNaN);
  EXPECT_EQ(value().content.twist.linear[0], 0.5);
  EXPECT_EQ(value().count, 1u);
  EXPECT_EQ(value().not_finite, 1u);
  EXPECT_THAT(reported(), HasSubstr("refused; check its sender /broken"));
}

/// Twists and poses of robots on legs, each over a connection of its own.
struct PoseInputTest : RevokedSenderTest {
  void twist(const std::string& sender, double linear) {
    ArrivedCommand arrived{.sender = publisher(sender), .twist = {}, .part = StatedPart::kTwist};
    arrived.twist.linear[0] = linear;
    input_.receive(arrived, now_);
  }
  void pose(const std::string& sender, double roll) {
    Publisher of_poses = publisher(sender);
    of_poses.connection = pose_connection_;
    of_poses.topic = "body_pose";
    input_.receive({.sender = of_poses, .twist = {}, .posture = {.roll = roll}, .part = StatedPart::kPose}, now_);
  }
  double roll() const { return value().content.posture.roll; }
  double speed() const { return value().content.twist.linear[0]; }

  boost::shared_ptr<const void> pose_connection_ = boost::make_shared<char>();
};

TEST_F(PoseInputTest, AWalkCarriesThePoseOfItsOwnSenderAlone) {
  pose("/teleop", 0.1);
  twist("/teleop", 0.5);
  EXPECT_EQ(roll(), 0.1);
  twist("/planner", 0.5);
  EXPECT_EQ(roll(), 0);
  twist("/teleop", 0.5);
  EXPECT_EQ(roll(), 0) << "what another sender replaced does not come back";
}

TEST_F(PoseInputTest, APoseDuringTheWalkOfItsSenderKeepsTheTwistAndItsTime) {
  input_.choose_mode({ModeKind::kGait, 1});
  twist("/teleop", 0.5);
  pass(kSecond);
  pose("/teleop", 0.1);
  EXPECT_EQ(speed(), 0.5);
  EXPECT_EQ(roll(), 0.1);
  EXPECT_EQ(value().content.mode, (Mode{ModeKind::kGait, 1}));
  EXPECT_EQ(value().age_ns, kSecond) << "of the twist, which a pose does not prolong";
  pass(kSecond / 8);
  pose("/teleop", 0.1);
  EXPECT_EQ(value().age_ns, kSecond + kSecond / 8);
  pass(kSecond / 4);
  pose("/teleop", 0.1);
  EXPECT_EQ(speed(), 0) << "the twist has timed out";
  EXPECT_EQ(value().age_ns, 0);
}

TEST_F(PoseInputTest, APoseEndsWithItsTimeoutWhileTheWalkGoesOn) {
  pose("/teleop", 0.1);
  for (int i = 0; i < 12; ++i) {
    twist("/teleop", 0.5);
    EXPECT_EQ(roll(), 0.1);
    pass(kSecond / 10);
  }
  pass(kSecond / 10);
  twist("/teleop", 0.5);
  EXPECT_EQ(roll(), 0);
}

TEST_F(PoseInputTest, ARequestIsAsOldAsItsOldestPart) {
  pose("/teleop", 0.1);
  pass(kSecond);
  twist("/teleop", 0.5);
  EXPECT_EQ(roll(), 0.1);
  EXPECT_EQ(value().age_ns, kSecond) << "of the pose";
  pass(kSecond / 8);
  pose("/teleop", 0.2);
  EXPECT_EQ(value().age_ns, kSecond / 8) << "of the twist: the first pose was replaced";
  pass(kSecond / 8);
  pose("/teleop", 0);
  twist("/teleop", 0.5);
  EXPECT_EQ(value().age_ns, 0) << "a zero moves nothing";
}

TEST_F(PoseInputTest, APoseThatNeverTimesOutOutlivesNeitherItsSenderNorAStop) {
  input_.set_timeout(0);
  pose("/teleop", 0.1);
  pass(100 * kSecond);
  twist("/teleop", 0.5);
  EXPECT_EQ(roll(), 0.1);
  restart("/teleop");
  twist("/teleop", 0.5);
  EXPECT_EQ(roll(), 0);
  pose("/teleop", 0.1);
  stop();
  EXPECT_EQ(parts_of(value().content), 0u);
  pass(kSecond);
  grant();
  twist("/teleop", 0);
  twist("/teleop", 0.5);
  EXPECT_EQ(speed(), 0.5);
  EXPECT_EQ(roll(), 0);
  pose("/teleop", 0.1);
  EXPECT_EQ(roll(), 0) << "its topic owes a zero of its own";
  EXPECT_EQ(value().revoked, 1u);
}

TEST_F(PoseInputTest, APoseOfAnotherSenderIsRefusedDuringAWalk) {
  twist("/teleop", 0.5);
  reported();
  pose("/posing", 0.1);
  EXPECT_EQ(speed(), 0.5);
  EXPECT_EQ(roll(), 0);
  EXPECT_EQ(value().crowded, 1u);
  EXPECT_THAT(reported(), HasSubstr("W body_pose of /posing is refused: the robot walks for /teleop"));
  twist("/teleop", 0);
  pose("/posing", 0.1);
  EXPECT_EQ(roll(), 0.1);
}

TEST_F(PoseInputTest, APoseOfNaNEndsThePoseAndNoWalk) {
  for (const double timeout : {1.25, 0.0}) {
    input_.set_timeout(timeout);
    for (const char* sender : {"/teleop", "/posing"}) {
      pose("/teleop", 0.1);
      twist("/teleop", 0.5);
      pass(kSecond / 10);
      const std::uint64_t refused = value().not_finite, count = value().count;
      pose(sender, kNaN);
      const bool own = sender == std::string("/teleop");
      EXPECT_EQ(speed(), 0.5);
      EXPECT_EQ(roll(), own ? 0 : 0.1);
      EXPECT_EQ(value().count > count, own) << "the controller reads it";
      EXPECT_EQ(value().age_ns, own ? kSecond / 10 : 0) << "of the twist";
      EXPECT_EQ(value().not_finite, refused + 1);
      twist("/teleop", 0.4);
      EXPECT_EQ(speed(), 0.4);
      EXPECT_EQ(roll(), own ? 0 : 0.1);
      pass(2 * kSecond);
      twist("/teleop", 0);
    }
  }
}

TEST_F(PoseInputTest, ThePlaceOfAFootIsNoPoseOfAWalk) {
  input_.receive({.sender = publisher("/teleop"), .twist = {}, .posture = {.height = 0.08}, .mode = {ModeKind::kLift}},
                 now_);
  twist("/teleop", 0.5);
  EXPECT_EQ(value().content.posture.height, 0);
  EXPECT_EQ(value().content.mode, Mode{});
}

TEST_F(PoseInputTest, AZeroTwistIsNoZeroWhileThePoseOfItsSenderIsInForce) {
  pose("/teleop", 0.1);
  twist("/teleop", 0.5);
  twist("/teleop", 0);
  EXPECT_EQ(roll(), 0.1);
  pose("/teleop", 0);
  EXPECT_EQ(parts_of(value().content), 0u);
  EXPECT_EQ(value().contested, 0u);
}

TEST_F(PoseInputTest, AChosenGaitEndsWithThePermissionToMove) {
  input_.choose_mode({ModeKind::kGait, 1});
  twist("/teleop", 0);
  EXPECT_EQ(value().content.mode, Mode{}) << "a gait moves nothing without a twist";
  stop();
  grant();
  twist("/pad", 0.5);
  EXPECT_EQ(value().content.mode, Mode{});
  EXPECT_EQ(input_.chosen_mode(), Mode{});
}

}  // namespace robot_control::tests
