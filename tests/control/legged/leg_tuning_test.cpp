#include "control/legged/ideal_legs.h"

namespace robot_control::tests {

/// Returns a robot of 12.7 kg times `mass` whose legs have 0.426 m times `length`.
LegModel of_size(double mass, double length) {
  LegModel robot;
  robot.mass = 12.7 * mass;
  robot.joints.resize(kLegsJoints);
  LegGeometry geometry;
  geometry.lower = geometry.foot = {0, 0, -0.213 * length};
  geometry.range.fill({-3, 3});
  for (Leg& leg : robot.legs) leg.kinematics = LegKinematics(geometry);
  for (JointModel& joint : robot.joints) {
    joint.effort_limit = 40 * mass * length;
    joint.velocity_limit = 1e3;
  }
  return robot;
}

TEST(LegTuning, IsThatOfTheRobotThatItWasFoundWith) {
  const LegTuning tuning = leg_tuning(of_size(1, 1));
  EXPECT_DOUBLE_EQ(tuning.stiffness, 60);
  EXPECT_DOUBLE_EQ(tuning.damping, 2);
  EXPECT_DOUBLE_EQ(tuning.rise_time, 1.3);
  EXPECT_DOUBLE_EQ(tuning.height, 0.7 * 0.426);
  EXPECT_DOUBLE_EQ(tuning.lift, 0.08);
  EXPECT_DOUBLE_EQ(tuning.sway, 0.12 * 0.426);
  EXPECT_DOUBLE_EQ(tuning.bob, 0.16 * 0.426);
  EXPECT_DOUBLE_EQ(tuning.lean, 0.3);
  EXPECT_DOUBLE_EQ(tuning.foot_range, 0.15);
  EXPECT_DOUBLE_EQ(tuning.foot.speed, 0.5);
  EXPECT_DOUBLE_EQ(tuning.foot.acceleration, 15);
  EXPECT_DOUBLE_EQ(tuning.joint.speed, 3);
  EXPECT_DOUBLE_EQ(tuning.joint.acceleration, 15);
}

/// Lengths grow with l, times with √l, accelerations not at all, efforts with m l.
TEST(LegTuning, ScalesAsAModelOfTheSameRobotDoes) {
  const LegTuning one = leg_tuning(of_size(1, 1)), large = leg_tuning(of_size(3, 4));
  EXPECT_DOUBLE_EQ(large.stiffness, 12 * one.stiffness);
  EXPECT_DOUBLE_EQ(large.damping, 24 * one.damping);
  EXPECT_DOUBLE_EQ(large.rise_time, 2 * one.rise_time);
  EXPECT_DOUBLE_EQ(large.height, 4 * one.height);
  EXPECT_DOUBLE_EQ(large.lift, 4 * one.lift);
  EXPECT_DOUBLE_EQ(large.sway, 4 * one.sway);
  EXPECT_DOUBLE_EQ(large.bob, 4 * one.bob);
  EXPECT_DOUBLE_EQ(large.lean, one.lean);
  EXPECT_DOUBLE_EQ(large.foot_range, 4 * one.foot_range);
  EXPECT_DOUBLE_EQ(large.foot.speed, 2 * one.foot.speed);
  EXPECT_DOUBLE_EQ(large.foot.acceleration, one.foot.acceleration);
  EXPECT_DOUBLE_EQ(large.joint.speed, one.joint.speed / 2);
  EXPECT_DOUBLE_EQ(large.joint.acceleration, one.joint.acceleration / 4);
}

/// A rise takes 1.3 s where it needs less than nine tenths of each joint's speed limit.
TEST(LegTuning, RisesNoFasterThanItsJointsTurn) {
  for (const std::string& name : legged_robots()) {
    const LegModel fast = legged_robot(name);
    EXPECT_DOUBLE_EQ(leg_tuning(fast).rise_time, 1.3 * std::sqrt(fast.leg_length() / kReferenceLeg)) << name;
  }
  LegModel robot = legged_robot("quadbot");
  for (JointModel& joint : robot.joints) joint.velocity_limit = 0.5;
  const double slow = leg_tuning(robot).rise_time;
  EXPECT_GT(slow, 2.6);
  for (JointModel& joint : robot.joints) joint.velocity_limit = 0.25;
  EXPECT_DOUBLE_EQ(leg_tuning(robot).rise_time, 2 * slow);
}

/// Half of the weight is 12.7 · 9.81 / 2 = 62.3 N. At 0.7, 0.79 and 0.85 of the leg length the levers of its knee are
/// 0.357, 0.307 and 0.263 of that length.
TEST(LegTuning, StandsHigherWhereAKneeIsWeak) {
  const auto height = [](double knee) {
    LegModel robot = of_size(1, 1);
    robot.joints[8].effort_limit = knee;
    return leg_tuning(robot).height / 0.426;
  };
  EXPECT_NEAR(height(16), 0.7, 1e-9);
  EXPECT_NEAR(height(13.65), 0.79, 1e-9);
  EXPECT_NEAR(height(1), 0.85, 1e-9);
}

TEST(JointBounds, AreTheRangesAndNineTenthsOfTheSpeedsThatTheGateAllows) {
  LegModel robot = of_size(1, 1);
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    robot.joints[i].velocity_limit = 1 + static_cast<double>(i);
    if (i != 4) robot.joints[i].range = JointRange{-1 - static_cast<double>(i), 2};
  }
  const AllJointBounds bounds = joint_bounds(robot);
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    const auto number = static_cast<double>(i);
    EXPECT_DOUBLE_EQ(bounds[i].motion.speed, i < 3 ? 0.9 * (1 + number) : 3) << i;
    EXPECT_DOUBLE_EQ(bounds[i].motion.acceleration, 15) << i;
    EXPECT_EQ(bounds[i].range.lower, i == 4 ? -std::numeric_limits<double>::infinity() : -1 - number) << i;
    EXPECT_EQ(bounds[i].range.upper, i == 4 ? std::numeric_limits<double>::infinity() : 2) << i;
  }
}

}  // namespace robot_control::tests
