#include "ros/inputs/command_mux.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <boost/make_shared.hpp>

#include "control/common/command_watch.h"
#include "ros/nanoseconds.h"

namespace robot_control::tests {

using testing::ElementsAre;
using testing::HasSubstr;

enum Source : std::size_t { kJoy, kKey, kCmd, kPath };
enum LockIndex : std::size_t { kPause, kWatchdog };

/// The shipped list with a lock that silence sets.
CommandSourceList shipped() {
  return {.sources = {{"joy_vel", "joy_vel", 0.5, 40, true},
                      {"key_vel", "key_vel", 0.5, 30, true},
                      {"cmd_vel", "cmd_vel", 1.25, 20, false},
                      {"path_vel", "path_vel", 0.5, 10, true}},
          .locks = {{"pause", "pause", 0, 255}}};
}

struct CommandMuxTest : testing::Test {
  void receive(Source source, double linear) {
    ArrivedCommand arrived{
        .sender = {"/node" + std::to_string(source), connections_[source]}, .twist = {}, .stamp_ns = 0};
    arrived.twist.linear[0] = linear;
    mux_.receive(source, arrived, now_);
  }

  void pass(std::int64_t time_ns) {
    now_.ros_ns += time_ns;
    now_.loop_ns += time_ns;
    mux_.update(now_.loop_ns);
  }

  double result() const { return mux_.value().content.twist.linear[0]; }

