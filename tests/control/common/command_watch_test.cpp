#include "control/common/command_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "signals/command_frame.h"

namespace robot_control::tests {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kPlanar = kPartLinearX | kPartAngularZ;  ///< of a differential drive

struct CommandWatchTest : testing::Test {
  void send(double linear) {
    request.content.twist.linear[0] = linear;
    ++request.count;
  }

  CommandWatch watch{1.25, 1e-3, kPlanar};
  VelocityCommand request;
};

TEST_F(CommandWatchTest, SaysThatNothingWasReceived) {
  EXPECT_EQ(watch.step(request, 0).twist.linear[0], 0);
  EXPECT_EQ(watch.reasons(), kReasonNoCommand);
}

TEST_F(CommandWatchTest, PassesAMessageOnForExactlyItsTimeout) {
  send(0.5);
  for (std::uint64_t k = 10; k <= 1260; ++k) ASSERT_EQ(watch.step(request, k).twist.linear[0], 0.5) << "cycle " << k;
  EXPECT_EQ(watch.step(request, 1261).twist.linear[0], 0);
  EXPECT_EQ(watch.reasons(), kReasonTimedOut);
  EXPECT_EQ(watch.request_cycle(), 10u);
}

TEST_F(CommandWatchTest, CountsATimeoutOnceUntilTheNextMessage) {
  send(0.5);
  for (std::uint64_t k = 0; k < 5000; ++k) watch.step(request, k);
  EXPECT_EQ(watch.timeouts(), 1u);
  send(0.3);
  EXPECT_EQ(watch.step(request, 5000).twist.linear[0], 0.3);
  EXPECT_EQ(watch.reasons(), 0u);
  for (std::uint64_t k = 5001; k < 9000; ++k) watch.step(request, k);
  EXPECT_EQ(watch.timeouts(), 2u);
}

TEST_F(CommandWatchTest, NamesThePartsThatTheMachineCannotExecuteAndPassesTheOthersOn) {
  send(0.5);
  watch.step(request, 0);
  EXPECT_EQ(watch.ignored(), 0u);
  request.content.twist.linear[1] = 0.3;
  request.content.twist.angular[0] = -0.1;
  request.content.posture.height = 0.05;
  request.content.mode = {ModeKind::kStand};
  request.content.joints[11] = 0.1;
  ++request.count;
  const Request& passed = watch.step(request, 1);
  EXPECT_EQ(passed.twist.linear[0], 0.5);
  EXPECT_EQ(watch.ignored(), kPartLinearY | kPartAngularX | kPartHeight | kPartMode | kPartJoints);
  EXPECT_EQ(watch.reasons(), kReasonPartIgnored);
  EXPECT_EQ(watch.partial(), 1u);
  EXPECT_EQ(watch.refused(), 0u);
  request.content = {.twist = {.linear = {0.5, 0, 0}}};
  ++request.count;
  watch.step(request, 2);
  EXPECT_EQ(watch.reasons(), 0u);
  EXPECT_EQ(watch.partial(), 1u);
}

TEST_F(CommandWatchTest, ForgetsAnIgnoredPartWithItsCommand) {
  request.content.twist.linear[1] = 0.3;
  ++request.count;
  for (std::uint64_t k = 0; k < 2000; ++k) watch.step(request, k);
  EXPECT_EQ(watch.ignored(), 0u);
  EXPECT_EQ(watch.reasons(), kReasonTimedOut);
}

TEST_F(CommandWatchTest, NeverTimesOutWithTimeoutZero) {
  watch = CommandWatch(0, 1e-3, kPlanar);
  send(0.5);
  watch.step(request, 0);
  EXPECT_EQ(watch.step(request, std::uint64_t{1} << 62).twist.linear[0], 0.5);
  EXPECT_EQ(watch.timeouts(), 0u);
}

TEST_F(CommandWatchTest, CountsWholeCyclesOfAPeriodThatIsNotExactInBinary) {
  for (const double rate : {100.0, 300.0, 1000.0, 2000.0}) {
    watch = CommandWatch(0.3, 1 / rate, kPlanar);
    request = {};
    send(1);
    const auto cycles = static_cast<std::uint64_t>(std::lround(0.3 * rate));
    watch.step(request, 0);
    EXPECT_EQ(watch.step(request, cycles).twist.linear[0], 1) << rate;
    EXPECT_EQ(watch.step(request, cycles + 1).twist.linear[0], 0) << rate;
  }
}

TEST_F(CommandWatchTest, RefusesEveryComponentThatIsNotFiniteUntilAGoodMessageArrives) {
  std::uint64_t refused = 0;
  for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
    for (std::size_t i = 0; i < 6; ++i) {
      request.content.twist = {};
      send(0.5);
      ASSERT_EQ(watch.step(request, 0).twist.linear[0], 0.5);
      (i < 3 ? request.content.twist.linear : request.content.twist.angular)[i % 3] = bad;
      ++request.count;
      EXPECT_EQ(watch.step(request, 1).twist.linear[0], 0);
      EXPECT_EQ(watch.reasons(), kReasonRefused);
      EXPECT_EQ(watch.refused(), ++refused);
      EXPECT_EQ(watch.step(request, 5000).twist.linear[0], 0);
      EXPECT_EQ(watch.reasons(), kReasonRefused);
    }
  }
  EXPECT_EQ(watch.timeouts(), 0u);
}

