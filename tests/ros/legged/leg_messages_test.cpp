#include "ros/legged/leg_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "control/legged/walk/own_gaits.h"

namespace robot_control::tests {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(LegMessages, AFootTargetLiftsTheFootOfItsName) {
  FootTarget message;
  message.foot = "rear_left";
  message.x = 0.01;
  message.y = -0.02;
  message.z = 0.08;
  const auto request = request_of(message);
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->mode, (Mode{ModeKind::kLift, 2}));
  EXPECT_EQ(request->posture.x, 0.01);
  EXPECT_EQ(request->posture.y, -0.02);
  EXPECT_EQ(request->posture.height, 0.08);
  message.foot = "tail";
  EXPECT_FALSE(request_of(message).has_value());
  message.foot.clear();
  ASSERT_TRUE(request_of(message).has_value());
  EXPECT_EQ(parts_of(*request_of(message)), 0u);
}

TEST(LegMessages, OnlyTwoPosturesCanBeSet) {
  EXPECT_EQ(mode_of("standing").kind, ModeKind::kStand);
  EXPECT_EQ(mode_of("lying").kind, ModeKind::kLie);
  for (const char* other : {"", "sitting", "Standing", "rising"}) EXPECT_EQ(mode_of(other), Mode{}) << other;
}

TEST(LegMessages, AGaitAndItsModeAreOneAndTheSame) {
  OwnGaits own;
  own[2] = {.name = "amble", .period = 0.5, .duty = 0.6, .phases = NumberList<4>{}, .lift = 0.07};
  const Gaits gaits = all_gaits(own);
  for (const char* gait : {"auto", "trot", "walking_trot", "crawl", "amble"}) {
    ASSERT_TRUE(mode_of_gait(gait, gaits).has_value()) << gait;
    EXPECT_EQ(gait_of_mode(*mode_of_gait(gait, gaits), gaits), gait);
  }
  EXPECT_FALSE(mode_of_gait("stand", gaits).has_value());
  EXPECT_FALSE(mode_of_gait("amble", all_gaits({})).has_value());
  EXPECT_THAT(gait_words(gaits), ElementsAre("auto", "trot", "walking_trot", "crawl", "amble"));
}

TEST(LegMessages, TheStateNamesPostureFootAndReasons) {
  CommandFrame command;
  command.legged = {.phase = LegPhase::kStanding, .lifted = 4, .body = {0.01, 0.02, 0.03, 0.1, 0.2, 0.3}};
  command.legged.slope = {0.1, -0.2};
  MetGround met;
  met.add(1, 8, {.run = 1});
  CommandFrame plan;
  plan.joints[1] = {.mode = JointMode::kImpedance, .position = 0.7};
  StateFrame state;
  state.contacts[1] = {.probability = 1, .slip = 0.002, .load = 31};
  LegModel robot;
  robot.joints.resize(2);
  robot.joints[1].name = "knee";
  const LegState message =
      leg_state({command, plan, {}, state, all_gaits({}), kReasonOutOfReach, met}, robot, ros::Time(1, 2));
  EXPECT_EQ(message.posture, "standing");
  EXPECT_EQ(message.lifted, "rear_right");
  EXPECT_EQ(message.body.yaw, 0.3);
  EXPECT_THAT(message.gaits, ElementsAre("auto", "trot", "walking_trot", "crawl"));
  EXPECT_THAT(message.reasons, ElementsAre("out_of_reach"));
  EXPECT_THAT(message.bears, ElementsAre(0, 1, 0, 0));
  EXPECT_EQ(message.load[1], 31);
  EXPECT_EQ(message.slope_left, -0.2);
  EXPECT_THAT(message.met_riser, ElementsAre(1, 0, 0, 0));
  EXPECT_THAT(message.reaching, ElementsAre(0, 0, 0, 1));
  EXPECT_TRUE(std::isnan(message.wanted[0]));
  EXPECT_EQ(message.wanted[1], 0.7);
}

TEST(MetGroundTest, AnEventOfOneCycleIsShownForAFifthOfASecond) {
  MetGround met;
  EXPECT_FALSE(met.met_riser(2) || met.reaching(2));
  met.add(0, 4, {.run = 1, .stamp_ns = 1'000'000'000});
  met.add(0, 0, {.run = 1, .stamp_ns = 1'200'000'000});
  EXPECT_TRUE(met.reaching(2));
  EXPECT_FALSE(met.met_riser(2) || met.reaching(1));
  met.add(0, 0, {.run = 1, .stamp_ns = 1'201'000'000});
  EXPECT_FALSE(met.reaching(2));
  met.add(0, 0, {.run = 2, .stamp_ns = 1'000'000'000});
  EXPECT_FALSE(met.reaching(2)) << "in another run";
}

TEST(LegMessages, ARefusalSaysWhoHoldsThePermission) {
  LegModel robot;
  Permit permit;
  EXPECT_THAT(no_permission(false, permit, robot, {.kind = kLeggedKind}), HasSubstr("start safety_monitor"));
  permit.unreleased = 1;
  EXPECT_THAT(no_permission(true, permit, robot, {.kind = kLeggedKind}), HasSubstr("body_pose of zero"));
  permit.causes = permit.first_cause = kCauseEmergencyStopService;
  EXPECT_THAT(no_permission(true, permit, robot, {.kind = kLeggedKind}), StartsWith("the robot is stopped: "));
  EXPECT_THAT(no_permission(true, permit, robot, {.kind = kLeggedKind}), HasSubstr("e_stop_reset"));
  permit.action = PermitAction::kDrive;
  EXPECT_EQ(no_permission(true, permit, robot, {.kind = kLeggedKind}), "");
}

TEST(GroundWords, SayHowItRisesAndNothingOfALevelFloor) {
  const auto words = [](double ahead, double left) { return ground_words({.slope = {ahead, left}}); };
  EXPECT_EQ(words(0.05, 0), "");
  EXPECT_EQ(words(std::nan(""), 0), "");
  EXPECT_EQ(words(0.18, 0), "rises 10.2 deg to the front");
  EXPECT_EQ(words(-0.18, 0.02), "rises 10.3 deg to the rear");
  EXPECT_EQ(words(0.1, -0.1), "rises 8 deg to the front right");
}

TEST(SlopeWords, HaveTheMeasuredSlopeAndTheLargestOne) {
  LegModel robot;
  StateFrame state;
  state.base.attitude = {0, std::sin(0.15), 0, std::cos(0.15)};
  EXPECT_EQ(slope_words(kReasonOutOfReach, state, robot), "");
  EXPECT_EQ(slope_words(kReasonTooSteep, state, robot), " (by 17.2 deg, at most 24.1 deg)");
  robot.lying_pitch = 0.1;
  EXPECT_EQ(slope_words(kReasonTooSteep, state, robot), " (by 11.5 deg, at most 24.1 deg)");
}

}  // namespace robot_control::tests