  ArrivalTime now_{.ros_ns = 1'700'000'000 * kSecond, .loop_ns = 5000 * kSecond};
  CommandMux mux_{shipped(), 1.25, false};
  std::array<boost::shared_ptr<const void>, 4> connections_{boost::make_shared<char>(), boost::make_shared<char>(),
                                                            boost::make_shared<char>(), boost::make_shared<char>()};
};

TEST_F(CommandMuxTest, TheLiveSourceOfTheHighestPriorityCommands) {
  receive(kPath, 0.1);
  EXPECT_EQ(result(), 0.1);
  receive(kKey, 0.3);
  EXPECT_EQ(result(), 0.3);
  receive(kCmd, 0.2);
  EXPECT_EQ(result(), 0.3);
  receive(kJoy, 0.4);
  EXPECT_EQ(result(), 0.4);
  EXPECT_EQ(mux_.winner(), "joy_vel");
  EXPECT_THAT(mux_.states(), ElementsAre("joy_vel: commands", "key_vel: masked by joy_vel",
                                         "cmd_vel: masked by joy_vel", "path_vel: masked by joy_vel"));
}

TEST_F(CommandMuxTest, WhenASourceTimesOutTheNextLiveOneTakesOver) {
  receive(kKey, 0.3);
  receive(kCmd, 0.2);
  pass(kSecond / 2);
  EXPECT_EQ(result(), 0.3);
  pass(1);
  EXPECT_EQ(result(), 0.2);
  EXPECT_EQ(mux_.value().age_ns, kSecond / 2 + 1) << "it is as old as when it came";
  EXPECT_THAT(mux_.states(),
              ElementsAre("joy_vel: silent", "key_vel: silent", "cmd_vel: commands", "path_vel: silent"));
}

TEST_F(CommandMuxTest, WhereNoneIsLiveTheResultIsZeroAndNeverSilence) {
  receive(kKey, 0.3);
  pass(kSecond);
  EXPECT_EQ(result(), 0);
  EXPECT_EQ(mux_.winner(), "");
  CommandWatch watch(1.25, 0.001, kPartLinearX | kPartAngularZ);
  watch.enter_run();
  for (std::uint64_t cycle = 0; cycle < 5000; ++cycle) {
    if (cycle % 20 == 0) pass(kSecond / 50);
    watch.step(mux_.value(), cycle);
    if (cycle > 20) {
      ASSERT_EQ(watch.reasons(), 0u);
    }
  }
  EXPECT_EQ(watch.timeouts(), 0u);
  EXPECT_EQ(watch.zero_requests(), 0u) << "that zero is no sender's";
  EXPECT_EQ(watch.silent_cycles(4999), 4999u);
}

TEST_F(CommandMuxTest, ALockMakesItZeroForSourcesOfALowerPriority) {
  receive(kCmd, 0.2);
  mux_.receive_lock(kPause, true, now_.loop_ns);
  EXPECT_EQ(result(), 0);
  EXPECT_EQ(mux_.states()[kCmd], "cmd_vel: locked by pause");
  EXPECT_EQ(mux_.value().contested, 1u) << "the robot would move when the lock is taken away";
  receive(kCmd, 0.2);
  EXPECT_EQ(result(), 0);
  mux_.receive_lock(kPause, false, now_.loop_ns);
  EXPECT_EQ(result(), 0.2);
}

TEST_F(CommandMuxTest, ALockLetsAHigherOrEqualPriorityPass) {
  CommandSourceList list = shipped();
  list.locks = {{"no_programs", "no_programs", 0, 30}};
  mux_ = CommandMux(list, 1.25, false);
  mux_.receive_lock(0, true, now_.loop_ns);
  receive(kCmd, 0.2);
  EXPECT_EQ(result(), 0);
  receive(kKey, 0.3);
  EXPECT_EQ(result(), 0.3);
}

TEST_F(CommandMuxTest, ALockWithATimeoutLocksWhileItIsSilent) {
  CommandSourceList list = shipped();
  list.locks = {{"watchdog", "watchdog", 1.0, 255}};
  mux_ = CommandMux(list, 1.25, false);
  receive(kKey, 0.3);
  EXPECT_EQ(result(), 0) << "it has never said anything";
  mux_.receive_lock(0, false, now_.loop_ns);
  EXPECT_EQ(result(), 0.3);
  for (int i = 0; i < 6; ++i) {
    pass(kSecond / 5);
    receive(kKey, 0.3);
  }
  EXPECT_EQ(result(), 0);
}

TEST_F(CommandMuxTest, AZeroOfTheWinnerIsContestedByWhatItMasks) {
  receive(kPath, 0.4);
  receive(kKey, 0);
  EXPECT_EQ(result(), 0);
  EXPECT_EQ(mux_.value().contested, 1u) << "the robot would move when key_vel is silent";
  receive(kPath, 0);
  EXPECT_EQ(mux_.value().contested, 0u);
  receive(kPath, 0.4);
  EXPECT_EQ(mux_.value().contested, 1u) << "what is masked may begin later, too";
}

TEST_F(CommandMuxTest, AZeroIsContestedByAMaskedSenderWhoseMessagesAreRefused) {
  mux_.receive(kPath, {.sender = {"/late", connections_[kPath]}, .twist = {}, .stamp_ns = now_.ros_ns - kSecond}, now_);
  receive(kKey, 0);
  EXPECT_EQ(mux_.value().contested, 1u);
  receive(kCmd, std::numeric_limits<double>::quiet_NaN());
  pass(kSecond);
  receive(kKey, 0);
  EXPECT_EQ(mux_.value().contested, 1u);
  pass(kSecond);
  receive(kKey, 0);
  EXPECT_EQ(mux_.value().contested, 0u);
}

TEST_F(CommandMuxTest, AnOldZeroThatTakesOverIsNoMessage) {
  receive(kCmd, 0);
  receive(kKey, 0);
  pass(kSecond * 3 / 4);
  EXPECT_EQ(mux_.winner(), "cmd_vel");
  EXPECT_EQ(mux_.value().contested, kNoMessage);
}

TEST_F(CommandMuxTest, AMessageIsNotReplacedBeforeTheControllerHasReadIt) {
  mux_.receive_lock(kPause, true, now_.loop_ns);
  pass(kSecond);
  EXPECT_EQ(mux_.value().contested, kNoMessage);
  receive(kCmd, 0);
  pass(kSecond / 200);
  EXPECT_EQ(mux_.value().contested, 0u);
  pass(kSecond / 200);
  EXPECT_EQ(mux_.value().contested, kNoMessage);
}

TEST_F(CommandMuxTest, AMaskedSenderEndsTheSilence) {
  mux_.receive_lock(kPause, true, now_.loop_ns);
  CommandWatch watch(1.25, 0.001, kPartLinearX | kPartAngularZ);
  watch.enter_run();
  for (std::uint64_t cycle = 0; cycle < 3000; ++cycle) {
    if (cycle % 20 == 0) pass(kSecond / 50);
    if (cycle % 500 == 0) receive(kCmd, 0.2);
    watch.step(mux_.value(), cycle);
    ASSERT_LT(watch.silent_cycles(cycle), 501u);
  }
  EXPECT_EQ(watch.zero_requests(), 0u);
}

TEST_F(CommandMuxTest, TwoNodesOnOneSourceContestAsWithoutAList) {
  receive(kCmd, 0.2);
  mux_.receive(kCmd, {.sender = {"/other", boost::make_shared<char>()}, .twist = {}, .stamp_ns = 0}, now_);
  EXPECT_EQ(mux_.value().contested, 1u);
}

TEST_F(CommandMuxTest, ASourceAt5KilohertzMovesNothingThatItMayNot) {
  receive(kKey, 0.3);
  for (int i = 0; i < 2000; ++i) {  // 0.4 s
    pass(kSecond / 5000);
    receive(kCmd, 0.2);
    ASSERT_EQ(result(), 0.3);
  }
}

TEST_F(CommandMuxTest, NaNOfTheWinnerEndsItsCommandAndIsCounted) {
  receive(kCmd, 0.2);
  receive(kKey, std::numeric_limits<double>::quiet_NaN());
  CommandWatch watch(1.25, 0.001, kPartLinearX | kPartAngularZ);
  watch.enter_run();
  EXPECT_EQ(watch.step(mux_.value(), 0).twist.linear[0], 0);
  EXPECT_EQ(watch.refused(), 1u);
}

TEST_F(CommandMuxTest, MessagesOfOthersAreNoRefusalsOfTheWinner) {
  CommandWatch watch(1.25, 0.001, kPartLinearX | kPartAngularZ);
  watch.enter_run();
  watch.step(mux_.value(), 0);
  receive(kKey, std::numeric_limits<double>::quiet_NaN());
  for (std::uint64_t cycle = 1; cycle <= 100; ++cycle) {
    EXPECT_EQ(watch.step(mux_.value(), cycle).twist.linear[0], 0);
    EXPECT_EQ(watch.reasons(), std::uint64_t{kReasonRefused}) << "of the winner's last message";
    EXPECT_FALSE(watch.zero_requested());
    EXPECT_EQ(watch.silent_cycles(cycle), 0u);
    pass(kSecond / 1000);
    receive(kPath, 0.2);
  }
  EXPECT_EQ(watch.refused(), 1u);
  receive(kKey, std::numeric_limits<double>::quiet_NaN());
  watch.step(mux_.value(), 101);
  EXPECT_EQ(watch.refused(), 2u);
  receive(kKey, 0.3);
  EXPECT_EQ(watch.step(mux_.value(), 102).twist.linear[0], 0.3);
}

TEST_F(CommandMuxTest, NaNOfAMaskedSourceHasNoEffect) {
  receive(kKey, 0.3);
  receive(kCmd, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(result(), 0.3);
}

TEST_F(CommandMuxTest, ASourceIsLiveForItsTimeoutFromTheStampOn) {
  ArrivedCommand late{
      .sender = {"/path", connections_[kPath]}, .twist = {}, .stamp_ns = now_.ros_ns - 3 * kSecond / 10};
  late.twist.linear[0] = 0.2;
  mux_.receive(kPath, late, now_);
  pass(2 * kSecond / 10);
  EXPECT_EQ(result(), 0.2);
  EXPECT_EQ(mux_.value().age_ns, 3 * kSecond / 10) << "as it came";
  pass(1);
  EXPECT_EQ(result(), 0);
}

TEST_F(CommandMuxTest, AStampTooOldMakesNoSourceLive) {
  mux_.receive(kKey, {.sender = {"/late", boost::make_shared<char>()}, .twist = {}, .stamp_ns = now_.ros_ns - kSecond},
               now_);
  EXPECT_EQ(mux_.winner(), "");
  EXPECT_EQ(mux_.value().stale, 1u);
  std::string said;
  for (const ReportLine& line : mux_.lines()) said += line.text;
  EXPECT_THAT(said, HasSubstr("key_vel: "));
}

/// The source of a planner never times out, or after a minute. The planner has died; then come a stop and its reset, a
/// new run or the end of a pause.
struct DeadSourceTest : CommandMuxTest, testing::WithParamInterface<double> {
  DeadSourceTest() {
    CommandSourceList list = shipped();
    list.sources[kCmd].timeout = GetParam();
    mux_ = CommandMux(list, 0, false);
    mux_.follow(permission_, now_.loop_ns);
    receive(kCmd, 0.4);
    pass(kSecond / 10);
  }

  MotionPermission permission_{.run = 7, .withdrawals = 1, .granted = true};
};

TEST_P(DeadSourceTest, DrivesNoMoreAfterAWithdrawal) {
  EXPECT_EQ(result(), 0.4);
  ++permission_.withdrawals;
  EXPECT_TRUE(mux_.follow(permission_, now_.loop_ns));
  EXPECT_EQ(result(), 0);
  EXPECT_EQ(mux_.winner(), "");
  receive(kKey, 0);
  pass(kSecond);
  EXPECT_EQ(result(), 0) << "when the pad that sent one zero is silent again";
}

TEST_P(DeadSourceTest, DrivesNoMoreInAnotherRun) {
  permission_.run = 8;
  mux_.follow(permission_, now_.loop_ns);
  receive(kKey, 0);
  pass(kSecond);
  EXPECT_EQ(result(), 0);
}

TEST_P(DeadSourceTest, GoesOnByAZeroOfItsOwn) {
  ++permission_.withdrawals;
  mux_.follow(permission_, now_.loop_ns);
  receive(kCmd, 0.4);
  EXPECT_EQ(result(), 0);
  EXPECT_EQ(mux_.value().revoked, 1u);
  EXPECT_THAT(mux_.states()[kCmd], "cmd_vel: revoked");
  receive(kCmd, 0);
  receive(kCmd, 0.4);
  EXPECT_EQ(result(), 0.4);
}

INSTANTIATE_TEST_SUITE_P(Timeouts, DeadSourceTest, testing::Values(0.0, 1.25, 60.0));

TEST_F(CommandMuxTest, TimeThatTurnsBackLeavesNothingLive) {
  receive(kKey, 0.3);
  now_.loop_ns = kSecond;
  mux_.update(now_.loop_ns);
  EXPECT_EQ(result(), 0);
}

TEST_F(CommandMuxTest, EveryChangeOfTheCommanderIsOneLine) {
  mux_.update(now_.loop_ns);
  EXPECT_TRUE(mux_.lines().empty());
  receive(kCmd, 0.2);
  receive(kCmd, 0.2);
  const auto lines = mux_.lines();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text, "commands come from cmd_vel");
}

}  // namespace robot_control::tests
