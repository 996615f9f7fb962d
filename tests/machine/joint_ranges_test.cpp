#include "machine/urdf_text.h"
#include "support/matchers.h"

namespace robot_control::tests {

/// The healthy robot with one more joint, with these limits.
JointModel with_joint(const std::string& type, const std::string& limit) {
  const DriveTrain robot = read_drive_train(
      robot_of(two_wheels() + link("part", inertial("1")) +
               joint({.name = "more", .child = "part", .type = type, .axis = "<axis xyz=\"0 0 1\"/>", .rest = limit})),
      {});
  return robot.joints.back();
}

TEST(JointRanges, ARevoluteJointTurnsBetweenItsEndStops) {
  const JointModel arm = with_joint("revolute", "<limit lower=\"-1\" upper=\"2\" effort=\"9\" velocity=\"3\"/>");
  ASSERT_TRUE(arm.range);
  EXPECT_EQ(arm.range->lower, -1);
  EXPECT_EQ(arm.range->upper, 2);
  EXPECT_FALSE(arm.prismatic);
}

TEST(JointRanges, APrismaticJointIsMeasuredInMetres) {
  const JointModel lift = with_joint("prismatic", "<limit lower=\"0\" upper=\"0.4\" effort=\"9\" velocity=\"1\"/>");
  ASSERT_TRUE(lift.range);
  EXPECT_EQ(lift.range->upper, 0.4);
  EXPECT_TRUE(lift.prismatic);
}

TEST(JointRanges, AContinuousJointHasNone) {
  EXPECT_FALSE(with_joint("continuous", "<limit lower=\"-1\" upper=\"1\" effort=\"9\" velocity=\"1\"/>").range);
}

TEST(JointRanges, LowerEqualsUpperMeansUnknown) {
  EXPECT_FALSE(with_joint("revolute", "<limit lower=\"0\" upper=\"0\" effort=\"9\" velocity=\"1\"/>").range);
}

TEST(JointRanges, ManyTurnsAreNoEnd) {
  EXPECT_FALSE(with_joint("revolute", "<limit lower=\"-1e16\" upper=\"1e16\" effort=\"9\" velocity=\"1\"/>").range);
}

TEST(JointRanges, WheelsHaveNoneWhateverTheirJointsSay) {
  for (const std::string limit : {"lower=\"-1e16\" upper=\"1e16\"", "lower=\"-180\" upper=\"180\""}) {
    std::string text = base();
    for (const std::string name : {"left", "right"}) {
      text += link(name + "_link", inertial("1") + tyre("0.1")) +
              joint({.name = name,
                     .child = name + "_link",
                     .xyz = name == "left" ? "0 0.25 0" : "0 -0.25 0",
                     .type = "revolute",
                     .rest = "<limit " + limit + " effort=\"5\" velocity=\"9\"/>"});
    }
    for (const JointModel& joint : read_drive_train(robot_of(text), {}).joints) EXPECT_FALSE(joint.range) << limit;
  }
}

TEST(JointRanges, AWheelsTorqueRisesWithinKEffortRise) {
  const DriveTrain robot = read_drive_train(robot_of(two_wheels()), {});
  for (const JointModel& joint : robot.joints) EXPECT_DOUBLE_EQ(joint.effort_rate, joint.effort_limit / kEffortRise);
}

TEST(JointRanges, TheUsersEffortRateHoldsForEveryWheel) {
  DriveTrainParameters parameters;
  parameters.wheel_effort_rate = 12;
  for (const JointModel& joint : read_drive_train(robot_of(two_wheels()), parameters).joints) {
    EXPECT_EQ(joint.effort_rate, 12);
  }
}

TEST(JointRanges, AnEffortRateOfZeroIsRefused) {
  DriveTrainParameters parameters;
  parameters.wheel_effort_rate = 0;
  EXPECT_THAT(refusal_of(robot_of(two_wheels()), parameters), HasSubstr("robot.wheel_effort_rate"));
}

TEST(JointRanges, NothingLimitsTheEffortRateOfOtherJoints) {
  const JointModel arm = with_joint("revolute", "<limit lower=\"-1\" upper=\"1\" effort=\"9\" velocity=\"1\"/>");
  EXPECT_EQ(arm.effort_rate, 0);
}

TEST(JointRanges, AJointRestsWhereItsRangeIsNearestToZero) {
  const auto rest = [](const std::string& range) {
    return with_joint("prismatic", "<limit " + range + " effort=\"9\" velocity=\"1\"/>").rest_position;
  };
  EXPECT_EQ(rest("lower=\"0.3\" upper=\"0.4\""), 0.3);
  EXPECT_EQ(rest("lower=\"-0.4\" upper=\"-0.3\""), -0.3);
  EXPECT_EQ(rest("lower=\"-0.4\" upper=\"0.3\""), 0);
}

/// A lift whose range begins at 0.3 m, and an arm that follows it by twice its way and 0.5 rad, against its own range.
std::string lift_and_follower() {
  return two_wheels() + link("lift", inertial("10")) +
         joint({.name = "lift_joint",
                .child = "lift",
                .type = "prismatic",
                .axis = "<axis xyz=\"0 0 1\"/>",
                .rest = "<limit lower=\"0.3\" upper=\"0.9\" effort=\"500\" velocity=\"1\"/>"}) +
         link("arm", inertial("1")) +
         joint({.name = "arm_joint",
                .child = "arm",
                .type = "revolute",
                .rest = "<limit lower=\"-0.1\" upper=\"0.1\" effort=\"9\" velocity=\"1\"/>"
                        "<mimic joint=\"lift_joint\" multiplier=\"2\" offset=\"0.5\"/>",
                .parent = "lift"});
}

TEST(JointRanges, AFollowerRestsWhereItsLeaderPutsItAndHasNoEndStops) {
  const DriveTrain robot = read_drive_train(robot_of(lift_and_follower()), {});
  EXPECT_DOUBLE_EQ(robot.joints.back().rest_position, 1.1);
  EXPECT_FALSE(robot.joints.back().range);
}

TEST(JointRanges, WhatDoesNotRestAtZeroIsNotedAndMovesTheCentreOfGravity) {
  const DriveTrain robot = read_drive_train(robot_of(lift_and_follower()), {});
  const std::string notes = notes_of(robot, RobotNote::Kind::kAssumed);
  EXPECT_THAT(notes, HasSubstr("<joint name=\"lift_joint\">: rests at 0.3 m: its range from 0.3 to 0.9 m"));
  EXPECT_THAT(notes, HasSubstr("<joint name=\"arm_joint\">: rests at 1.1 rad: the joint that it follows"));
  EXPECT_NEAR(robot.centre_of_gravity_base[2], 0.3 * 11 / 23, kRounding);
}

}  // namespace robot_control::tests
