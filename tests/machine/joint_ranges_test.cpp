#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "machine/urdf_text.h"

namespace robot_control {
namespace {

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
  EXPECT_THAT(refusal_of(robot_of(two_wheels()), parameters), testing::HasSubstr("robot/wheel_effort_rate"));
}

TEST(JointRanges, NothingLimitsTheEffortRateOfOtherJoints) {
  const JointModel arm = with_joint("revolute", "<limit lower=\"-1\" upper=\"1\" effort=\"9\" velocity=\"1\"/>");
  EXPECT_EQ(arm.effort_rate, 0);
}

}  // namespace
}  // namespace robot_control