TEST_F(CommandWatchTest, AMessageThatItsInputRefusedAsNotFiniteEndsTheRequestLikewise) {
  send(0.5);
  watch.step(request, 0);
  request.content = {};
  request.contested = kNotFiniteMessage;
  ++request.count;
  EXPECT_EQ(watch.step(request, 1).twist.linear[0], 0);
  EXPECT_EQ(watch.reasons(), kReasonRefused);
  EXPECT_EQ(watch.refused(), 1u);
  EXPECT_EQ(watch.received(), 2u);
}

TEST_F(CommandWatchTest, ARefusedMessageBesideTheCommandInForceIsCountedWithoutEffect) {
  send(0.5);
  watch.step(request, 0);
  ++request.not_finite;
  EXPECT_EQ(watch.step(request, 1).twist.linear[0], 0.5);
  EXPECT_EQ(watch.reasons(), 0u);
  EXPECT_EQ(watch.refused(), 1u);
  EXPECT_EQ(watch.received(), 2u);
}

/// Each number behind the twist, by which a request may be more than a velocity command.
std::vector<double*> numbers_behind_the_twist(Request& request) {
  Posture& posture = request.posture;
  std::vector<double*> numbers{&posture.height, &posture.roll, &posture.pitch, &posture.x, &posture.y, &posture.yaw};
  for (double& joint : request.joints) numbers.push_back(&joint);
  return numbers;
}

TEST_F(CommandWatchTest, RefusesEveryNumberBehindTheTwistThatIsNotFinite) {
  for (const double bad : {std::nan(""), -kInfinity}) {
    for (double* const number : numbers_behind_the_twist(request.content)) {
      *number = bad;
      send(0.5);
      EXPECT_EQ(watch.step(request, 1).twist.linear[0], 0);
      EXPECT_EQ(watch.reasons(), kReasonRefused);
      *number = 0;
    }
  }
}

TEST_F(CommandWatchTest, NamesEveryNumberBehindTheTwistThatIsNotZero) {
  constexpr std::uint64_t kParts[] = {kPartHeight, kPartRoll, kPartPitch, kPartX, kPartY, kPartYaw};
  const auto numbers = numbers_behind_the_twist(request.content);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    *numbers[i] = -1e-300;
    EXPECT_EQ(parts_of(request.content), i < std::size(kParts) ? kParts[i] : std::uint64_t{kPartJoints});
    *numbers[i] = -0.0;
    EXPECT_EQ(parts_of(request.content), 0u);
  }
}

TEST_F(CommandWatchTest, TakesAnAgeByStampOffTheTimeout) {
  request.age_ns = 1'000'000'000;
  send(0.5);
  EXPECT_EQ(watch.step(request, 10).twist.linear[0], 0.5);
  EXPECT_EQ(watch.step(request, 260).twist.linear[0], 0.5) << "1.25 s after the stamp";
  EXPECT_EQ(watch.step(request, 261).twist.linear[0], 0);
  EXPECT_EQ(watch.reasons(), kReasonTimedOut);
  request.age_ns = 0;
  send(0.5);
  EXPECT_EQ(watch.step(request, 262).twist.linear[0], 0.5);
  EXPECT_EQ(watch.step(request, 262 + 1250).twist.linear[0], 0.5) << "without a stamp from the arrival on";
}

