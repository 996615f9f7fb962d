#include "ros/wheeled/wheel_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "signals/names.h"

namespace robot_control::tests {

using testing::ElementsAre;

struct WheelMessagesTest : testing::Test {
  WheelMessagesTest() {
    robot_.joints.resize(3);
    robot_.joints[0].name = "left";
    robot_.joints[1].name = "right";
    robot_.joints[2].name = "mast";
    robot_.wheels = {WheelModel{.joint = 0}, WheelModel{.joint = 1, .side = Side::kRight}};
  }

  const ros::Time stamp_{12, 34};
  DriveTrain robot_;
  CommandFrame command_;
};

TEST_F(WheelMessagesTest, JointCommandsAreTheWheelsVelocityTargets) {
  command_.joints[0].velocity = 4.5;
  command_.joints[1].velocity = 5.5;
  command_.joints[2].velocity = 99;
  const std_msgs::Float64MultiArray message = joint_commands(command_, robot_);
  EXPECT_THAT(message.data, ElementsAre(4.5, 5.5));
  ASSERT_EQ(message.layout.dim.size(), 1u);
  EXPECT_EQ(message.layout.dim[0].label, "wheel");
  EXPECT_EQ(message.layout.dim[0].size, 2u);
  const sensor_msgs::JointState targets = joint_targets(command_, robot_, stamp_);
  EXPECT_THAT(targets.name, ElementsAre("left", "right"));
  EXPECT_THAT(targets.velocity, ElementsAre(4.5, 5.5));
}

TEST_F(WheelMessagesTest, JointCommandsAreOfAllWheelsInTheOrderOfTheModel) {
  robot_.wheels.push_back(WheelModel{.joint = 2, .side = Side::kRight});
  command_.joints[2].velocity = 6.5;
  EXPECT_THAT(joint_commands(command_, robot_).data, ElementsAre(0, 0, 6.5));
  EXPECT_EQ(joint_commands(command_, robot_).layout.dim[0].size, 3u);
  EXPECT_THAT(joint_targets(command_, robot_, stamp_).name, ElementsAre("left", "right", "mast"));
}

TEST_F(WheelMessagesTest, DriveStateComparesTheWheelsWithThePlanOfTwoCyclesBefore) {
  CommandFrame plan;
  plan.joints[0] = {.mode = JointMode::kEffort, .velocity = 4.5};
  plan.joints[1] = {.mode = JointMode::kEffort, .velocity = 5.5};
  command_.joints[0] = {.mode = JointMode::kEffort, .velocity = 9, .effort = 0.25};
  command_.joints[1] = {.mode = JointMode::kEffort, .velocity = 9, .effort = -0.5};
  command_.wheeled.velocity = {4.25, 5.75, 99};
  const DriveState message = drive_state(command_, plan, 0, robot_, stamp_);
  EXPECT_EQ(message.header.stamp, stamp_);
  EXPECT_THAT(message.name, ElementsAre("left", "right"));
  EXPECT_THAT(message.wanted, ElementsAre(4.5, 5.5));
  EXPECT_THAT(message.actual, ElementsAre(4.25, 5.75));
  EXPECT_THAT(message.error, ElementsAre(0.25, -0.25));
  EXPECT_THAT(message.effort, ElementsAre(0.25, -0.5));
  EXPECT_THAT(message.reasons, testing::IsEmpty());
  EXPECT_THAT(message.sentences, testing::IsEmpty());
}

TEST_F(WheelMessagesTest, DriveStateReportsEveryReasonWithSentenceAndRemedy) {
  for (const BitName& row : kCommandReasonNames) {
    const DriveState message = drive_state(command_, command_, row.bit, robot_, stamp_);
    EXPECT_THAT(message.reasons, ElementsAre(std::string(row.name)));
    ASSERT_EQ(message.sentences.size(), 1u);
    EXPECT_THAT(message.sentences[0], testing::StartsWith(with_programs(row.sentence, Programs{})));
    EXPECT_THAT(message.sentences[0], testing::HasSubstr(with_programs(row.remedy, Programs{})));
  }
}

}  // namespace robot_control::tests
