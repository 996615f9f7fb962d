/// The laws of unitree_bridge in virtual time.

#include <gtest/gtest.h>

#include <random>

#include "drivers/unitree_go/bridge/command_relay.h"
#include "drivers/unitree_go/bridge/motion_switcher.h"
#include "drivers/unitree_go/bridge/state_writer.h"

namespace robot_control::unitree::go::tests {

constexpr std::int64_t kMs = 1'000'000;

LowCmd walking(float q) {
  LowCmd command;
  command.motors[0] = {.mode = kServo, .q = q, .dq = 1, .tau = 2, .kp = 30, .kd = 1};
  return command;
}

struct Relay : testing::Test {
  CommandRelay relay{4};
};

TEST_F(Relay, ANewCommandPassesOnce) {
  EXPECT_EQ(relay.due(0, true), nullptr);
  relay.store(walking(1), kMs);
  const LowCmd* sent = relay.due(kMs, true);
  ASSERT_NE(sent, nullptr);
  EXPECT_EQ(sent->motors[0].q, 1);
  EXPECT_EQ(sent->motors[0].kp, 30);
  EXPECT_EQ(relay.due(2 * kMs, true), nullptr);
}

TEST_F(Relay, NothingPassesWhileTheMotionServiceIsNotFree) {
  relay.store(walking(1), kMs);
  EXPECT_EQ(relay.due(kMs, false), nullptr);
  EXPECT_EQ(relay.due(2 * kMs, true), nullptr) << "an old command";
  EXPECT_EQ(relay.due(100 * kMs, true), nullptr) << "no damping for motors that were never commanded";
  EXPECT_EQ(relay.last_command(), nullptr);
}

TEST_F(Relay, ASilentDriverLeavesDampingForThreeSeconds) {
  relay.store(walking(1), 0);
  relay.due(0, true);
  EXPECT_EQ(relay.due(CommandRelay::kSilenceNs, true), nullptr);
  int count = 0;
  std::int64_t last_ns = 0;
  for (std::int64_t ns = CommandRelay::kSilenceNs + 1; ns < 5'000 * kMs; ns += kMs) {
    const LowCmd* sent = relay.due(ns, true);
    if (sent == nullptr) continue;
    ++count;
    last_ns = ns;
    EXPECT_EQ(sent->motors[0].mode, kServo);
    EXPECT_EQ(sent->motors[0].q, kNoPosition);
    EXPECT_EQ(sent->motors[0].dq, 0);
    EXPECT_EQ(sent->motors[0].tau, 0);
    EXPECT_EQ(sent->motors[0].kp, 0);
    EXPECT_EQ(sent->motors[0].kd, 4);
    EXPECT_EQ(sent->motors[1].mode, kDamping) << "a motor without a command stays so";
  }
  EXPECT_EQ(count, 1500);
  EXPECT_NEAR(static_cast<double>(last_ns), 3.02e9, 2e6);
  EXPECT_FALSE(relay.has_driver(last_ns + 10 * kMs));
  EXPECT_EQ(relay.last_command(), nullptr);
}

TEST(StateWriter, AnotherOneIsNotTheRobotAndIsRememberedForASecond) {
  StateWriter robot;
  EXPECT_EQ(robot.robots(0), RobotsSeen::kNone);
  EXPECT_TRUE(robot.is_of_robot(7, 0));
  EXPECT_FALSE(robot.is_of_robot(8, kMs));
  for (int i = 2; i <= 1'001; ++i) EXPECT_TRUE(robot.is_of_robot(7, i * kMs));
  EXPECT_EQ(robot.robots(1'000 * kMs), RobotsSeen::kMore);
  EXPECT_EQ(robot.robots(1'001 * kMs), RobotsSeen::kOne);
}

TEST(StateWriter, OneIsTheOnlyOneAfterHalfASecond) {
  StateWriter robot;
  for (int i = 0; i <= 500; ++i) EXPECT_TRUE(robot.is_of_robot(7, i * kMs));
  EXPECT_EQ(robot.robots(499 * kMs), RobotsSeen::kAwaited);
  EXPECT_EQ(robot.robots(500 * kMs), RobotsSeen::kOne);
}

TEST(StateWriter, ARobotThatRestartsHasANewOne) {
  StateWriter robot;
  EXPECT_TRUE(robot.is_of_robot(7, 0));
  EXPECT_EQ(robot.robots(1'000 * kMs), RobotsSeen::kNone);
  EXPECT_TRUE(robot.is_of_robot(8, 1'000 * kMs));
  EXPECT_EQ(robot.robots(1'000 * kMs), RobotsSeen::kAwaited);
  EXPECT_FALSE(robot.is_of_robot(7, 1'001 * kMs));
}

struct Switcher : testing::Test {
  MotionSwitcher switcher{true, false};

  std::optional<MotionSwitcher::Request> answered(MotionSwitcher& asked, std::int64_t now_ns, const char* data) {
    const auto request = asked.due(now_ns);
    if (request) asked.accept(*request, 0, data, now_ns);
    return request;
  }
};

TEST_F(Switcher, AnEmptyNameIsFree) {
  const auto request = answered(switcher, kMs, R"({"form":"0","name":""})");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->api, 1001);
  EXPECT_EQ(switcher.state(), MotionService::kFree);
}

TEST_F(Switcher, AModeThatBeginsLaterIsNamedAndNotReleased) {
  MotionSwitcher releasing(true, true);
  answered(releasing, kMs, R"({"name": ""})");
  EXPECT_TRUE(releasing.is_free());
  ASSERT_TRUE(answered(releasing, 10'000 * kMs, R"({"name": "mcf"})"));
  EXPECT_EQ(releasing.state(), MotionService::kActive);
  const auto next = releasing.due(11'000 * kMs);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->api, MotionSwitcher::kCheckMode);
}

TEST_F(Switcher, ASilentServiceThatWasFreeStaysFree) {
  answered(switcher, kMs, R"({"name": ""})");
  EXPECT_TRUE(switcher.due(10'000 * kMs));
  EXPECT_TRUE(switcher.is_free());
}

TEST_F(Switcher, AnActiveModeIsAskedAgainUntilItsReleaseByTheUser) {
  answered(switcher, kMs, R"({"name": "mcf"})");
  EXPECT_EQ(switcher.state(), MotionService::kActive);
  EXPECT_EQ(switcher.mode(), "mcf");
  EXPECT_FALSE(switcher.due(2 * kMs));
  const auto second = answered(switcher, 600 * kMs, R"({"name" : ""})");
  ASSERT_TRUE(second);
  EXPECT_EQ(second->api, MotionSwitcher::kCheckMode);
  EXPECT_TRUE(switcher.is_free());
}

TEST_F(Switcher, ItIsReleasedAtTheUsersWishAndAskedAgain) {
  MotionSwitcher releasing(true, true);
  answered(releasing, kMs, R"({"name":"ai"})");
  const auto release = answered(releasing, 600 * kMs, "");
  ASSERT_TRUE(release);
  EXPECT_EQ(release->api, 1003);
  EXPECT_EQ(releasing.state(), MotionService::kActive) << "until it says so itself";
  const auto check = answered(releasing, 1200 * kMs, R"({"name":""})");
  ASSERT_TRUE(check);
  EXPECT_EQ(check->api, 1001);
  EXPECT_TRUE(releasing.is_free());
}

TEST_F(Switcher, ASilentServiceIsNamedAndALateAnswerCounts) {
  for (std::int64_t ns = 0; ns < 2'900 * kMs; ns += kMs) switcher.due(ns);
  EXPECT_EQ(switcher.state(), MotionService::kAsked);
  switcher.due(3'001 * kMs);
  EXPECT_EQ(switcher.state(), MotionService::kNoAnswer);
  answered(switcher, 4'000 * kMs, R"({"name":""})");
  EXPECT_TRUE(switcher.is_free());
}

TEST_F(Switcher, WhatIsNoAnswerFreesNothing) {
  const auto request = switcher.due(kMs);
  ASSERT_TRUE(request);
  switcher.accept({.id = request->id + 1, .api = 1001}, 0, R"({"name":""})", kMs);
  switcher.accept({.id = request->id, .api = 1003}, 0, R"({"name":""})", kMs);
  EXPECT_EQ(switcher.state(), MotionService::kAsked) << "of another request";
  switcher.accept(*request, 3203, R"({"name":""})", kMs);
  EXPECT_EQ(switcher.state(), MotionService::kAsked) << "an error";
  std::int64_t ns = kMs;
  for (const char* data :
       {"", "{}", R"({"name":null})", R"({"name")", R"({"name":)", R"({"name":")", R"({"name" 7})"}) {
    EXPECT_FALSE(name_in(data)) << data;
    EXPECT_TRUE(answered(switcher, ns += MotionSwitcher::kAskNs, data));
    EXPECT_FALSE(switcher.is_free()) << data;
  }
}

/// Mutants of an answer have no name, or one that stands in them.
void expect_names_of_mutants(int count) {
  constexpr std::string_view kAnswer = R"({"form":"0","name":"mcf"})";
  std::mt19937 random(74);
  int named = 0;
  for (int i = 0; i < count; ++i) {
    std::string answer(kAnswer.substr(0, random() % 8 == 0 ? random() % kAnswer.size() : kAnswer.size()));
    for (auto changes = random() % 4; changes > 0 && !answer.empty(); --changes)
      answer[random() % answer.size()] = static_cast<char>(random());
    const auto name = name_in(answer);
    if (!name) continue;
    ++named;
    ASSERT_NE(answer.find('"' + *name + '"'), std::string::npos) << i;
  }
  EXPECT_GT(named, count / 4);
}

TEST(SwitcherFuzz, AMutatedAnswerHasNoOtherName) {
  expect_names_of_mutants(10'000);
}

TEST(SwitcherFuzz, NightlyNoneOfAMillionAnswersHasAnotherName) {
  expect_names_of_mutants(1'000'000);
}

TEST_F(Switcher, ARobotWithoutAServiceIsFreeAndANewDriverIsAskedAnew) {
  MotionSwitcher none(false, false);
  EXPECT_TRUE(none.is_free());
  EXPECT_FALSE(none.due(kMs));
  answered(switcher, kMs, R"({"name":""})");
  switcher.begin(5'000 * kMs);
  EXPECT_EQ(switcher.state(), MotionService::kAsked);
  EXPECT_TRUE(switcher.due(5'000 * kMs));
}

}  // namespace robot_control::unitree::go::tests