TEST_F(CommandWatchTest, AnAgeMeansNothingWithTimeoutZero) {
  watch = CommandWatch(0, 1e-3, kPlanar);
  request.age_ns = 3'600'000'000'000;
  send(0.5);
  EXPECT_EQ(watch.step(request, 0).twist.linear[0], 0.5);
  EXPECT_EQ(watch.step(request, 5000).twist.linear[0], 0.5);
}

TEST_F(CommandWatchTest, AStaleMessageNeitherEndsNorProlongsTheCommandThatStands) {
  send(0.5);
  watch.step(request, 0);
  for (std::uint64_t k = 1; k <= 1250; ++k) {
    ++request.stale;
    ASSERT_EQ(watch.step(request, k).twist.linear[0], 0.5) << "cycle " << k;
    ASSERT_EQ(watch.reasons(), kReasonStale);
  }
  ++request.stale;
  EXPECT_EQ(watch.step(request, 1251).twist.linear[0], 0);
  EXPECT_EQ(watch.reasons(), kReasonTimedOut | kReasonStale);
  EXPECT_EQ(watch.stale(), 1251u);
  EXPECT_EQ(watch.refused(), 1251u);
  EXPECT_EQ(watch.received(), 1252u);
  send(0.3);
  EXPECT_EQ(watch.step(request, 1252).twist.linear[0], 0.3);
  EXPECT_EQ(watch.reasons(), 0u) << "a good command ends the reason";
}

TEST_F(CommandWatchTest, StaleMessagesAloneMoveNothing) {
  for (std::uint64_t k = 0; k < 100; ++k) {
    ++request.stale;
    ASSERT_EQ(watch.step(request, k).twist.linear[0], 0);
    ASSERT_EQ(watch.reasons(), kReasonNoCommand | kReasonStale);
  }
}

TEST_F(CommandWatchTest, TheRequestOfARevokedSenderIsCountedAndHasNoEffect) {
  send(0.3);
  watch.step(request, 0);
  ++request.revoked;
  EXPECT_EQ(watch.step(request, 1).twist.linear[0], 0.3);
  EXPECT_EQ(watch.reasons(), kReasonRevoked);
  EXPECT_EQ(watch.revoked(), 1u);
  EXPECT_EQ(watch.refused(), 1u);
  send(0.2);
  watch.step(request, 2);
  EXPECT_EQ(watch.reasons(), 0u);
}

TEST_F(CommandWatchTest, ManySendersEndTheCommandUntilANewOneComesFromTheOneThatIsLeft) {
  send(0.5);
  watch.step(request, 0);
  request.many_senders = 1;
  for (std::uint64_t k = 1; k < 5000; ++k) {
    ++request.crowded;
    ASSERT_EQ(watch.step(request, k).twist.linear[0], 0);
    ASSERT_EQ(watch.reasons(), kReasonManySenders);
  }
  request.many_senders = 0;
  EXPECT_EQ(watch.step(request, 5000).twist.linear[0], 0) << "the command before is not resumed";
  EXPECT_EQ(watch.reasons(), kReasonManySenders);
  send(0.3);
  EXPECT_EQ(watch.step(request, 5001).twist.linear[0], 0.3);
  EXPECT_EQ(watch.reasons(), 0u);
  EXPECT_EQ(watch.timeouts(), 0u);
  EXPECT_EQ(watch.crowded(), 4999u);
  EXPECT_EQ(watch.refused(), 4999u);
}

TEST_F(CommandWatchTest, AnotherTimeoutHoldsForTheCommandThatStands) {
  send(0.5);
  watch.step(request, 0);
  watch.set_timeout(0.1);
  EXPECT_EQ(watch.step(request, 100).twist.linear[0], 0.5);
  EXPECT_EQ(watch.step(request, 101).twist.linear[0], 0);
  send(0.5);
  watch.step(request, 200);
  watch.set_timeout(0);
  EXPECT_EQ(watch.step(request, 100'000).twist.linear[0], 0.5);
}

TEST_F(CommandWatchTest, CountsMessagesThatWereOverwrittenInTheInbox) {
  request.count = 7;
  watch.step(request, 0);
  EXPECT_EQ(watch.received(), 7u);
}

TEST_F(CommandWatchTest, ForgetsInANewRunWhatTheInboxHolds) {
  send(0.5);
  watch.step(request, 100);
  ++request.stale;
  watch.enter_run(request);
  EXPECT_EQ(watch.step(request, 0).twist.linear[0], 0);
  EXPECT_EQ(watch.reasons(), kReasonNoCommand);
  EXPECT_EQ(watch.received(), 0u);
  EXPECT_EQ(watch.refused(), 0u);
}

// Evidence that no motion is requested.

TEST_F(CommandWatchTest, AZeroRequestIsEvidenceUntilAnythingElseIsReceived) {
  watch.step(request, 0);
  EXPECT_FALSE(watch.zero_requested());
  send(0);
  watch.step(request, 1);
  EXPECT_TRUE(watch.zero_requested());
  EXPECT_EQ(watch.zero_requests(), 1u);
  for (auto disturb : {+[](VelocityCommand& r) { r.content.twist.angular[2] = 1, ++r.count; },
                       +[](VelocityCommand& r) { ++r.stale; }, +[](VelocityCommand& r) { ++r.crowded; },
                       +[](VelocityCommand& r) { ++r.revoked; }, +[](VelocityCommand& r) { ++r.not_finite; },
                       +[](VelocityCommand& r) { r.contested = kNotFiniteMessage, ++r.count; },
                       +[](VelocityCommand& r) { r.content.twist.linear[0] = std::nan(""), ++r.count; },
                       +[](VelocityCommand& r) { r.contested = 1, ++r.count; }}) {
    disturb(request);
    watch.step(request, 2);
    EXPECT_FALSE(watch.zero_requested());
    request.content.twist = {};
    request.contested = 0;
    ++request.count;
    watch.step(request, 3);
    EXPECT_TRUE(watch.zero_requested());
  }
}

TEST_F(CommandWatchTest, SilenceCountsFromTheLastMessageAcceptedOrRefused) {
  watch.step(request, 100);
  watch.step(request, 150);
  EXPECT_EQ(watch.silent_cycles(150), 50u);
  ++request.crowded;
  watch.step(request, 151);
  EXPECT_EQ(watch.silent_cycles(151), 0u);
  ++request.stale;
  watch.step(request, 160);
  EXPECT_EQ(watch.silent_cycles(161), 1u);
  EXPECT_EQ(watch.silence_needed(), 1250u);
  watch.set_timeout(0);
  EXPECT_EQ(watch.silence_needed(), 1000u) << "without a timeout one second";
}

TEST_F(CommandWatchTest, WhatTheInboxHoldsAtTheFirstStepIsNoZeroRequest) {
  send(0);
  watch.step(request, 7);
  EXPECT_EQ(watch.zero_requests(), 0u);
  EXPECT_FALSE(watch.zero_requested());
  EXPECT_EQ(watch.first_cycle(), 7u);
}

TEST_F(CommandWatchTest, ARunMayBeginWithAZeroRequest) {
  watch.enter_run({}, true);
  send(1);
  EXPECT_EQ(watch.step(request, 0).twist.linear[0], 1);
  EXPECT_EQ(watch.zero_requests(), 1u);
  EXPECT_FALSE(watch.zero_requested());
}

TEST_F(CommandWatchTest, WhatNoSenderSentIsNoZeroRequestAndNoEndOfASilence) {
  request.contested = kNoMessage;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    send(0);
    watch.step(request, k);
  }
  EXPECT_EQ(watch.reasons(), 0u) << "a zero in force";
  EXPECT_EQ(watch.zero_requests(), 0u);
  EXPECT_FALSE(watch.zero_requested());
  EXPECT_EQ(watch.silent_cycles(3000), 3000u);
}

}  // namespace robot_control::tests
